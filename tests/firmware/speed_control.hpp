// A drive in RUN whose speed task the test calls, period by period.

#ifndef STILLSPIN_TESTS_FIRMWARE_SPEED_CONTROL_HPP
#define STILLSPIN_TESTS_FIRMWARE_SPEED_CONTROL_HPP

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/states.h"
}

namespace stillspin::test {

inline constexpr double kLink = 300.0;

class SpeedTask : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    make_ready();
    inside::be_in(DRIVE_RUN);
    polarity_watch.open = false;
    inside::link_q16() = raw(kLink, 16);
    inside::current_limit_q20() = raw(10.0, 20);
    inside::reference_dq_q20() = {0, 0};
    inside::ramped_bpp() = inside::target_bpp() = 0;
    parameters.position_hold = 0;
    speed(0.0);
  }
  static void part(task_t task) {
    inside::scheduled_task() = task;
    inside::speed_step();
  }
  static void millisecond() {
    for (int k = 0; k < 10; ++k) {
      schedule_next(&drive, &inside::schedule());
      inside::speed_step();
    }
  }
  static void speed(double rad_per_s) { inside::selected() = {0, bpp(rad_per_s), 0, 32767}; }
  static double iq() { return real(inside::reference_dq_q20().q, 20); }
  static double id() { return real(inside::reference_dq_q20().d, 20); }
  static double torque_constant() { return real(machine_torque_constant_q24(&inside::model(), 0), 24); }
};

}  // namespace stillspin::test

#endif
