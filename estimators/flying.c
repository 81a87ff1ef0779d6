#include "estimators/flying.h"

#include "hal/qmath/qcall.h"

#define SIXTY_DEGREES_BAM 715827883L
#define FIFTEEN_DEGREES_BAM 178956971L
#define EMF_ERROR_Q16 65536L  // V: drops and noise

void flying_add(flying_pulse_t* s, const machine_model_t* m, const estimator_window_t* w, int32_t tick) {
  const ab_t way_q20 = w->change_q19;  // half of it lies between the middle of the window and its bursts
  if (s->windows == 0u) {
    s->first_tick = tick - w->span_ticks / 2;
    s->first_q20.alpha = w->current_q20.alpha - way_q20.alpha;
    s->first_q20.beta = w->current_q20.beta - way_q20.beta;
    s->drive_q16.alpha = 0;
    s->drive_q16.beta = 0;
  }
  s->last_tick = tick + w->span_ticks / 2;
  s->last_q20.alpha = w->current_q20.alpha + way_q20.alpha;
  s->last_q20.beta = w->current_q20.beta + way_q20.beta;
  const ab_t driving_q16 = {q_shr(w->voltage_q19.alpha, 3) - qc_mul(m->rs_q24, w->current_q20.alpha, 28),
                            q_shr(w->voltage_q19.beta, 3) - qc_mul(m->rs_q24, w->current_q20.beta, 28)};
  s->drive_q16.alpha = qc_add_sat(s->drive_q16.alpha, driving_q16.alpha);
  s->drive_q16.beta = qc_add_sat(s->drive_q16.beta, driving_q16.beta);
  s->windows++;
}

int32_t flying_current(const flying_pulse_t* s) {
  if (s->windows == 0u) return 0;
  return frame_largest(s->last_q20.alpha, s->last_q20.beta);
}

// e = (v - R i) - di / (y_q dt), V Q16.
static int32_t component(int32_t drive_q16, int32_t windows, int32_t change_q20, int32_t yq_q30, int32_t rate_q20) {
  return qc_sub_sat(drive_q16 / windows, qc_mul_sat(q_div(change_q20, yq_q30, 26), rate_q20, 20));
}

flying_emf_t flying_evaluate(const flying_pulse_t* s, const machine_model_t* m) {
  const int32_t rate_q20 = q_div(ESTIMATOR_PERIOD_TICKS, s->last_tick - s->first_tick, 20);
  const int32_t count = q_max((int32_t)s->windows, 1);
  const int32_t alpha =
      component(s->drive_q16.alpha, count, s->last_q20.alpha - s->first_q20.alpha, m->yq_q30, rate_q20);
  const int32_t beta = component(s->drive_q16.beta, count, s->last_q20.beta - s->first_q20.beta, m->yq_q30, rate_q20);
  const int32_t middle_q20 =
      q_hypot(s->first_q20.alpha / 2 + s->last_q20.alpha / 2, s->first_q20.beta / 2 + s->last_q20.beta / 2);
  const int32_t size_q20 = qc_mul_sat(m->yq_q30, m->emf_q16, 26);  // of the slope, A per rad
  const int32_t lag_q24 = qc_mul_sat(q_div(middle_q20, size_q20, 24), m->k_dq_q24, 24);
  const flying_emf_t e = {q_atan2(beta, alpha), q_hypot(alpha, beta), s->first_tick / 2 + s->last_tick / 2,
                          qc_mul_sat(lag_q24, ANGLE_BAM_PER_RAD, 24)};
  return e;
}

// Magnitude of the speed that makes this EMF, binary angle per period.
int32_t flying_speed(int32_t size_q16, const machine_model_t* m) {
  return qc_mul_sat(q_div(size_q16, m->emf_q16, 30), ANGLE_BAM_PER_RAD, 30);
}

int32_t flying_pause(const flying_emf_t* e, const machine_model_t* m, int32_t least, int32_t most) {
  return q_clamp(SIXTY_DEGREES_BAM / q_max(flying_speed(e->size_q16, m), 1), least, most);
}

bool flying_resolve(const flying_emf_t* first, const flying_emf_t* second, const machine_model_t* m,
                    flying_rotor_t* rotor) {
  const int32_t turn = angle_diff_bam(second->direction_bam, first->direction_bam);
  const int32_t elapsed = second->tick - first->tick;
  rotor->speed_bpp = q_limit(qc_mul_sat(turn, q_div(ESTIMATOR_PERIOD_TICKS, elapsed, 30), 30), MACHINE_SPEED_END_BPP);
  rotor->tick = second->tick;
  // e = w lambda q: a quarter turn ahead of the magnet for w > 0, behind it for w < 0.
  const uint32_t quarter = ANGLE_BAM_HALF_TURN / 2u;
  const uint32_t behind = quarter - (uint32_t)second->lag_bam;
  rotor->angle_bam = second->direction_bam + ((turn >= 0) ? 0u - behind : behind);
  const int32_t size = q_min(first->size_q16, second->size_q16);
  const int32_t error_bam = qc_mul_sat(q_div(EMF_ERROR_Q16, size, 16), ANGLE_BAM_PER_RAD, 16);
  rotor->sigma_q8 = q_div(qc_abs_sat(turn), q_max(error_bam, 1), 8);
  const int32_t expected = flying_speed(second->size_q16, m) / 2 + flying_speed(first->size_q16, m) / 2;
  const int32_t seen = qc_abs_sat(rotor->speed_bpp);
  return qc_abs_sat(turn) > FIFTEEN_DEGREES_BAM && seen > expected / 5 * 2 && seen / 5 * 2 < expected;
}
