// Faults that who watches over the board brings about: FAULT(number, name, words, remedy), see dictionary/fault_list.h.

FAULT(15, PRECHARGE, "DC link not charged, precharge relay open",
      "check the supply, the precharge resistor and precharge_voltage")
FAULT(16, TEMPERATURE, "heat sink beyond temperature_limit, or its sensor broken", "let it cool, check fan and sensor")
FAULT(17, OVERLOAD, "overload: rms of the current too long above overload_current",
      "reduce the load; check rated_current, overload_current, overload_time")
FAULT(18, BRAKE_RESISTOR, "brake resistor on for more than brake_share", "brake more slowly; check brake_voltage")
FAULT(19, GATE_ENABLE, "gate enable does not pass the gates although its line is toggled",
      "check the circuit behind the enable line and its feedback")
FAULT(20, SELF_TEST, "self-test failed", "see 'status'; a chip or board fault")
FAULT(22, STALL, "stalled: at the current limit the shaft does not follow",
      "look for what holds or overloads the shaft; check current_limit, speed_ramp and stall_time")
