// What a user may ask of the commissioning (api/actions.h).

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_ACTIONS_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_ACTIONS_H

#include "firmware/api/actions.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Watchdog and holder as of action_start.
answer_status_t action_commission(comm_watchdog_t watchdog, uint32_t holder, octet_writer_t* why);

/// Writes into feature_status how far it is.
void commissioning_status_update(void);

#if defined(__cplusplus)
}
#endif

#endif
