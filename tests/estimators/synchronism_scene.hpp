// A shaft that turns, and a frame that may not be its: what the tests of the loss of synchronism have in common.

#ifndef STILLSPIN_TESTS_ESTIMATORS_SYNCHRONISM_SCENE_HPP
#define STILLSPIN_TESTS_ESTIMATORS_SYNCHRONISM_SCENE_HPP

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/synchronism.h"
}

namespace stillspin::test::frames {

using namespace stillspin::test::seen;

inline constexpr double kFloor = 4.0;  // V
inline constexpr double kShare = 0.6;
inline constexpr int kBad = 50;  // periods
inline const Motor kMotor;

inline const synchronism_config_t kConfig = {raw(kFloor, 16), raw(kShare, 15), kBad};

/// The period's windows at this angle, judged.
inline bool step_with(synchronism_t* s, const Input& in, std::uint32_t angle, synchronism_seen_t seen,
                      std::int32_t apart = 0) {
  const estimator_input_t* const given = in.get();
  synchronism_look(&seen, given->model, given->windows, given->window_count, angle);
  return synchronism_judge(s, &kConfig, given->model, &seen, apart);
}

/// A shaft that turns, seen in a frame that turns with it, is ahead by `off` and believes in `believed` (rad/s).
struct Scene {
  machine_model_t model = model_of(kMotor);
  synchronism_t s{};
  double theta = 0.4;
  int period = 0;

  Scene() { synchronism_reset(&s); }

  bool step(double w, double off, double believed, Vector i_dq = {0.0, 3.0}, double apart = 0.0) {
    theta += w * kPeriod;
    const Input in(model, alternating(kMotor, period++, theta, w, i_dq.turned(theta)));
    const synchronism_seen_t now = {{0, 0}, 0, bpp(believed), bpp(w - believed), 1};
    return step_with(&s, in, bam(theta + off), now, static_cast<std::int32_t>(bam(apart)));
  }

  /// Periods until the loss, `most` when there is none.
  int until_lost(double w, double off, double believed, int most = 1000) {
    int n = 0;
    while (n < most && !step(w, off, believed)) ++n;
    return n;
  }

  Vector error() const { return {real(s.error_q16.d, 16), real(s.error_q16.q, 16)}; }
  double turned() const { return real(s.turned_q16, 16); }
};

// What an estimator hands over instead of the windows: residuals of a machine whose L/T is known, in a frame that
// turns as fast as is believed.
inline synchronism_seen_t seen_of(Vector emf, double believed, std::int32_t span, std::int32_t periods) {
  const Vector residual = {emf.x * kPeriod / kMotor.ld, emf.y * kPeriod / kMotor.lq};
  return {raw_dq(residual, 20), span, bpp(believed), 0, periods};
}

}  // namespace stillspin::test::frames

#endif
