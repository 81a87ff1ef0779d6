// The board "ipm": an intelligent power module with inputs that are active low and bootstrap supplies, 25 A and 500 V.
// It has next to nothing in common with "bench" (hal/boards/bench.h says what a board's file is), and is there to show
// that nothing else knows what is soldered where.

#ifndef STILLSPIN_HAL_BOARDS_IPM_H
#define STILLSPIN_HAL_BOARDS_IPM_H

#define BOARD_NAME "ipm"

// ---- Gates: three ePWM modules in a row, upper device on their A, lower one on their B; the other three time the ADC.
#define BOARD_FIRST_LEG_MODULE 4u  // 1: GPIO0..5, or 4: GPIO6..11
#define BOARD_PIN_FIRST_GATE 6u    // a upper, a lower, b upper, b lower, c upper, c lower
#define BOARD_GATE_PINS 6u
#define BOARD_GATE_ON_LEVEL 0u     // level that switches a device on; the board pulls the pins to the other one
#define BOARD_DEAD_TIME 200        // default, 0.01 us
#define BOARD_DEAD_TIME_LEAST 100  // of the power stage, 0.01 us: 0 where its gate driver interlocks
#define BOARD_TURN_ON_DELAY 30     // gate pin to device, 0.01 us
#define BOARD_TURN_OFF_DELAY 60    // 0.01 us
#define BOARD_BOOTSTRAP_TIME 20    // lower devices on before the first pulse, 0.1 ms; 0: gate supplies of their own

// ---- Safety lines
#define BOARD_TRIP_INPUT 2u          // TZn of the over-current comparator
#define BOARD_PIN_OVER_CURRENT 13u   // low when the comparator has fired
#define BOARD_EMERGENCY_TRIP 3u      // TZn of the emergency stop
#define BOARD_PIN_EMERGENCY 14u      // low when it is pressed or its wire broken
#define BOARD_PIN_GATE_ENABLE 26u    // the gates pass while it toggles
#define BOARD_PIN_GATE_FEEDBACK 19u  // high while the gates pass
#define BOARD_ENABLE_TIME_US 1000    // without an edge of the enable line, then the gates are off

// ---- Other pins
#define BOARD_PIN_RELAY 0u  // bridges the precharge resistor
#define BOARD_RELAY_ON_LEVEL 0u
#define BOARD_PIN_BRAKE 2u  // brake resistor across the DC link
#define BOARD_BRAKE_ON_LEVEL 0u
#define BOARD_PIN_RUN 4u  // switch to ground: run
#define BOARD_PIN_FAULT_LAMP 17u
#define BOARD_LAMP_ON_LEVEL 0u
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
#define BOARD_ADC_CURRENTS 2u   // A: current of phase a, B: of phase b; 1.5 V is 0 A
#define BOARD_ADC_SLOW 4u       // A: DC link, B: heat sink's NTC
#define BOARD_ADC_SPEED 5u      // A: DC link once more, B: speed command
#define BOARD_ADC_REFERENCE 6u  // A: ground, B: 1.25 V
#define BOARD_REFERENCE_CODE 1707
#define BOARD_CURRENT_RANGE 2500     // at 3 V, 0.01 A
#define BOARD_LINK_RANGE 5000        // at 3 V, 0.1 V
#define BOARD_COMPARATOR_PERCENT 80  // of the current range, where the over-current comparator fires

// ---- Heat sink: NTC to ground, resistor to the converter's 3 V. Codes at -40, -20 .. 140 degrees C.
#define BOARD_NTC_R25 10000     // ohm
#define BOARD_NTC_BETA 3380     // K
#define BOARD_NTC_PULL_UP 4700  // ohm
#define BOARD_NTC_FIRST (-40)
#define BOARD_NTC_STEP 20
#define BOARD_NTC_POINTS 10u
#define BOARD_NTC_CODES {4016, 3855, 3511, 2952, 2264, 1609, 1093, 733, 495, 341}

#endif
