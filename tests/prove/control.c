// The controllers with any machine, any gains that their designs give, any current to 512 A, any speed to 1.9 rad per
// period: step after step.

#include "control/brake_limit.h"
#include "control/current_controller.h"
#include "control/field_weakening.h"
#include "control/if_start.h"
#include "control/mtpa.h"
#include "control/position_hold.h"
#include "control/ramp.h"
#include "control/speed_controller.h"
#include "tests/prove/any_model.h"

static machine_model_t told, model;

// Whatever is learnt, at any current: from each state to such a state again.
static void keep_model(void) {
  any_model(&told);
  model = told;
  while (any_bool()) {
    if (any_bool()) machine_model_trim(&model, any_from(-Y0_END_Q30, Y0_END_Q30), any_from(-Y0_END_Q30, Y0_END_Q30));
    model.trim.rs_q24 = any_from(-RS_NOMINAL_MAX_Q24 / 2, RS_NOMINAL_MAX_Q24);
    model.trim.psi_q16 = any_from(-TRIM_FLUX_END_Q16, TRIM_FLUX_END_Q16);
    if (any_bool()) machine_model_move(&model, any_from(-CURRENT_MAX_Q20, CURRENT_MAX_Q20));
    if (any_bool()) machine_model_follow(&model, any_from(-CURRENT_MAX_Q20, CURRENT_MAX_Q20));
    if (any_bool()) machine_model_renew_sensitivity(&model);
    if (any_bool()) machine_model_scale_inertia(&model, &told, any_from(RATIO_MIN_Q24, RATIO_MAX_Q24));
    (void)machine_torque_q16(&model, any_dq(CURRENT_MAX_Q20));
  }
}

static void control_currents(void) {
  const current_design_t design = {any_from(100, 2600), 100, any_from(1, 2), (current_corner_t)(any_u16 & 1u)};
  current_controller_config_t c;
  current_controller_t s;
  current_controller_design(&c, &model, &design);
  current_controller_reset(&s);
  while (any_bool()) {
    (void)current_controller_step(&s, &c, &model, any_dq(CURRENT_MAX_Q20), any_dq(CURRENT_MAX_Q20), any_speed());
    if (any_bool()) current_controller_limited(&s, &c, any_dq(VOLTAGE_MAX_Q16 * 4));
  }
}

static void control_speed(void) {
  const speed_controller_config_t c = {any_from(0, 16777216L),   any_from(168L, 16777216L), 10,
                                       any_from(256, 25600000L), any_from(256, 51200L),     any_from(256, 51200L),
                                       any_from(1228, 245760L)};
  static speed_controller_t s;
  if (!speed_controller_init(&s, &c, &model)) return;
  while (any_bool()) {
    const int32_t most = any_from(0, CURRENT_MAX_Q20);
    const speed_controller_input_t in = {
        any_speed(), any_from(-SPEED_MAX_BPP, SPEED_MAX_BPP), any_speed(), any_i32, -most, most};
    if (any_bool()) speed_controller_scale(&s, any_from(2097152L, 134217728L));
    if (any_bool()) speed_controller_preset(&s, any_from(-CURRENT_MAX_Q20, CURRENT_MAX_Q20));
    const int32_t iq_q20 = speed_controller_step(&s, any_bool() ? SPEED_PI : SPEED_PREDICTIVE, &in);
    //@ assert -536870912 <= iq_q20 <= 536870912;
    (void)iq_q20;
  }
}

static void weaken_field(void) {
  field_weakening_t s;
  field_weakening_reset(&s);
  while (any_bool()) {
    const field_weakening_input_t in = {any_speed(),
                                        any_from(-CURRENT_MAX_Q20, CURRENT_MAX_Q20),
                                        any_from(0, INT32_MAX),
                                        any_from(0, VOLTAGE_MAX_Q16),
                                        any_from(0, CURRENT_MAX_Q20),
                                        any_from(0, 104858L)};
    field_weakening_step(&s, &in, &model);
    //@ assert -536870912 <= s.id_q20 <= 0;
    //@ assert -536870912 <= s.trim_q20 <= 536870912;
  }
}

// Any state in which a turn may be.
static void any_vector(if_start_t* s, const if_start_config_t* c) {
  s->tick = any_from(0, c->align_periods);
  s->speed_bpp = any_from(-TURN_MAX_BPP, TURN_MAX_BPP);
  s->mean_q16 = any_dq(TURN_EMF_END_Q16);
  s->per_emf_q4.d = any_i32;
  s->per_emf_q4.q = any_i32;
  s->own_q16 = any_dq(TURN_OWN_END_Q16);
  s->rotor_bpp = any_i32;
  s->mean_bpp = any_i32;
  s->agreed = any_from(-40, IF_START_AGREED - 1);
  s->waited = any_from(-50, c->wait_periods);
  s->sign = (int16_t)any_from(-1, 1);
}

// One step from each state leads to such a state again. A time at rest of `periods` to about twice as many: the current
// rises by a share of it.
static void turn_vector(int32_t periods) {
  if_start_config_t c = {any_from(0, 100 * AMPERES_Q20),
                         any_from(periods, 2 * periods),
                         any_from(0, TURN_MAX_BPP),
                         any_from(1, TURN_MAX_BPP),
                         any_from(0, 100000L),
                         0,
                         0,
                         0,
                         0,
                         0,
                         0,
                         0};
  if_start_t s;
  if (!if_start_design(&c, &model)) return;
  if_start_begin(&s, &c, any_u32, any_bool());
  if (any_bool())
    if_start_begin_turning(&s, &c, any_u32, any_from(0, 100 * AMPERES_Q20), any_from(-TURN_MAX_BPP, TURN_MAX_BPP));
  if (any_bool()) any_vector(&s, &c);
  if (any_bool()) if_start_renew(&s, &c, any_dq(TURN_COMMAND_END_Q16));
  if (if_start_step(&s, &c, any_dq(TURN_COMMAND_END_Q16), any_u32, any_speed()) != IF_START_PENDING) return;
  //@ assert WITHIN(s.mean_q16.d, TURN_EMF_END_Q16) && WITHIN(s.mean_q16.q, TURN_EMF_END_Q16);
  //@ assert -683565276 <= s.speed_bpp <= 683565276 && 0 <= s.tick <= 65536;
  //@ assert -40 <= s.agreed < 3000 && -51 <= s.waited <= 100000;
}

static void limit_and_hold(void) {
  (void)rise_q30(any_i32, any_i32, any_i32);
  position_hold_t h = {false, 0, 0};
  ramp_t r = {0, 0, 0};
  mtpa_t m;
  mtpa_design(&m, &model);
  while (any_bool()) {
    if (any_bool()) position_hold_release(&h);
    (void)position_hold_step(&h, any_u32, any_from(0, 10737418L));
    (void)ramp_step(&r, any_speed(), any_from(0, INT32_MAX));
    (void)mtpa_current_q20(&m, any_i32);
    const brake_limit_input_t in = {any_from(0, VOLTAGE_MAX_Q16), any_from(0, VOLTAGE_MAX_Q16),
                                    any_from(0, VOLTAGE_MAX_Q16), any_from(0, INT32_MAX), any_from(0, INT32_MAX)};
    if (in.start_q16 < in.end_q16) (void)brake_limit_q20(&in, any_from(0, CURRENT_MAX_Q20));
  }
}

void prove_control(void) {
  keep_model();
  if (!make_any_machine(&told)) return;
  model = told;
  machine_model_move(&model, any_from(-CURRENT_MAX_Q20, CURRENT_MAX_Q20));
  control_currents();
  control_speed();
  weaken_field();
  for (int32_t periods = 2; periods <= 32768; periods *= 2) turn_vector(periods);
  limit_and_hold();
}
