#include "hal/f2808/gpio.h"

#include "hal/f2808/f2808_values.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"

// Port B has the registers of port A, this many words further.
#define PORT_B_CONTROL_OFFSET (REG_GPBCTRL - REG_GPACTRL)
#define PORT_B_DATA_OFFSET (REG_GPBDAT - REG_GPADAT)

static uint32_t bit_of(uint16_t pin) { return 1uL << (pin & 31u); }

static uint32_t control_register(uint16_t pin, uint32_t port_a_register) {
  return pin < 32u ? port_a_register : port_a_register + PORT_B_CONTROL_OFFSET;
}

static uint32_t data_register(uint16_t pin, uint32_t port_a_register) {
  return pin < 32u ? port_a_register : port_a_register + PORT_B_DATA_OFFSET;
}

// Multiplexer and qualification have two bits a pin and two registers of sixteen pins each, one after the other.
static void set_pair_of_bits(uint16_t pin, uint32_t port_a_first_register, uint16_t value) {
  const uint32_t half = (pin & 16u) != 0u ? 2uL : 0uL;
  const uint16_t lsb = (uint16_t)(2u * (pin & 15u));
  reg32_change(control_register(pin, port_a_first_register) + half, 3uL << lsb, (uint32_t)value << lsb);
}

void gpio_give_to_peripheral(uint16_t pin, uint16_t mux, uint16_t qualification, bool pull_up) {
  target_eallow();
  reg32_change(control_register(pin, REG_GPAPUD), bit_of(pin), pull_up ? 0uL : bit_of(pin));
  set_pair_of_bits(pin, REG_GPAQSEL1, qualification);
  set_pair_of_bits(pin, REG_GPAMUX1, mux);
  target_edis();
}

void gpio_connect(uint16_t pin) { gpio_give_to_peripheral(pin, GPIO_MUX_FIRST, GPIO_QUALIFY_NONE, true); }

void gpio_make_output(uint16_t pin, bool level) {
  gpio_write(pin, level);
  target_eallow();
  set_pair_of_bits(pin, REG_GPAMUX1, GPIO_MUX_GPIO);
  reg32_change(control_register(pin, REG_GPADIR), bit_of(pin), bit_of(pin));
  target_edis();
}

void gpio_make_open_drain(uint16_t pin) {
  gpio_write(pin, false);
  gpio_pull_low(pin, false);
  target_eallow();
  set_pair_of_bits(pin, REG_GPAMUX1, GPIO_MUX_GPIO);
  target_edis();
}

// By its direction: the output latch is low.
void gpio_pull_low(uint16_t pin, bool low) {
  target_eallow();
  reg32_change(control_register(pin, REG_GPADIR), bit_of(pin), low ? bit_of(pin) : 0uL);
  target_edis();
}

void gpio_write(uint16_t pin, bool level) {
  target_write32(data_register(pin, level ? REG_GPASET : REG_GPACLEAR), bit_of(pin));
}

bool gpio_read(uint16_t pin) { return (target_read32(data_register(pin, REG_GPADAT)) & bit_of(pin)) != 0uL; }
