// What keeps the power stage off, and what is left of its current: asked by start and protection, answered by who
// watches over the board (board/).

#ifndef STILLSPIN_FIRMWARE_MODE_INTERLOCK_H
#define STILLSPIN_FIRMWARE_MODE_INTERLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/mode/states.h"

#if defined(__cplusplus)
extern "C" {
#endif

#define INTERLOCK_SHARE_ONE ((int32_t)32768)  // Q15

/// FAULT_NONE, or what it has against a start. Control interrupt level.
typedef drive_fault_t interlock_t(void);
/// Those of the edition, NULL behind the last one (editions/).
extern interlock_t* const edition_interlocks[];

/// Of current_limit what somebody leaves, Q15, 0 or more. Background level.
typedef int32_t current_share_t(void);
/// Those of the edition, NULL behind the last one (editions/).
extern current_share_t* const edition_current_shares[];

/// Of current_limit what was left then, Q15.
extern int32_t interlock_share_q15;

/// Largest phase current by the least of these, A, Q20. Background level.
int32_t interlock_current_limit(void);

/// Whether that is less than the whole: something has to cool.
bool interlock_is_warm(void);

/// What keeps the drive from starting, FAULT_NONE when nothing does.
drive_fault_t interlock_refusal(void);

/// Why the gates are off although nobody has switched them off.
drive_fault_t interlock_why_off(void);

/// The emergency stop, where one is wired.
drive_fault_t interlock_emergency(void);

#if defined(__cplusplus)
}
#endif

#endif
