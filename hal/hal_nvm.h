// A memory that keeps its content without power: 32 KiB of octets, written in pages.
//
// One job at a time: hal_nvm_read or hal_nvm_write begins it, hal_nvm_step carries it on and says how it stands.
// Nothing here waits; a step takes some 200 cycles, with a full FIFO 500. A job begun must be stepped on, at any pace.
// Octets are 0..255, one in a word, and the caller's until the job is over.
//
// Duration at 400 kbit/s: a read 22.5 us per octet and 0.1 ms, a write the same and up to 5 ms for the memory to store
// it; a write is DONE when that is over. A bus that a device holds is clocked free and the job begun again; a job
// without progress for 10 ms is treated like that, too. It FAILED when that has not helped.

#ifndef STILLSPIN_HAL_HAL_NVM_H
#define STILLSPIN_HAL_HAL_NVM_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_NVM_SIZE 32768u
#define HAL_NVM_PAGE 64u

typedef enum { NVM_IDLE = 0, NVM_BUSY = 1, NVM_DONE = 2, NVM_FAILED = 3 } hal_nvm_state_t;

/// Why the last job failed.
typedef enum {
  NVM_NO_FAULT = 0,
  NVM_NO_ANSWER = 1,  // no memory there, or it still writes
  NVM_BUS_HUNG = 2    // a line is held low, or nothing moves
} hal_nvm_fault_t;

// False when a line of the bus is low: the first job will try to clock it free. Needs hal_clock_init and hal_time_init.
bool hal_nvm_init(void);

// Begin to read count octets (1 or more) from address on; false while a job is under way, or beyond the end.
bool hal_nvm_read(uint16_t address, uint16_t* octets, uint16_t count);

// The same for a write, which must lie within one page.
bool hal_nvm_write(uint16_t address, const uint16_t* octets, uint16_t count);

// One step of the job; DONE or FAILED stays until the next one begins. Background level.
hal_nvm_state_t hal_nvm_step(void);

hal_nvm_fault_t hal_nvm_fault(void);

#ifdef __cplusplus
}
#endif

#endif
