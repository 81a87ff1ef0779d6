#include "control/speed_controller.h"

#include "hal/qmath/qcall.h"

#define ONE_Q30 1073741824L

// 1 - x/n + x^2/(n (n + 1)) - ... for 0 <= x < 1, Q30: exact where B Ts / J is tiny.
static int32_t series_q30(int32_t x_q30, int32_t n) {
  int32_t sum = ONE_Q30;
  int32_t term = ONE_Q30;
  for (; n <= 7; n++) {
    term = -qc_mul(term, x_q30, 30) / n;
    sum += term;
  }
  return sum;
}

static int32_t exp_minus_q30(int32_t x_q30) { return series_q30(x_q30, 1); }

// (1 - exp(-x)) / x
static int32_t mean_decay_q30(int32_t x_q30) { return series_q30(x_q30, 2); }

bool speed_controller_init(speed_controller_t* s, const speed_controller_config_t* c, const machine_model_t* m) {
  const int32_t step_q30 = q_div(c->step_periods, m->periods_per_second, 30);  // Ts, s
  const int32_t x_q30 = qc_mul_sat(q_div(c->friction_q24, c->inertia_q24, 20), step_q30, 20);
  if (x_q30 >= ONE_Q30 / 2) return false;
  s->decay_q30 = exp_minus_q30(x_q30);
  // b: acceleration per N m (Q12 bpp per period) * Kt (Q24) * periods, to Q8 bpp per A.
  const int32_t accel_per_amp_q8 = qc_mul_sat(m->accel_q12, m->torque_q24, 28);
  s->response_q8 = qc_mul_sat(q_sat64((int64_t)accel_per_amp_q8 * c->step_periods), mean_decay_q30(x_q30), 30);
  s->gains.amps_per_bpp = q_div(16777216L, s->response_q8, 24);
  // A rotor so heavy, or so light, that the gains do not fit.
  if (s->gains.amps_per_bpp == INT32_MAX || accel_per_amp_q8 > INT32_MAX / c->step_periods) return false;
  // alpha b^2 with b in rad/s (mechanical) per A: b = Kt Ts / J.
  const int32_t b_q24 = qc_mul_sat(q_div(m->torque_q24, c->inertia_q24, 16), step_q30, 22);
  const int32_t weight_q16 = qc_mul_sat(qc_mul_sat(b_q24, b_q24, 24), c->alpha_q8, 16);
  s->gains.share_q30 = q_clamp(ONE_Q30 - q_div(65536L, qc_add_sat(weight_q16, 65536L), 30), 0, ONE_Q30);
  const int32_t ratio_q30 = q_div(c->step_periods * 1000L, qc_mul(m->periods_per_second, c->trajectory_ms_q8, 8), 30);
  s->approach_q30 = (ratio_q30 > ONE_Q30 / 2) ? ONE_Q30 : ONE_Q30 - exp_minus_q30(ratio_q30);
  // Pole assignment: Kp = 2 zeta wn J / Kt, Ki Ts = wn^2 Ts J / Kt, written with b = Kt Ts / J.
  const int32_t wn_ts_q24 = qc_mul_sat(c->pi_bandwidth_q8, step_q30, 14);
  s->gains.pi_kp = qc_mul_sat(s->gains.amps_per_bpp, qc_mul_sat(2 * c->pi_damping_q12, wn_ts_q24, 12), 24);
  s->gains.pi_ki = qc_mul_sat(s->gains.amps_per_bpp, qc_mul_sat(wn_ts_q24, wn_ts_q24, 24), 24);
  if (s->gains.pi_kp == INT32_MAX) return false;
  s->nominal = s->gains;
  speed_controller_preset(s, 0);
  return true;
}

// k b is w / (1 + w) with w = alpha b^2.
void speed_controller_scale(speed_controller_t* s, int32_t ratio_q24) {
  const q_inverse_t per_ratio = q_invert(ratio_q24);
  const int32_t rest_q24 = q_shr(ONE_Q30 - s->nominal.share_q30, 6);
  const int32_t weight_q24 = q_mul(q_mul(q_shr(s->nominal.share_q30, 6), ratio_q24, 24), ratio_q24, 24);
  s->gains.share_q30 = q_clamp(qc_over(weight_q24, q_invert(weight_q24 + rest_q24), 30), 0, ONE_Q30);
  s->gains.amps_per_bpp = qc_over(s->nominal.amps_per_bpp, per_ratio, 24);
  s->gains.pi_kp = qc_over(s->nominal.pi_kp, per_ratio, 24);
  s->gains.pi_ki = qc_over(s->nominal.pi_ki, per_ratio, 24);
}

void speed_controller_preset(speed_controller_t* s, int32_t current_q20) {
  s->current_q20 = current_q20;
  s->integral_q20 = current_q20;
}

// A per bpp (Q40) times bpp to A Q20.
static int32_t amps_q20(int32_t amps_per_bpp, int32_t speed_bpp) { return qc_mul_sat(amps_per_bpp, speed_bpp, 20); }

static int32_t predictive_step(speed_controller_t* s, const speed_controller_input_t* in) {
  const int32_t distance = qc_sub_sat(in->reference_bpp, in->speed_bpp);
  const int32_t target_change = qc_add_sat(in->reference_step_bpp, q_mul(distance, s->approach_q30, 30));
  const int32_t own_change = q_mul(in->speed_bpp, s->decay_q30 - ONE_Q30, 30);
  // (53): the current that would reach the target in one step, minus the one that flows, times k b.
  const int32_t deadbeat = amps_q20(s->gains.amps_per_bpp, qc_sub_sat(target_change, own_change));
  const int32_t own = q_mix_sat(s->current_q20, deadbeat, s->gains.share_q30, 30);
  const int32_t total = q_clamp(qc_add_sat(own, in->load_current_q20), in->lowest_q20, in->highest_q20);
  s->current_q20 = qc_sub_sat(total, in->load_current_q20);
  return total;
}

static int32_t pi_law_step(speed_controller_t* s, const speed_controller_input_t* in) {
  const int32_t error = qc_sub_sat(in->reference_bpp, in->speed_bpp);
  const int32_t proportional = amps_q20(s->gains.pi_kp, error);
  const int32_t integral = qc_add_sat(s->integral_q20, amps_q20(s->gains.pi_ki, error));
  const int32_t command_q20 = qc_add_sat(proportional, integral);
  const int32_t limited_q20 = q_clamp(command_q20, in->lowest_q20, in->highest_q20);
  // Hold the integrator while the limit is reached and the error would drive it further.
  if (limited_q20 == command_q20 || (command_q20 > limited_q20) != (error > 0)) s->integral_q20 = integral;
  return limited_q20;
}

int32_t speed_controller_step(speed_controller_t* s, speed_law_t law, const speed_controller_input_t* in) {
  return (law == SPEED_PI) ? pi_law_step(s, in) : predictive_step(s, in);
}
