#include "firmware/api/actions.h"

#include <stddef.h>

#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/dictionary/units.h"
#include "firmware/mode/mode.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"
#include "hal/qmath/qcall.h"

#define NAME_MAX 32u  // characters of a parameter's name, and some

answer_status_t action_may_begin(octet_writer_t* why) {
  const packed_text_t conflict = parameter_conflict_known();
  switch (drive.state) {
    case DRIVE_READY:
      if (conflict == PACKED_NONE) return ANSWER_OK;
      put_conflict(why, conflict);
      return ANSWER_CONFLICT;
    case DRIVE_FAULT:
      put_packed(why, SAY_a_fault_is_latched_reset_it_first);
      put_message(why, CATALOGUE_FAULT, (uint16_t)drive.fault);
      return ANSWER_STATE;
    case DRIVE_BOOT:
    case DRIVE_CALIBRATE:
      put_packed(why, SAY_the_drive_is_not_ready_yet);
      break;
    default:
      put_packed(why, SAY_the_drive_is_busy_stop_it_first);
      break;
  }
  put_message(why, CATALOGUE_STATE, (uint16_t)drive.state);
  return ANSWER_STATE;
}

answer_status_t action_start(comm_watchdog_t watchdog, uint32_t holder, octet_writer_t* why) {
  const answer_status_t status = action_may_begin(why);
  if (status != ANSWER_OK) return status;
  comm_watchdog_begin(watchdog, holder);
  drive_command_start();
  return ANSWER_OK;
}

void action_stop(void) { drive_command_stop(); }

void action_coast(void) { drive_command_coast(); }

answer_status_t action_reset(octet_writer_t* why) {
  if (drive.state != DRIVE_FAULT) {
    put_packed(why, SAY_no_fault_is_latched);
    return ANSWER_STATE;
  }
  drive_command_reset();
  return ANSWER_OK;
}

static int32_t speed_limit_q16(void) { return parameters.speed_limit * 256; }

void put_speed_limit(octet_writer_t* w, packed_text_t why) {
  put_packed(w, why);
  put_fixed(w, speed_limit_q16(), 16, 0);
  put_packed(w, SAY_rpm_nothing_changed);
}

answer_status_t action_speed(int32_t rpm_q16, octet_writer_t* why) {
  if (qc_abs_sat(rpm_q16) <= speed_limit_q16()) {
    drive_command_speed(rpm_q16);
    return ANSWER_OK;
  }
  put_fixed(why, rpm_q16, 16, 1);
  put_speed_limit(why, SAY_rpm_is_beyond_speed_limit);
  return ANSWER_RANGE;
}

void put_name(octet_writer_t* w, const parameter_info_t* parameter) { put_packed(w, parameter_name(parameter)); }

void put_name_is(octet_writer_t* w, const parameter_info_t* parameter) {
  put_name(w, parameter);
  put_packed(w, SAY_is);
}

void put_in_use(octet_writer_t* w, const parameter_info_t* parameter) {
  put_name_is(w, parameter);
  put_value(w, parameter, *parameter_in_use(parameter));
}

void put_number(octet_writer_t* w, const parameter_info_t* parameter, int32_t raw) {
  put_quantity(w, raw, parameter->unit, parameter->q, parameter->decimals);
}

void put_value(octet_writer_t* w, const parameter_info_t* parameter, int32_t raw) {
  put_number(w, parameter, raw);
  put_unit(w, parameter_unit(parameter));
}

void put_span(octet_writer_t* w, const parameter_info_t* parameter) {
  put_number(w, parameter, parameter_minimum(parameter));
  put_packed(w, SAY_to);
  put_value(w, parameter, parameter_maximum(parameter));
}

void put_range(octet_writer_t* w, const parameter_info_t* parameter) {
  put_span(w, parameter);
  put_packed(w, SAY_nothing_changed);
}

static bool is_of_a_name(uint16_t c) { return c >= '0' && c != ':'; }

void put_conflict(octet_writer_t* w, packed_text_t conflict) {
  uint16_t name[NAME_MAX];
  uint16_t count = 0, c;
  packed_text_t separator = SAY_opens_list;
  packed_reader_t r = packed_reader(conflict);
  put_packed(w, conflict);
  do {
    c = packed_next(&r);
    if (is_of_a_name(c) && count < NAME_MAX) {
      name[count++] = c;
      continue;
    }
    const parameter_info_t* const p = parameter_named(name, count);
    count = 0;
    if (p == NULL) continue;
    put_packed(w, separator);
    put_in_use(w, p);
    separator = SAY_comma;
  } while (c != 0u);
  put_u8(w, ')');  // every rule names a parameter
}

// With one decimal more where the table's are too few to show what is wrong.
static answer_status_t refuse_range(const parameter_info_t* p, int32_t raw, octet_writer_t* why) {
  put_name_is(why, p);
  put_quantity(why, raw, p->unit, p->q, (uint16_t)(p->decimals + 1u));
  put_packed(why, SAY_is_outside_of);
  put_range(why, p);
  return ANSWER_RANGE;
}

// Values that do not fit together are taken while the drive is off. Once a change is told of no start is taken, so what
// is seen of the power stage stays true.
static bool is_refused(packed_text_t conflict) {
  if (conflict == PACKED_NONE) return false;
  drive_parameters_changed();
  return drive_is_energised();
}

// What it would conflict with is known before the table has it.
static answer_status_t set(const parameter_info_t* p, int32_t raw, octet_writer_t* why) {
  const packed_text_t conflict = parameter_conflict_with(p, raw);
  const bool refused = is_refused(conflict);
  if (!refused) parameter_change(p, raw);
  if (conflict == PACKED_NONE) return ANSWER_OK;
  put_packed(why, refused ? SAY_not_taken_while_the_drive_runs : SAY_set_but_the_drive_does_not_start);
  put_conflict(why, conflict);
  return ANSWER_CONFLICT;
}

answer_status_t action_set(const parameter_info_t* parameter, int32_t raw, octet_writer_t* why) {
  switch (parameter_settable(parameter_by_id(parameter->id), raw)) {
    case SET_OK:
      return set(parameter, raw, why);
    case SET_RANGE:
      return refuse_range(parameter, raw, why);
    case SET_RUNNING:
      put_name(why, parameter);
      put_packed(why, SAY_may_not_change_while_the_power_stage);
      return ANSWER_RUNNING;
    default:
      return ANSWER_UNKNOWN;
  }
}
