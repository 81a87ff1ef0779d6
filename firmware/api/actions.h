// What a user may ask of the drive, whoever passes it on: checked, with the reason in words when it is refused.
// Console, link and bus call these, so that all of them refuse the same things in the same words.
//
// A reason says what was wrong, the value, the range and what to do; it is appended to `why`. Background level.

#ifndef STILLSPIN_FIRMWARE_API_ACTIONS_H
#define STILLSPIN_FIRMWARE_API_ACTIONS_H

#include "firmware/api/comm_watchdog.h"
#include "firmware/base/octets.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// The numbers are those of the link's answers: stable. words(CATALOGUE_STATUS, .) has their words.
typedef enum {
  ANSWER_OK = 0,
  ANSWER_UNKNOWN = 1,
  ANSWER_RANGE = 2,
  ANSWER_RUNNING = 3,  // not while the power stage is on
  ANSWER_LENGTH = 4,
  ANSWER_BUSY = 5,
  ANSWER_STATE = 6,     // not in this state of the drive
  ANSWER_CONFLICT = 7,  // parameters that do not fit together
  ANSWER_EDITION = 8    // of a feature that is not in this edition of the firmware
} answer_status_t;

/// Whether the drive can begin anything now.
answer_status_t action_may_begin(octet_writer_t* why);

/// With a watchdog, `link_timeout` without a record of its holder stops the drive again (comm_watchdog.h).
answer_status_t action_start(comm_watchdog_t watchdog, uint32_t holder, octet_writer_t* why);

/// Always taken: what is not under way need not be stopped.
void action_stop(void);
void action_coast(void);

answer_status_t action_reset(octet_writer_t* why);

/// rpm Q16.
answer_status_t action_speed(int32_t rpm_q16, octet_writer_t* why);

/// CONFLICT says which parameters do not fit together. With the power stage off the value is taken all the same, since
/// the others may follow; while the drive runs it is not.
answer_status_t action_set(const parameter_info_t* parameter, int32_t raw, octet_writer_t* why);

/// The rest of a refusal behind the value: the range that holds, and that nothing has changed.
void put_range(octet_writer_t* w, const parameter_info_t* parameter);
void put_speed_limit(octet_writer_t* w, packed_text_t why);

/// A rule that does not hold, with what the parameters that it names are now.
void put_conflict(octet_writer_t* w, packed_text_t conflict);

void put_name(octet_writer_t* w, const parameter_info_t* parameter);
/// The name, and that it is what follows; and the value in use, with its unit.
void put_name_is(octet_writer_t* w, const parameter_info_t* parameter);
void put_in_use(octet_writer_t* w, const parameter_info_t* parameter);

/// A value in user's units, as the table has its decimals.
void put_number(octet_writer_t* w, const parameter_info_t* parameter, int32_t raw);
/// The same with its unit.
void put_value(octet_writer_t* w, const parameter_info_t* parameter, int32_t raw);
/// From the least value to the largest.
void put_span(octet_writer_t* w, const parameter_info_t* parameter);

#if defined(__cplusplus)
}
#endif

#endif
