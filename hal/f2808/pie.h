// The interrupt controller in terms of vectors: groups of eight, a flag for each, an acknowledge for the group.

#ifndef STILLSPIN_HAL_F2808_PIE_H
#define STILLSPIN_HAL_F2808_PIE_H

#include <stdint.h>

#include "hal/f2808/registers.h"
#include "hal/f2808/target.h"

#define PIE_GROUPS 12u
#define PIE_GROUP(vector) (((vector) - VECTOR_PIE_FIRST) / 8u + 1u)                        // 1..12
#define PIE_CHANNEL_MASK(vector) ((uint16_t)(1u << (((vector) - VECTOR_PIE_FIRST) % 8u)))  // in PIEIER, PIEIFR
#define PIE_GROUP_MASK(group) ((uint16_t)(1u << ((group) - 1u)))                           // in PIEACK, IER, IFR

// Lets the group's next interrupt through, once its peripheral's flag has been cleared. The pause keeps a following
// interrupt enable or return off the acknowledge: directly one after the other they can take the group's first vector
// (SPRZ171, nested interrupts).
static inline void pie_acknowledge(uint16_t group) {
  target_write16(REG_PIEACK, PIE_GROUP_MASK(group));
  TARGET_NOP();
}

// Holds every interrupt off, by IER: its value can be read and put back, INTM's cannot. hold returns what release has
// to be given.
static inline uint16_t irq_hold(void) {
  const uint16_t state = target_read_ier();
  target_write_ier(0u);
  return state;
}
static inline void irq_release(uint16_t state) { target_write_ier(state); }

#endif
