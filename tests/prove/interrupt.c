// The control interrupt and the window interrupts, period after period without end: any codes of the converter, any
// counts of the encoder, any state of the pins, any wishes of the background level, and any parameters, changed at any
// time. The floors below are read by themselves; here they are what they promise (*_ranges.h).

#include <string.h>

#include "firmware/base/clear.h"
#include "firmware/board/functions.h"
#include "firmware/board/selftest.h"
#include "firmware/commissioning/commissioning.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/commissioning/result.h"
#include "firmware/config/config.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/sampling.h"
#include "firmware/drive/steps.h"
#include "firmware/hysteresis/hysteresis.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/interfaces/service.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "firmware/scope/scope.h"
#include "firmware/sources/encoder/encoder.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/paper/paper.h"
#include "firmware/start/flying/flying.h"
#include "firmware/start/flying/look.h"
#include "firmware/start/if_start/if_start.h"
#include "firmware/start/start.h"
#include "firmware/start/step.h"
#include "firmware/store/store.h"
#include "hal/hal_adc.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_encoder.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "hal/hal_pwm.h"
#include "hal/hal_replay.h"
#include "hal/hal_safety.h"
#include "hal/hal_sampling_timer.h"
#include "tests/prove/any_config.h"
#include "tests/prove/any_flux.h"
#include "tests/prove/any_parameters.h"

// EVA knows memset as a whole, but octet after octet of a structure as anything.
void clear(void* at, size_t count) { (void)memset(at, 0, count); }

void hal_adc_read_window(hal_adc_window_t* w) {
  w->start_a = any_up_to(4u * 4095u);
  w->start_b = any_up_to(4u * 4095u);
  w->end_a = any_up_to(3u * 4095u);
  w->end_b = any_up_to(3u * 4095u);
  w->link = any_up_to(4095);
  w->aux = any_up_to(4095);
}

void hal_sampling_timer_read(hal_timed_samples_t* slice) {
  slice->current_a = any_up_to(4095);
  slice->current_b = any_up_to(4095);
  slice->link = any_up_to(4095);
}

uint32_t hal_encoder_count(void) { return any_u32; }
uint16_t hal_irq_disable(void) { return any_u16; }
void hal_irq_restore(uint16_t state) { (void)state; }
uint16_t hal_irq_unexpected_count(void) { return any_u16; }
bool hal_digital_io_emergency(void) { return any_bool(); }
void hal_profile_step(uint16_t cycles) { (void)cycles; }
void hal_pwm_gates_off(void) {}
bool hal_pwm_gates_on(void) { return any_bool(); }
bool hal_pwm_is_tripped(void) { return any_bool(); }
bool hal_pwm_was_tripped_by_pin(void) { return any_bool(); }
uint16_t hal_pwm_period_tick(void) { return any_up_to(HAL_PWM_PERIOD_TICKS); }
bool hal_pwm_write(const hal_pwm_frame_t* frame, uint16_t deadline_tick) {
  (void)frame;
  (void)deadline_tick;
  return any_bool();
}
void hal_safety_fault_lamp(bool lit) { (void)lit; }
void hal_safety_toggle_enable(void) {}
void hal_sampling_timer_set_legs(uint16_t state) { (void)state; }
bool hal_sampling_timer_begin(uint16_t slice_ticks) {
  (void)slice_ticks;
  return any_bool();
}
void hal_sampling_timer_end(void) {}
static void nothing_else(void) {}
const phase_control_t* const edition_phase_control = &hysteresis_control;
service_t* const edition_resets[] = {scope_reset, nothing_else,  board_reset, start_reset,         flux_reset,
                                     paper_reset, encoder_reset, look_reset,  commissioning_reset, NULL};
work_t* const edition_works[] = {commissioning_service, NULL};
static drive_fault_t any_refusal(void) { return any_bool() ? FAULT_SELF_TEST : FAULT_NONE; }
interlock_t* const edition_interlocks[] = {any_refusal, board_refusal, NULL};
static int32_t any_share(void) { return any_from(0, INTERLOCK_SHARE_ONE); }
current_share_t* const edition_current_shares[] = {board_current_share, any_share, NULL};
void selftest_reset(void) {}
void hal_encoder_init(uint32_t counts_per_turn) { (void)counts_per_turn; }
bool hal_pwm_set_dead_band(uint16_t ticks) { return any_bool(); }
bool hal_replay_has_work(replay_work_t work) { return true; }
void hal_replay_work_begin(replay_work_t work) { (void)work; }
void hal_replay_work_end(void) {}

// The background level's part in the commissioning.
void commissioning_judge(const commissioning_t* c, commissioning_report_t* report) {
  (void)c;
  report->count = 0;
}
commissioning_outcome_t commissioning_use(commissioning_report_t* report) {
  (void)report;
  any_parameters();
  return any_bool() ? COMMISSIONING_DONE : COMMISSIONING_PARTLY;
}
bool commissioning_judge_level(commissioning_t* c) {
  c->map.slope_q20 = any_i32;
  return any_bool();
}
void commissioning_solve_motion(commissioning_t* c) {
  c->torque_q24 = any_i32;
  c->accel_q12 = any_i32;
}

// Within their ranges from the first on: the part configuration reads how they come to what they are.
parameters_t parameters;
void parameters_reset(parameters_t* of) {
  (void)of;
  any_parameters();
}

// The constants that features have beside it.
static void any_parts(void) {
  encoder_part.take();  // of the parameters, which are any
  (void)hysteresis_part.make(&drive.config);
  hysteresis_part.take();
  flying_part.take();
  start_ways.open_loop = any_bool();
  any_flux(&flux_config);
  paper_config.kp_q30 = any_from(0, 107374182L);
  paper_config.ki_q40 = any_from(0, 220000000L);
  paper_config.terms = (uint16_t)any_from(0, 31);
  if_ramp_config.current_q20 = any_from(0, 100 * AMPERES_Q20);
  if_ramp_config.align_periods = any_from(2, 50000L);
  if_ramp_config.step_bpp = any_from(1, 683565276L);
  if_ramp_config.speed_bpp = any_from(1, 683565276L);
  if_ramp_config.wait_periods = any_from(0, 100000L);
  if_ramp_config.damping_periods = any_from(1, 65536L);
  if_ramp_config.per_emf_q4 = any_from(0, INT32_MAX);
  if_ramp_config.follow_bpp = any_from(0, INT32_MAX);
  if_ramp_config.reactance_q47 = any_from(0, INT32_MAX);
  if_ramp_config.filter_shift = (uint16_t)any_from(0, 15);
  if_ramp_config.resistance_q24 = any_from(16777L, 838860800L);
  if_ramp_config.least_q16 = any_from(0, 100 * VOLTS_Q16);
}

// Of whatever parameters it is made.
static void any_made(drive_config_t* c) {
  any_config(c);
  any_parameters();
#define CONFIG_VALUE(name) c->values.name = parameters.name;
#include "firmware/interfaces/all_config_values.h"
#undef CONFIG_VALUE
}

void drive_config_take(drive_config_t* c) {
  any_made(c);
  any_parts();
}

const config_part_t* const edition_config_parts[] = {&encoder_part, NULL};

// Asked after power-on alone: of the defaults, which fit together.
packed_text_t drive_config_make(void) { return PACKED_NONE; }

packed_text_t parameter_conflict(void) { return any_bool() ? PACKED_NONE : any_up_to(PACKED_NONE - 1u); }

static void one_period(void) {
  if (any_bool()) any_parameters();
  if (any_bool()) drive_parameters_changed();
  if (any_bool()) background_step(&drive);
  drive.request.stop = any_bool();
  drive.request.coast = any_bool();
  drive.request.reset = any_bool();
  static const state_request_t start = {DRIVE_START, DRIVE_RUN}, commission = {DRIVE_COMMISSION, DRIVE_READY},
                               look = {DRIVE_START, DRIVE_READY};
  drive.request.begin = any_bool() ? NULL : any_bool() ? &start : any_bool() ? &commission : &look;
  feature_status.loading = any_bool();
  drive.request.speed = any_bool();
  drive.request.speed_rpm_q16 = any_i32;
  for (uint16_t k = 0; k < 3u; k++) {
    if (any_bool()) drive_window_interrupt();
  }
  drive_control_step(&drive);
  if (any_bool()) scope_step();  // EVA calls nothing by a pointer that it reads as volatile
}

void prove_interrupt(void) {
  drive_reset();
  any_parameters();
  // Where what the code limits ends, so that EVA does not look farther.
  /*@ loop widen_hints "all", -536870912, -268435456, -134217728, -8388608, -10000, 5, 8, 14, 10000, 5242880,
     134217728, 268435456, 536870912; */
  while (any_bool()) one_period();
}
