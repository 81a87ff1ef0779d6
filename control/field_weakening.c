#include "control/field_weakening.h"

#include "hal/qmath/qcall.h"

#define RELEASE_SHIFT 6u  // the whole limit in 64 steps

void field_weakening_reset(field_weakening_t* s) {
  s->trim_q20 = 0;
  s->id_q20 = 0;
}

// Flux that the voltage limit allows at this speed, V s Q28; saturates at low speed.
static int32_t flux_limit_q28(const field_weakening_input_t* in, const machine_model_t* m) {
  const int32_t w_q30 = qc_abs_sat(machine_speed_rad_q30(in->speed_bpp));
  const int32_t volts_per_flux_q16 = qc_mul_sat(w_q30, m->periods_per_second, 14);  // w/T as Q16 rad/s
  return qc_over(in->voltage_limit_q16, q_invert(volts_per_flux_q16), 28);
}

// (V/w)^2 - (Lq iq)^2, (V s)^2.
static int64_t room_for_axis_q56(const field_weakening_input_t* in, const machine_model_t* m) {
  const int32_t limit = flux_limit_q28(in, m);
  const int32_t cross = qc_mul_sat(m->lq_q30, in->iq_q20, 22);
  return (int64_t)limit * limit - (int64_t)cross * cross;
}

// At most 0: where there is room for the whole flux no root is taken.
static int32_t feed_forward_q20(int64_t room_q56, const machine_model_t* m) {
  const int32_t flux_q28 = m->flux_q28 + qc_mul(m->trim.psi_q16, m->period_q30, 18);
  if (room_q56 >= q_product(flux_q28, flux_q28)) return 0;
  const int32_t axis = (room_q56 > 0) ? (int32_t)q_sqrt64((uint64_t)room_q56) : 0;
  return qc_over(qc_sub_sat(axis, flux_q28), m->per_ld, 22);
}

void field_weakening_step(field_weakening_t* s, const field_weakening_input_t* in, const machine_model_t* m) {
  const int32_t limit = in->current_limit_q20;
  const int32_t forward = q_clamp(feed_forward_q20(room_for_axis_q56(in, m), m), -limit, 0);
  const int32_t released = s->id_q20 + q_shr(limit, RELEASE_SHIFT);
  // While the current still goes, the voltage that is left says nothing about the feed-forward: the trim waits.
  if (q_min(forward + s->trim_q20, 0) > released) {
    s->id_q20 = released;
    return;
  }
  const int32_t left = in->voltage_limit_q16 - in->voltage_q16;
  const int32_t trim = qc_add_sat(qc_mul_sat(left, in->trim_gain_q20, 16), s->trim_q20);
  // The trim may take back no more than the feed-forward gives, and add no more than the limit leaves.
  s->trim_q20 = q_clamp(trim, -limit, -forward);
  s->id_q20 = q_clamp(forward + s->trim_q20, -limit, 0);
}
