// The faults that every drive has, in the one place that has their words. FAULT(number, name, words, remedy): the
// number is stable for ever; `words` is the cause, `remedy` what to do about it. What a feature alone brings about is
// in a list of the same form in its folder, and the build makes dictionary/all_faults.h of them all, which is included
// with different meanings of FAULT.

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
FAULT(21, INTERRUPT, "unexpected interrupt", "switch off and on; a chip or software fault: report it")
