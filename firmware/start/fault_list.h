// Faults that the start brings about: FAULT(number, name, words, remedy), see dictionary/fault_list.h.

FAULT(23, START_VOLTAGE, "the DC link is too low to find rotor and polarity at the start",
      "raise the DC link, or lower start_current and polarity_current; commission the drive")
