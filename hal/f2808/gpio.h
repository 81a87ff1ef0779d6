// Pin configuration. The functions lift the register protection by themselves: do not call them between eallow and
// edis.

#ifndef STILLSPIN_HAL_F2808_GPIO_H
#define STILLSPIN_HAL_F2808_GPIO_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/f2808/registers.h"
#include "hal/f2808/target.h"

// Gives the pin (0..34) to a peripheral, as the last of its settings. mux: 1..3; qualification: GPIO_QUALIFY_x.
void gpio_give_to_peripheral(uint16_t pin, uint16_t mux, uint16_t qualification, bool pull_up);

// The same as most pins want it: their first peripheral, asynchronous, pulled up.
void gpio_connect(uint16_t pin);

// Makes the pin an output that starts with the given level.
void gpio_make_output(uint16_t pin, bool level);

// Makes the pin one that pulls its line low or lets it go, and begins with letting go.
void gpio_make_open_drain(uint16_t pin);
void gpio_pull_low(uint16_t pin, bool low);

void gpio_write(uint16_t pin, bool level);

// Of a pin that is known when it is compiled it is one write.
static inline void gpio_toggle(uint16_t pin) {
  target_write32(pin < 32u ? REG_GPATOGGLE : REG_GPBTOGGLE, 1uL << (pin & 31u));
}

// Level at the pin, whatever it is used for.
bool gpio_read(uint16_t pin);

#endif
