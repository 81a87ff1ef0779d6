// The chip's registers and memory with any contents at every access.

#include "hal/f2808/target.h"
#include "tests/prove/any.h"

uint16_t target_read16(uint32_t address) {
  (void)address;
  return any_u16;
}
uint32_t target_read32(uint32_t address) {
  (void)address;
  return any_u32;
}
void target_write16(uint32_t address, uint16_t value) {
  (void)address;
  (void)value;
}
void target_write32(uint32_t address, uint32_t value) {
  (void)address;
  (void)value;
}
void target_eallow(void) {}
void target_edis(void) {}
void target_enable_interrupts(void) {}
void target_disable_interrupts(void) {}
uint16_t target_read_ier(void) { return any_u16; }
void target_write_ier(uint16_t mask) { (void)mask; }
void target_clear_ifr(void) {}
void target_idle(void) {}
void target_elapse(uint16_t cycles) { (void)cycles; }

// An interrupt comes as soon as it can.
void target_set_vector(uint16_t vector, target_isr_t isr) {
  //@ assert vector < 128;
  isr();
}
