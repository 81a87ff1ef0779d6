// Deviation observer: angle, speed and load from the whole deviation vector of every window it is given.
//
// The full-vector form of ZVV. Both axes of the residual of each window (deviation.h) are measurements of the angle and
// the speed at once; an extended Kalman filter with the load as third state weights them by what they tell. With zero
// vectors only it is what the paper's ZVV can become; given the active windows as well it has the angle information of
// AVV, and needs no choice between the two.
//
// Per period all windows are compressed into a 2 x 2 information matrix and a score, so that one update of the 3 x 3
// covariance and one division do for any number of windows: P+ = P (1 + I P)^-1, x+ = x + P+ b. The states are
// corrected in every period; the covariance, which changes slowly, need be renewed only every few periods, with the
// information gathered in between (estimator_input_t: renew). The observer says when it is due. While it is of the size
// that a period's information makes of it, it is renewed in every period, asked or not.
//
// How much the load may change is not known beforehand: a shaft that turns evenly wants a filter that is slow, a load
// step one that is fast. The scores tell: as long as the model is right they are white; a mean beyond five of its
// standard deviations is a load that changes.
//
// Units: angle 2^-6 rad, speed 2^-12 rad per period, acceleration 2^-18 rad per period^2 (that is: time in units of 64
// periods), which keep every covariance between 0.01 and 1000: Q20. Information is Q24, scores Q20.

#ifndef STILLSPIN_ESTIMATORS_DEVIATION_OBSERVER_H
#define STILLSPIN_ESTIMATORS_DEVIATION_OBSERVER_H

#include "estimators/cogging.h"
#include "estimators/regression.h"

typedef struct {
  int32_t noise_q20;            // rms error of a change in a third of a period, A, 0.001 (also for less) to 1
  int32_t load_rate_q20;        // load change expected in 10 ms, N m
  int32_t load_rate_quiet_q20;  // the same at a crawl, while nothing shows that the load changes, cogging unknown
  int32_t load_step_q20;        // step of the load to look out for at a crawl, N m
  int32_t crawl_bpp;            // electrical speed up to which it is a crawl, 1 (also for less) to INT32_MAX / 4
  bool steps_at_speed;          // look out for twice the step above it: needs the map of the saturation
} deviation_observer_tuning_t;

typedef struct {
  int32_t weight_q8;             // 1 / variance of the current's change in a period, A^-2, 1/3..3.3e5
  int32_t limit_q19;             // A: what is left of a window counts as its share of this at most
  int32_t load_noise_q20;        // variance that the load gains per period, own units
  int32_t load_noise_quiet_q20;  // the same at a crawl, while nothing shows that it changes
  int32_t load_step_q20;         // variance of a step of the load, at a crawl
  int32_t moving_step_q20;       // from three times its speed on; 0 looks out for none
  q_inverse_t per_crawl;         // of twice cogging.crawl_bpp
  cogging_config_t cogging;
  bool zero_vectors_only;
} deviation_observer_config_t;

/// What the observer has left unexplained since somebody last took it (deviation_take_mean_residual), of the windows
/// that it is given, of each within its limit.
typedef struct {
  int32_t d_q17, q_q17;  // sum of what is left of the current's changes, A
  int32_t span_ticks;    // of the windows
  int32_t periods;
} deviation_residual_t;

typedef struct {
  int64_t as_q24;
  int32_t aa_q21, ss_q21;
  int32_t periods;
} deviation_gathered_t;

typedef struct {
  uint32_t angle_bam;
  int32_t speed_bpp;  // within 1.9 rad per period
  int32_t load_accel_q8;
  int32_t speed_remainder_q8;
  int32_t p_aa, p_as, p_al, p_ss, p_sl, p_ll;  // covariance of angle, speed, (minus) load acceleration, Q20
  int32_t mean_score_q20;                      // of the angle, over 32 periods
  int32_t score_power_q23;                     // over 256 periods
  uint32_t score_remainder;                    // what its shift by 8 has left, 0..255
  int32_t noise_boost_q30;                     // 1 when the load has just changed, decays
  bool load_is_new;                            // it has changed within the last 11 ms, or
  bool load_step_suspected;                    // the scores have said that it may be, and nothing was done about it yet
  cogging_t cogging;
  deviation_gathered_t gathered;  // information since the covariance was last renewed
  deviation_residual_t residual;
  deviation_sensitivity_t sensitivity;  // as last refreshed
  bool is_sensitive;
  regression_t regression;  // of the last step that was to make one
  uint32_t regressed_bam;   // and the angle that it was made at
} deviation_observer_t;

/// Makes the configuration; values outside their ranges are taken to the nearest end.
void deviation_observer_design(deviation_observer_config_t* c, const machine_model_t* m,
                               const deviation_observer_tuning_t* t);

/// Starts with an uncertainty of 10 degrees, 20 rad/s and 3 N m or so.
void deviation_observer_preset(deviation_observer_t* s, uint32_t angle_bam, int32_t speed_bpp, int32_t load_accel_q8);

/// Says that the shaft has stood until now, and that a load may fall on it: what is seen of the speed from here on is
/// the load's doing, and not taken for one that it had before.
void deviation_observer_stands(deviation_observer_t* s);

/// True when the covariance should be renewed in one of the next periods, be it urgent or not.
bool deviation_observer_is_due(const deviation_observer_t* s);

#define DEVIATION_KNOWN_VARIANCE 33554432L  // 5 degrees
#define DEVIATION_DUE_Q9 128L

/// Whether the angle is known to 5 degrees.
static inline bool deviation_observer_is_sure(const deviation_observer_t* s) {
  return s->p_aa <= DEVIATION_KNOWN_VARIANCE;
}

/// What has been gathered, of what was known: trace of P I.
static inline int32_t deviation_observer_learnt_q9(const deviation_observer_t* s) {
  return q_mul_hi(s->p_aa, s->gathered.aa_q21) + q_mul_hi(s->p_ss, s->gathered.ss_q21);
}

/// True when the next windows may well make it renew the covariance, asked or not; so while it is not sure.
static inline bool deviation_observer_update_is_urgent(const deviation_observer_t* s) {
  return !deviation_observer_is_sure(s) || deviation_observer_learnt_q9(s) > DEVIATION_DUE_Q9;
}

/// Mean residual by spans, A per period Q20, and mean span of a period since the last call; false where there were
/// none.
bool deviation_take_mean_residual(deviation_residual_t* left, dq_t* residual_q20, int32_t* span_ticks,
                                  int32_t* periods);

estimator_output_t deviation_observer_step(deviation_observer_t* s, const deviation_observer_config_t* c,
                                           const estimator_input_t* in);

/// Once a millisecond, where the shaft turns: learns what of the load repeats with the angle, where the angle is known.
void deviation_observer_learn(deviation_observer_t* s, const deviation_observer_config_t* c);

#endif
