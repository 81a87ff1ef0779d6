// Reading and changing fields of registers, in the words of registers.h.
//
// REG_FIELD(EPWM_TBCTL_SYNCOSEL, 1u) is a value in its place. A change is a read and a write: not to be used where a
// read or a written one has a side effect (flag registers), nor on a register that another interrupt level changes as
// well.

#ifndef STILLSPIN_HAL_F2808_REG_ACCESS_H
#define STILLSPIN_HAL_F2808_REG_ACCESS_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/f2808/target.h"

// `field` is a name of registers.h without _LSB and _MASK, of a 16-bit register.
#define REG_FIELD(field, value) ((uint16_t)(((uint32_t)(value) << field##_LSB) & field##_MASK))
#define REG_SET_FIELD(address, field, value) reg_change((address), (uint16_t)(field##_MASK), REG_FIELD(field, (value)))
#define REG_GET_FIELD(address, field) ((uint16_t)((target_read16(address) & field##_MASK) >> field##_LSB))

static inline void reg_change(uint32_t address, uint16_t mask, uint16_t bits) {
  const uint16_t kept = (uint16_t)(target_read16(address) & (uint16_t)~mask);
  target_write16(address, (uint16_t)(kept | bits));
}

static inline void reg32_change(uint32_t address, uint32_t mask, uint32_t bits) {
  target_write32(address, (target_read32(address) & ~mask) | bits);
}

static inline bool reg_any(uint32_t address, uint16_t mask) { return (target_read16(address) & mask) != 0u; }

#endif
