// Faults that the encoder brings about: FAULT(number, name, words, remedy), see dictionary/fault_list.h.

FAULT(28, ENCODER, "the encoder counts against the field", "exchange two wires of the motor, or A and B of the encoder")
