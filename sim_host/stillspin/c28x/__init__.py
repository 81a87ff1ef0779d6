"""Machine code of the C28x: its table of instructions, an assembler and a disassembler."""
