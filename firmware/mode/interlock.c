#include "firmware/mode/interlock.h"

#include <stddef.h>

#include "firmware/mode/mode.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_irq.h"
#include "hal/qmath/qcall.h"

int32_t interlock_share_q15;

int32_t interlock_current_limit(void) {
  int32_t least_q15 = INTERLOCK_SHARE_ONE;
  for (uint16_t k = 0; edition_current_shares[k] != NULL; k++) {
    least_q15 = q_min(least_q15, edition_current_shares[k]());
  }
  interlock_share_q15 = least_q15;
  return qc_mul(drive.config.values.current_limit, least_q15, 15);
}

bool interlock_is_warm(void) { return interlock_share_q15 < INTERLOCK_SHARE_ONE; }

drive_fault_t interlock_emergency(void) {
  return drive.config.values.emergency_stop != 0 && hal_digital_io_emergency() ? FAULT_EMERGENCY : FAULT_NONE;
}

drive_fault_t interlock_refusal(void) {
  if (hal_irq_unexpected_count() != 0u) return FAULT_INTERRUPT;
  for (uint16_t k = 0; edition_interlocks[k] != NULL; k++) {
    const drive_fault_t fault = edition_interlocks[k]();
    if (fault != FAULT_NONE) return fault;
  }
  return interlock_emergency();
}

drive_fault_t interlock_why_off(void) {
  if (hal_irq_unexpected_count() != 0u) return FAULT_INTERRUPT;  // which has switched them off
  const drive_fault_t fault = interlock_emergency();
  return fault == FAULT_NONE ? FAULT_GATES_OFF : fault;
}
