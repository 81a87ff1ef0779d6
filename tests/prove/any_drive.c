// The drive, the store and the board's functions with any answer.

#include "tests/prove/any_drive.h"

#include <stddef.h>

#include "firmware/api/status.h"
#include "firmware/board/functions.h"
#include "firmware/board/selftest.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/config/rules.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/mode.h"
#include "firmware/mode/states.h"
#include "firmware/scope/scope.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/observer/observer.h"
#include "firmware/start/flying/look.h"
#include "firmware/start/step.h"
#include "firmware/store/store.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "hal/hal_sci.h"

drive_t drive;
flux_observer_t flux_observer;
board_t board;
drive_start_t starting;
uint16_t known_beside;
int32_t source_deviation_q20;
void (*volatile drive_onlooker)(void);

static void any_fault(void) {
  const fault_record_t f = {any_u32,
                            (drive_fault_t)any_up_to(40),
                            (drive_state_t)any_up_to(7),
                            (uint16_t)any_up_to(3),
                            any_i32,
                            any_i32,
                            any_i32,
                            any_i32};
  fault_history_add(&f);
}

void any_moment(void) {
  static bool begun;
  if (!begun) scope_reset();
  begun = true;
  if (any_bool()) any_fault();
  drive.state = (drive_state_t)any_up_to(7);
  drive.fault = (drive_fault_t)any_up_to(40);
  drive.control.limits = any_i32;
  drive.modulation.limits = any_u16;
  drive.time_ms = any_u32;
  drive.heartbeat = any_u16;
  feature_status.loading = any_bool();
  feature_status.store_work = any_up_to(3);
  starting.phase = any_up_to(15);
  starting.sigma_q8 = any_i32;
  drive.config.rpm_per_bpp_q40 = any_i32;
  drive.estimate.model.torque_per_accel_q24 = any_i32;
  drive.samples.count = any_up_to(ESTIMATOR_WINDOWS);
  drive.samples.link_q16 = any_i32;
  drive.estimate.selected.angle_bam = any_u32;
  drive.estimate.selected.speed_bpp = any_i32;
  drive.estimate.selected.load_accel_q8 = any_i32;
  drive.estimate.low.angle_bam = any_u32;
  drive.estimate.high.angle_bam = any_u32;
  drive.estimate.blend.share_q15 = any_i32;
  source_deviation_q20 = any_i32;
  flux_observer.load_angle_bam = any_i32;
  flux_observer.machine.psi_q16 = any_i32;
  board.heat_sink_q8 = any_i32;
  known_beside = any_u16;
  drive.control.ramp.value = any_i32;
  drive.estimate.measured_q20.d = any_i32;
  drive.estimate.measured_q20.q = any_i32;
  drive.control.references.current_q20.d = any_i32;
  drive.control.references.current_q20.q = any_i32;
  drive.control.command_q16.d = any_i32;
  drive.control.command_q16.q = any_i32;
  drive.request.speed_rpm_q16 = any_i32;
  drive.modulation.command_q16.alpha = any_i32;
  drive.modulation.command_q16.beta = any_i32;
  scope_step();
}

void drive_parameters_changed(void) {}
void drive_command_start(void) {}
bool drive_start_is_asked(void) { return any_bool(); }
void drive_command_stop(void) {}
void drive_command_coast(void) {}
void drive_command_reset(void) {}
void drive_command_look(void) {}
answer_status_t action_look(octet_writer_t* why) {
  put_packed(why, (packed_text_t)any_up_to((uint16_t)PACKED_TEXTS - 1u));
  return (answer_status_t)any_up_to((uint16_t)ANSWER_EDITION);
}
void put_look(octet_writer_t* w) { put_packed(w, (packed_text_t)any_up_to((uint16_t)PACKED_TEXTS - 1u)); }
look_outcome_t drive_look_outcome(void) { return (look_outcome_t)any_up_to(5); }
int32_t drive_look_rpm(void) { return any_i32; }
uint16_t drive_known(const volatile drive_t* d) { return (uint16_t)(d->heartbeat & any_up_to(3)); }
void drive_command_commission(void) {}
void drive_command_speed(int32_t rpm_q16) { drive.request.speed_rpm_q16 = rpm_q16; }
int32_t drive_commanded_speed(void) { return drive.request.speed_rpm_q16; }
bool drive_is_energised(void) { return any_bool(); }
uint32_t drive_time_ms(void) { return any_u32; }
drive_state_t drive_state(void) { return (drive_state_t)any_up_to(7); }

packed_text_t parameter_conflict(void) { return (packed_text_t)any_up_to((uint16_t)PACKED_NONE); }
packed_text_t parameter_conflict_with(const parameter_info_t* p, int32_t raw) {
  (void)p;
  (void)raw;
  return parameter_conflict();
}
packed_text_t parameter_conflict_known(void) { return (packed_text_t)any_up_to((uint16_t)PACKED_NONE); }

commissioning_outcome_t drive_commissioning_outcome(void) { return (commissioning_outcome_t)any_up_to(5); }
commissioning_phase_t drive_commissioning_phase(void) { return (commissioning_phase_t)any_up_to(6); }
int32_t drive_commissioning_progress(void) { return any_from(0, 1000); }
uint16_t drive_commissioning_count(void) { return any_up_to(30); }
const commissioning_result_t* drive_commissioning_result(uint16_t index) {
  static commissioning_result_t r;
  (void)index;
  r.id = any_u16;
  r.before = any_i32;
  r.value = any_i32;
  r.verdict = (commissioning_verdict_t)any_up_to(7);
  return any_bool() ? &r : NULL;
}

static void any_status(void) {
  feature_status.store_state = any_up_to(11);
  feature_status.store_progress = any_up_to(100);
  feature_status.unsaved = any_up_to(255);
  feature_status.commissioning_outcome = any_up_to(5);
  feature_status.commissioning_phase = any_up_to(6);
  feature_status.commissioning_progress = any_up_to(1000);
}
service_t* const edition_status_updates[] = {any_status, 0};

bool store_save(void) { return any_bool(); }
bool store_load(void) { return any_bool(); }
bool store_defaults(void) { return any_bool(); }
bool store_is_busy(void) { return any_bool(); }
store_state_t store_state(void) { return (store_state_t)any_up_to(11); }
uint16_t store_progress(void) { return any_up_to(100); }
uint16_t store_unsaved(void) { return any_up_to(255); }
const store_report_t* store_report(void) {
  static store_report_t r;
  r.sequence = any_u32;
  r.refused = any_u16;
  r.first_refused = any_u16;
  return &r;
}

static void put_any(octet_writer_t* w) { put_packed(w, (packed_text_t)any_up_to((uint16_t)PACKED_TEXTS - 1u)); }
const status_line_t board_line = {SAY_title_board, put_any};
const status_line_t selftest_line = {SAY_title_self_test, put_any};

uint16_t hal_irq_disable(void) { return any_u16; }
void hal_irq_restore(uint16_t state) { (void)state; }
void hal_profile_step(uint16_t cycles) { (void)cycles; }

uint16_t hal_sci_write(const uint16_t* octets, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) any_u16 = octets[k];
  return any_up_to(count);
}
uint16_t hal_sci_read(uint16_t* octets, uint16_t room) {
  const uint16_t count = any_up_to(room);
  any_octets(octets, count);
  return count;
}
bool hal_sci_take_break(void) { return any_bool(); }
hal_sci_errors_t hal_sci_errors(void) {
  const hal_sci_errors_t e = {any_u16, any_u16, any_u16, any_u16};
  return e;
}
