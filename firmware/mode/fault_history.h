// The last faults, with what the drive saw in the control interrupt that raised them. Lost with the power.
//
// The control interrupt writes, the background level reads: a record that is overwritten while it is read is read
// again.

#ifndef STILLSPIN_FIRMWARE_MODE_FAULT_HISTORY_H
#define STILLSPIN_FIRMWARE_MODE_FAULT_HISTORY_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/mode/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define FAULT_HISTORY_DEPTH 16u  // a power of two

typedef struct {
  uint32_t time_ms;       // since power-on
  drive_fault_t fault;    // the cause
  drive_state_t state;    // in which it happened
  uint16_t known;         // bits of known_t; what is not is 0
  int32_t speed_q16;      // rpm, mechanical
  int32_t link_q16;       // V
  int32_t current_d_q20;  // A, mean of the period before
  int32_t current_q_q20;
} fault_record_t;

void fault_history_reset(void);

/// Control interrupt level.
void fault_history_add(const fault_record_t* record);

/// Faults since power-on; stays at 65535.
uint16_t fault_history_total(void);

/// The fault `age` places before the newest (0). False when there is none, or it is forgotten.
bool fault_history_read(uint16_t age, fault_record_t* record);

#if defined(__cplusplus)
}
#endif

#endif
