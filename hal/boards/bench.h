// The board "bench": isolated gate supplies, gates active high, 20 A and 450 V. What the virtual board is unless
// another one is asked for, and what docs/wiring.md wires.
//
// A board is one file like this one, the only place that says what is soldered where: the drivers, the parameters'
// defaults, the virtual board and the tables in docs/board.md come from it. hal/hal_board.h names the one in use.

#ifndef STILLSPIN_HAL_BOARDS_BENCH_H
#define STILLSPIN_HAL_BOARDS_BENCH_H

#define BOARD_NAME "bench"

// ---- Gates: three ePWM modules in a row, upper device on their A, lower one on their B; the other three time the ADC.
#define BOARD_FIRST_LEG_MODULE 1u  // 1: GPIO0..5, or 4: GPIO6..11
#define BOARD_PIN_FIRST_GATE 0u    // a upper, a lower, b upper, b lower, c upper, c lower
#define BOARD_GATE_PINS 6u
#define BOARD_GATE_ON_LEVEL 1u   // level that switches a device on; the board pulls the pins to the other one
#define BOARD_DEAD_TIME 200      // default, 0.01 us
#define BOARD_DEAD_TIME_LEAST 0  // of the power stage, 0.01 us: 0 where its gate driver interlocks
#define BOARD_TURN_ON_DELAY 30   // gate pin to device, 0.01 us
#define BOARD_TURN_OFF_DELAY 60  // 0.01 us
#define BOARD_BOOTSTRAP_TIME 0   // lower devices on before the first pulse, 0.1 ms; 0: gate supplies of their own

// ---- Safety lines
#define BOARD_TRIP_INPUT 1u          // TZn of the over-current comparator
#define BOARD_PIN_OVER_CURRENT 12u   // low when the comparator has fired
#define BOARD_EMERGENCY_TRIP 2u      // TZn of the emergency stop
#define BOARD_PIN_EMERGENCY 13u      // low when it is pressed or its wire broken
#define BOARD_PIN_GATE_ENABLE 34u    // the gates pass while it toggles
#define BOARD_PIN_GATE_FEEDBACK 24u  // high while the gates pass
#define BOARD_ENABLE_TIME_US 5000    // without an edge of the enable line, then the gates are off

// ---- Other pins
#define BOARD_PIN_RELAY 16u  // bridges the precharge resistor
#define BOARD_RELAY_ON_LEVEL 1u
#define BOARD_PIN_BRAKE 17u  // brake resistor across the DC link
#define BOARD_BRAKE_ON_LEVEL 1u
#define BOARD_PIN_RUN 25u  // switch to ground: run
#define BOARD_PIN_FAULT_LAMP 27u
#define BOARD_LAMP_ON_LEVEL 1u
#define BOARD_PIN_ENCODER_A 20u
#define BOARD_PIN_ENCODER_B 21u
#define BOARD_PIN_ENCODER_INDEX 23u
#define BOARD_PIN_SERIAL_IN 28u   // SCI-A
#define BOARD_PIN_SERIAL_OUT 29u  // also a boot-mode pin: keep loads light while the chip comes out of reset
#define BOARD_PIN_CAN_RECEIVE 30u
#define BOARD_PIN_CAN_TRANSMIT 31u
#define BOARD_PIN_SDA 32u
#define BOARD_PIN_SCL 33u

// ---- Analogue inputs: pair n is ADCINAn with ADCINBn, sampled at one instant.
#define BOARD_ADC_CURRENTS 0u   // A: current of phase a, B: of phase b; 1.5 V is 0 A
#define BOARD_ADC_SLOW 1u       // A: DC link, B: heat sink's NTC
#define BOARD_ADC_SPEED 2u      // A: DC link once more, B: speed command
#define BOARD_ADC_REFERENCE 7u  // A: ground, B: 1.5 V
#define BOARD_REFERENCE_CODE 2048
#define BOARD_CURRENT_RANGE 2000     // at 3 V, 0.01 A
#define BOARD_LINK_RANGE 4500        // at 3 V, 0.1 V
#define BOARD_COMPARATOR_PERCENT 95  // of the current range, where the over-current comparator fires

// ---- Heat sink: NTC to ground, resistor to the converter's 3 V. Codes at -40, -20 .. 140 degrees C.
#define BOARD_NTC_R25 10000      // ohm
#define BOARD_NTC_BETA 3435      // K
#define BOARD_NTC_PULL_UP 10000  // ohm
#define BOARD_NTC_FIRST (-40)
#define BOARD_NTC_STEP 20
#define BOARD_NTC_POINTS 10u
#define BOARD_NTC_CODES {3937, 3628, 3038, 2249, 1497, 941, 584, 368, 238, 159}

#endif
