// Faults that the look at the wiring before a start brings about: FAULT(number, name, words, remedy), see
// dictionary/fault_list.h.

FAULT(24, NO_CURRENT, "no current flows in any phase at the start",
      "check motor cable, supply of the gate drivers, supply and wires of the current sensors")
FAULT(25, OPEN_PHASE, "a motor phase carries no current", "check its wire, terminals and gate driver")
FAULT(26, CURRENT_SENSOR, "a current sensor shows nothing or is reversed", "check its supply, wire and direction")
FAULT(27, SENSOR_ORDER, "the current sensors are on different phases from the gates",
      "compare a, b and c at gates, motor cable, sensors and converter")
