// A drive in RUN with a position source and windows of the test's own.

#ifndef STILLSPIN_TESTS_FIRMWARE_POSITION_HPP
#define STILLSPIN_TESTS_FIRMWARE_POSITION_HPP

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/states.h"
}

namespace stillspin::test {

inline constexpr std::uint32_t kHere = 0x10000000u, kThere = 0x18000000u;  // 11 degrees apart

class Position : public Drive {
 protected:
  /// In RUN with this source, at rest at kHere.
  void run_with(std::int32_t source) {
    SetUp();
    make_ready();
    use_source(source);
    ASSERT_TRUE(drive_config_load(&inside::config()));
    inside::be_in(DRIVE_RUN);
    inside::is_scheduled_turning() = true;
    polarity_watch.open = false;
    inside::preset(kHere, 0);
    inside::current_dq_q20() = {0, 0};
    see(2);
  }
  /// So many windows, the first of them under a zero vector, of a machine at rest without current.
  static void see(std::uint16_t count) {
    inside::window_count() = count;
    inside::ripple_q16() = {0, 0};
    for (std::uint16_t k = 0; k < count; ++k) {
      estimator_window_t w = {};
      w.middle_tick = static_cast<std::int16_t>(2500 + 5000 * k);
      w.span_ticks = 3000;
      w.zero_vector = k == 0;
      inside::windows()[k] = w;
    }
  }
  /// Two windows of opposite voltages along phase a, as the model has a machine that stands at this angle.
  static void see_machine(std::uint32_t angle_bam) {
    see(2);
    const machine_model_t& m = inside::model();
    for (int k = 0; k < 2; ++k) {
      estimator_window_t& w = inside::windows()[k];
      const Vector v = {k == 0 ? 180.0 : -180.0, 0.0};
      const Vector own = v.turned(-rad(angle_bam));
      const Vector slope = {real(m.yd_q30, 30) * own.x, real(m.yq_q30, 30) * own.y};
      w.zero_vector = false;
      w.voltage_q19 = raw_ab(v, 19);
      w.change_q19 = raw_change(slope.turned(rad(angle_bam)), w.span_ticks);
    }
  }
  static void blend(blend_region_t region, double share_of_low) {
    inside::blend_region() = region;
    inside::blend_share_q15() = static_cast<std::int32_t>(share_of_low * 32767.0);
  }
};

/// What goes into an estimator and comes out of it.
class Sources : public Position {
 protected:
  /// In a period of this turn.
  static void estimate(schedule_slot_t turn = SCHEDULE_SLOTS) {
    inside::scheduled_slot() = turn;
    inside::estimate_step();
  }
  static dq_t measured() { return inside::current_dq_q20(); }
};

}  // namespace stillspin::test

#endif
