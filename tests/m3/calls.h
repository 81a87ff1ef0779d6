// Takes the place of hal/f2808/target.h (the replay's objects are compiled with it before anything else): all as for
// the DSP, but that an access is a call, as natively. It comes to as many instructions: the call stands for the load or
// store, and its operands are what these would need.

#ifndef STILLSPIN_HAL_F2808_TARGET_H
#define STILLSPIN_HAL_F2808_TARGET_H

#include <stdint.h>

typedef void (*target_isr_t)(void);

#define TARGET_ISR
#define TARGET_RAM_CODE __attribute__((section("ramfuncs"), noinline))
#define TARGET_INLINE static inline __attribute__((always_inline))
#define TARGET_IDENTITY __attribute__((section("identity")))
#define TARGET_LINKER_NUMBER(symbol) ((uint32_t)(symbol))
#define TARGET_NOP() ((void)0)
#define TARGET_FLUSH_PIPELINE() ((void)0)

uint16_t target_read16(uint32_t address);
void target_write16(uint32_t address, uint16_t value);
uint32_t target_read32(uint32_t address);
void target_write32(uint32_t address, uint32_t value);
void target_eallow(void);
void target_edis(void);
void target_enable_interrupts(void);
void target_disable_interrupts(void);
uint16_t target_read_ier(void);
void target_write_ier(uint16_t mask);
void target_clear_ifr(void);
void target_set_vector(uint16_t vector, target_isr_t isr);
void target_idle(void);
void target_elapse(uint16_t cycles);

#endif
