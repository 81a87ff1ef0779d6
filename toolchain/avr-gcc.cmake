# GCC for an ATmega1284P, a processor whose int has 16 bits; used by `cmake --preset avr`.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR avr)
set(CMAKE_C_COMPILER avr-gcc)
set(CMAKE_C_FLAGS_INIT "-mmcu=atmega1284p")
