// Which pin of the chip is what on the board.

#ifndef STILLSPIN_HAL_F2808_BOARD_H
#define STILLSPIN_HAL_F2808_BOARD_H

#define BOARD_PIN_FIRST_GATE 0u  // GPIO0..5: a upper, a lower, b upper, b lower, c upper, c lower
#define BOARD_GATE_PINS 6u
#define BOARD_PIN_OVER_CURRENT 12u  // TZ1, low when the comparator has fired
#define BOARD_PIN_ENCODER_A 20u
#define BOARD_PIN_ENCODER_B 21u
#define BOARD_PIN_ENCODER_INDEX 23u
#define BOARD_PIN_FAULT_LAMP 27u
#define BOARD_PIN_SERIAL_IN 28u   // SCI-A
#define BOARD_PIN_SERIAL_OUT 29u  // also a boot-mode pin: keep loads light while the chip comes out of reset
#define BOARD_PIN_CAN_RECEIVE 30u
#define BOARD_PIN_CAN_TRANSMIT 31u
#define BOARD_PIN_SDA 32u
#define BOARD_PIN_SCL 33u
#define BOARD_PIN_GATE_ENABLE 34u  // kept alive by toggling

#endif
