// The CPU as the drivers see it: register access, interrupt control, placement of functions.
//
// This is the one header in which the build for the DSP and the native build differ. For the DSP an access is a
// volatile access; natively it is a call into the virtual chip, which lets time pass there.

#ifndef STILLSPIN_HAL_F2808_TARGET_H
#define STILLSPIN_HAL_F2808_TARGET_H

#include <stdint.h>

typedef void (*target_isr_t)(void);

#if defined(__TMS320C28XX__)

extern __cregister volatile unsigned int IER;
extern __cregister volatile unsigned int IFR;

#define TARGET_ISR __interrupt  // an interrupt function: full context, returns by IRET
#define TARGET_RAM_CODE __attribute__((section("ramfuncs"), noinline))  // runs from RAM in every image
#define TARGET_INLINE static inline __attribute__((always_inline))      // so that what runs from RAM stays there
#define TARGET_IDENTITY __attribute__((section("identity")))  // at the fixed place of the linker command files
#define TARGET_LINKER_NUMBER(symbol) ((uint32_t)(symbol))     // a number that the linker gives as an address
#define TARGET_NOP() __asm(" NOP")
#define TARGET_FLUSH_PIPELINE() __asm(" RPT #7 || NOP")

#define TARGET_VECTOR_TABLE 0x0D00uL  // 128 vectors of two words

TARGET_INLINE uint16_t target_read16(uint32_t address) { return *(volatile uint16_t*)address; }
TARGET_INLINE void target_write16(uint32_t address, uint16_t value) { *(volatile uint16_t*)address = value; }
TARGET_INLINE uint32_t target_read32(uint32_t address) { return *(volatile uint32_t*)address; }
TARGET_INLINE void target_write32(uint32_t address, uint32_t value) { *(volatile uint32_t*)address = value; }
TARGET_INLINE void target_eallow(void) { __asm(" EALLOW"); }
TARGET_INLINE void target_edis(void) { __asm(" EDIS"); }
TARGET_INLINE void target_enable_interrupts(void) { __asm(" CLRC INTM"); }
TARGET_INLINE void target_disable_interrupts(void) { __asm(" SETC INTM"); }
TARGET_INLINE uint16_t target_read_ier(void) { return IER; }
TARGET_INLINE void target_write_ier(uint16_t mask) { IER = mask; }
TARGET_INLINE void target_clear_ifr(void) { IFR = 0u; }
TARGET_INLINE void target_set_vector(uint16_t vector, target_isr_t isr) {
  *(volatile target_isr_t*)(TARGET_VECTOR_TABLE + 2uL * vector) = isr;
}
TARGET_INLINE void target_idle(void) { __asm(" IDLE"); }
TARGET_INLINE void target_elapse(uint16_t cycles) { (void)cycles; }

#else

#define TARGET_ISR
#define TARGET_RAM_CODE
#define TARGET_IDENTITY
#define TARGET_LINKER_NUMBER(symbol) ((uint32_t)(uintptr_t)(symbol))
#define TARGET_NOP() ((void)0)
#define TARGET_FLUSH_PIPELINE() ((void)0)

#ifdef __cplusplus
extern "C" {
#endif

// Word addresses of data space, see registers.h. A 32-bit access is one access: it does not tear.
uint16_t target_read16(uint32_t address);
void target_write16(uint32_t address, uint16_t value);
uint32_t target_read32(uint32_t address);
void target_write32(uint32_t address, uint32_t value);

// Lifts the write protection of the registers marked (EALLOW), and puts it back. Not counted: the first edis ends it.
void target_eallow(void);
void target_edis(void);

// INTM, IER and IFR of the CPU; bit n - 1 of the latter two is PIE group n.
void target_enable_interrupts(void);
void target_disable_interrupts(void);
uint16_t target_read_ier(void);
void target_write_ier(uint16_t mask);
void target_clear_ifr(void);

// Puts isr into the PIE vector table; needs eallow.
void target_set_vector(uint16_t vector, target_isr_t isr);

// Sleeps until an interrupt has been taken.
void target_idle(void);

// The code since the last access takes this many SYSCLK cycles on the chip.
void target_elapse(uint16_t cycles);

#ifdef __cplusplus
}
#endif

#endif

#endif
