// Transfers on the I2C bus, 400 kbit/s, this chip the only master. Every function returns at once.
//
// A transfer sends two octets of an address inside the device and then writes or reads. i2c_step moves octets between
// the caller's words and the FIFOs; between two steps the module holds the bus when a FIFO runs empty or full, so steps
// may come at any pace. i2c_clear clocks a bus free that a device holds: with the pins as general purpose pins, one
// edge in a step, 10 us apart.

#ifndef STILLSPIN_HAL_F2808_I2C_H
#define STILLSPIN_HAL_F2808_I2C_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
  I2C_BUSY = 0,
  I2C_DONE = 1,
  I2C_NO_ANSWER = 2,  // an octet was not acknowledged; the bus is free again
  I2C_STUCK = 3       // arbitration lost, or nothing has moved for 10 ms: clear the bus
} i2c_result_t;

typedef struct {
  uint16_t device;   // 7-bit address
  uint16_t address;  // inside the device
  uint16_t* read;    // where received octets go; 0 to write
  const uint16_t* write;
  uint16_t count;  // may be 0 for a write
} i2c_transfer_t;

// Pins, clock and module; whatever was under way is forgotten.
void i2c_init(void);

// Both lines are high.
bool i2c_lines_free(void);

// Needs free lines.
void i2c_begin(const i2c_transfer_t* transfer);
i2c_result_t i2c_step(void);

// BUSY, DONE when SDA has come free and a stop has been sent, STUCK when nothing helps.
void i2c_begin_clear(void);
i2c_result_t i2c_clear_step(void);

#endif
