// What is learnt of the machine and the sensors, in which turn, and how much of it.

#include "tests/firmware/position.hpp"

extern "C" {
#include "firmware/commissioning/commissioning.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

// What the sensors' mismatch, the inverse inductance's error and a voltage's leave in the observer's regression.
class Learning : public Sources {
 protected:
  void learn_with(std::int32_t source) {
    run_with(source);
    see(0);
    inside::model() = inside::config().nameplate;
    inside::sensor_trim().mismatch_q30 = 0;
    inside::is_near() = true;
    inside::modulator().is_alternating = true;
    inside::model().iq_q20 = raw(3.0, 20);
    regression_t r = {};
    r.spread_q8 = raw(30000.0, 8);
    r.along_q16 = raw(40.0, 16);
    r.curl_q16 = raw(20.0, 16);
    r.mean_q20 = {0, raw(0.01, 20)};
    r.information = 1000000;
    inside::observer().regression = r;
  }
  static bool inverse_inductances() { return inside::model().trim.mean_q30 != 0; }
  static bool sensors() { return inside::sensor_trim().mismatch_q30 != 0; }
  static bool voltage() { return inside::model().trim.rs_q24 != 0 || inside::model().trim.psi_q16 != 0; }
};

// Inverse inductances and sensors in one slot, resistance and flux in another: once it runs, and near enough.
TEST_F(Learning, ADriveThatRunsLearnsEachInItsTurn) {
  for (int slot = 0; slot <= SCHEDULE_SLOTS; ++slot) {
    if (slot == SLOT_REGRESSION || slot == SLOT_LOOK) continue;
    for (const bool near : {true, false}) {
      for (const bool alternating : {true, false}) {
        learn_with(POSITION_OBSERVER);
        inside::is_near() = near;
        inside::modulator().is_alternating = alternating;
        estimate(static_cast<schedule_slot_t>(slot));
        EXPECT_EQ(inverse_inductances(), near && slot == SLOT_INDUCTANCE) << slot;
        EXPECT_EQ(sensors(), near && slot == SLOT_INDUCTANCE && alternating) << slot << "all directions, or none";
        EXPECT_EQ(voltage(), near && slot == SLOT_VOLTAGE) << slot;
      }
    }
  }
}

// A period with three windows has no room for the polarity's watch beside it.
TEST_F(Learning, TheWatchTakesTheVoltagesTurnOfAFullPeriod) {
  for (const std::uint16_t count : {2, 3}) {
    for (const bool watched : {true, false}) {
      learn_with(POSITION_OBSERVER);
      see(count);
      polarity_watch.open = watched;
      estimate(SLOT_VOLTAGE);
      EXPECT_EQ(voltage(), !(watched && count == 3));
    }
  }
}

// A turn takes 5/4 as long as the places say, and twice that while the shaft turns, where half as much again is learnt.
TEST_F(Learning, SharesAreThoseOfTheParametersTimes) {
  learn_with(POSITION_OBSERVER);
  const double yd = real(inside::config().nameplate.map.points[0].ydd_q30, 30);  // in the place of the mean
  estimate(SLOT_INDUCTANCE);
  const double share = 1.5 * real(inside::config().adapt_share_q30, 30);
  EXPECT_NEAR(real(inside::model().trim.mean_q30, 30) / (share * 40.0 / 30000.0), 1.0, 1e-3);
  EXPECT_NEAR(real(inside::sensor_trim().mismatch_q30, 30) / (share * std::sqrt(3.0) * 20.0 / 30000.0 / yd), 1.0, 1e-3);
  learn_with(POSITION_OBSERVER);
  inside::selected().speed_bpp = inside::observer().speed_bpp = bpp(60.0);
  inside::model().trim.psi_variance_q32 = 0;
  machine_model_t model = inside::model();
  voltage_match_step(&model, &inside::observer().regression, raw(60.0 * kPeriod, 30),
                     raw(1.5 * real(inside::config().drift_share_q30, 30), 30));
  estimate(SLOT_VOLTAGE);
  EXPECT_NE(model.trim.rs_q24, 0);
  EXPECT_NEAR(inside::model().trim.rs_q24, model.trim.rs_q24, 2 + std::abs(model.trim.rs_q24) / 100);
  EXPECT_NEAR(inside::model().trim.psi_q16, model.trim.psi_q16, 2 + std::abs(model.trim.psi_q16) / 100);
}

// A start learns inverse inductances in their slot and the sensors in the voltage's, with 5/4 of the share.
TEST_F(Learning, AStartLearnsTheSensorsInTheVoltagesTurn) {
  for (const schedule_slot_t slot : {SLOT_INDUCTANCE, SLOT_VOLTAGE, SLOT_OPERATING_POINT}) {
    learn_with(POSITION_OBSERVER);
    see_machine(kHere);
    for (int k = 0; k < 2; ++k) {
      inside::windows()[k].change_q19.alpha += raw(k == 0 ? 0.06 : -0.06, 19);
      inside::windows()[k].change_q19.beta += raw(k == 0 ? 0.03 : -0.03, 19);
    }
    inside::be_in(DRIVE_START);
    inside::is_scheduled_turning() = false;
    estimate(slot);
    EXPECT_EQ(inverse_inductances(), slot == SLOT_INDUCTANCE) << slot;
    EXPECT_EQ(sensors(), slot == SLOT_VOLTAGE) << slot;
    EXPECT_FALSE(voltage());
    if (slot != SLOT_INDUCTANCE) continue;
    const regression_t& r = inside::avv().regression;
    const double wanted =
        1.25 * real(inside::config().adapt_share_q30, 30) * real(r.along_q16, 16) / real(r.spread_q8, 8);
    EXPECT_NEAR(real(inside::model().trim.mean_q30, 30) / wanted, 1.0, 1e-2);
  }
}

// A commissioning at standstill has AVV, which learns where it is told to, or the torque alone.
TEST_F(Learning, ACommissioningLearnsWhereItAdapts) {
  NEEDS("commissioning", "sources/flux");
  for (const bool adapting : {true, false}) {
    for (const bool predicting : {true, false}) {
      learn_with(POSITION_FLUX_CONV);
      see_machine(kHere);
      inside::windows()[0].change_q19.alpha += raw(0.06, 19);
      inside::be_in(DRIVE_COMMISSION);
      inside::is_scheduled_turning() = false;
      inside::is_frozen() = !adapting;
      commissioning.predicting = predicting;
      inside::avv().observer = {kThere, 1000, raw(500.0, 8), 0};
      inside::current_dq_q20() = {0, 0};
      const std::int32_t error = inside::avv_error_bam() = 4711;
      estimate(SLOT_INDUCTANCE);
      EXPECT_EQ(inverse_inductances(), adapting && !predicting);
      EXPECT_EQ(inside::avv_error_bam() == error, predicting) << "no measurement at all";
      EXPECT_EQ(inside::selected().angle_bam, inside::avv_angle_bam());
      if (!predicting) continue;
      EXPECT_EQ(inside::selected().angle_bam, kThere + 1000u);
      EXPECT_EQ(inside::selected().speed_bpp, 1000) << "the load as of now is left out";
      EXPECT_EQ(inside::selected().load_accel_q8, raw(500.0, 8));
      EXPECT_EQ(inside::selected().quality_q15, 32767);
    }
  }
}

}  // namespace
