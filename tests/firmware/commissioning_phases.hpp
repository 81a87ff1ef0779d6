// A drive in a commissioning, phase by phase: the shaft and the windows are the test's.

#ifndef STILLSPIN_TESTS_FIRMWARE_COMMISSIONING_PHASES_HPP
#define STILLSPIN_TESTS_FIRMWARE_COMMISSIONING_PHASES_HPP

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/phases.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/mode/states.h"
#include "firmware/start/phases.h"
}

namespace stillspin::test {

constexpr double kLink = 300.0;

class Phases : public Drive {
 protected:
  void SetUp() override {
    NEEDS("commissioning");
    Drive::SetUp();
    make_ready();
    inside::be_in(DRIVE_COMMISSION);
    inside::model() = inside::config().nameplate;
    commissioning.model = inside::model();
    inside::link_q16() = raw(kLink, 16);
    inside::selected() = {0, 0, 0, 32767};
    commissioning.map.most_q20 = parameters.current_limit;  // as it has placed its levels
    limit_ = real(parameters.current_limit, 20);
  }

  /// One period of a phase, as the sequence calls it.
  static bool step(bool (*phase)(drive_t*)) {
    inside::is_exclusive() = true;  // for whoever asks for it
    inside::scheduled_task() = (commissioning.tick % 10 == 5) ? TASK_FIELD : TASK_SLOT;
    const bool done = phase(&drive);
    commissioning.tick++;
    return done;
  }
  /// The period's windows, under opposite vectors along alpha; what they leave over is along d, A per period.
  static void windows(Vector current, double first, double second) {
    const machine_model_t& m = inside::model();
    inside::window_count() = 2;
    for (int k = 0; k < 2; ++k) {
      estimator_window_t& w = inside::windows()[k];
      const double volts = (k == 0 ? 1.0 : -1.0) * kLink * 2.0 / 3.0;
      const double left = k == 0 ? first : second;
      const double along = real(m.yd_q30, 30) * (volts - real(m.rs_q24, 24) * current.x) + left;
      const double across = -real(m.yq_q30, 30) * real(m.rs_q24, 24) * current.y;
      w = {raw_change({along, across}, 2500), raw_ab({volts, 0.0}, 19), raw_ab(current, 20), 0, 2500, false};
      w.middle_tick = static_cast<std::int16_t>(k == 0 ? 3100 : 7300);
    }
    deviation_frames(inside::windows(), 2, 0, 0, inside::frames());
    const sampling_config_t& c = inside::config().modulator.sampling;
    inside::sampled_pattern().windows[0] = svpwm_window_between(&c, 1500, 4500, 1);
    inside::sampled_pattern().windows[1] = svpwm_window_between(&c, 5500, 8500, 6);
  }
  /// Electrical acceleration per torque, rad/s^2 and N m.
  static double per_torque() { return real(inside::model().accel_q12, 12) * kTurn / 4294967296.0 / kPeriod / kPeriod; }
  static std::int32_t accel_q8(double rad_per_s2) { return raw(rad_per_s2 * kPeriod * kPeriod / kTurn, 40); }

  double limit_ = 0.0;
};

}  // namespace stillspin::test

#endif
