// The faults, in the one place that has their words. FAULT(number, name, words, remedy): the number is stable for ever;
// `words` is the cause, `remedy` what to do about it. No include guard: it is included with different meanings of
// FAULT.

FAULT(0, NONE, "none", "")
FAULT(1, OVER_CURRENT, "over-current comparator", "look for a short circuit or an earth fault before the reset")
FAULT(2, CURRENT_LIMIT, "sampled current beyond trip_current",
      "lower current_bandwidth, or check inductance_d, inductance_q and the current sensors")
FAULT(3, LINK_LOW, "DC link below link_minimum", "check the supply and its wires, and link_full_scale")
FAULT(4, LINK_HIGH, "DC link above link_maximum", "brake more slowly: speed_ramp, link_regulation; check the supply")
FAULT(5, OVERRUN, "control interrupt overrun", "a software fault: report it")
FAULT(6, NO_SAMPLES, "no samples from the ADC", "a board or software fault: switch off and on")
FAULT(7, DIVERGENCE, "estimators diverged or speed not plausible",
      "commission the drive; check pole_pairs, inductances and magnet_flux")
FAULT(8, POLARITY, "polarity of the magnet ambiguous, or contradicted by the back-EMF",
      "commission the drive, raise start_current or free the shaft for the start; is a motor wire broken? "
      "the next start names it")
FAULT(9, OFFSET, "current offset implausible",
      "check the current sensors and their supply; no current may flow at power-on")
FAULT(10, PARAMETER, "parameters do not fit together", "'status' says which do not: set them")
FAULT(11, GATES_OFF, "gates switched off unexpectedly", "check the enable line of the gate driver")
FAULT(12, SYNCHRONISM, "loss of synchronism",
      "reduce load or speed_ramp; commission the drive; check magnet_flux, stator_resistance; is a motor wire "
      "broken? the next start names it")
FAULT(13, STOP, "standstill not reached within stop_time", "raise stop_time, or look for what drives the shaft")
FAULT(14, EMERGENCY, "emergency stop", "release it, then reset")
FAULT(15, PRECHARGE, "DC link not charged, precharge relay open",
      "check the supply, the precharge resistor and precharge_voltage")
FAULT(16, TEMPERATURE, "heat sink beyond temperature_limit, or its sensor broken", "let it cool, check fan and sensor")
FAULT(17, OVERLOAD, "overload: rms of the current too long above overload_current",
      "reduce the load; check rated_current, overload_current, overload_time")
FAULT(18, BRAKE_RESISTOR, "brake resistor on for more than brake_share", "brake more slowly; check brake_voltage")
FAULT(19, GATE_ENABLE, "gate enable does not pass the gates although its line is toggled",
      "check the circuit behind the enable line and its feedback")
FAULT(20, SELF_TEST, "self-test failed", "see 'status'; a chip or board fault")
FAULT(21, INTERRUPT, "unexpected interrupt", "switch off and on; a chip or software fault: report it")
FAULT(22, STALL, "stalled: at the current limit the shaft does not follow",
      "look for what holds or overloads the shaft; check current_limit, speed_ramp and stall_time")
FAULT(23, START_VOLTAGE, "the DC link is too low to find rotor and polarity at the start",
      "raise the DC link, or lower start_current and polarity_current; commission the drive")
FAULT(24, NO_CURRENT, "no current flows in any phase at the start",
      "check motor cable, supply of the gate drivers, supply and wires of the current sensors")
FAULT(25, OPEN_PHASE, "a motor phase carries no current", "check its wire, terminals and gate driver")
FAULT(26, CURRENT_SENSOR, "a current sensor shows nothing or is reversed", "check its supply, wire and direction")
FAULT(27, SENSOR_ORDER, "the current sensors are on different phases from the gates",
      "compare a, b and c at gates, motor cable, sensors and converter")
FAULT(28, ENCODER, "the encoder counts against the field", "exchange two wires of the motor, or A and B of the encoder")
