// What opens the power stage while the drive runs, each cause alone, and what must not: the conditions that
// faults_test.cpp meets only together.

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/states.h"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/sources/encoder/encoder.h"
}

namespace {

using namespace stillspin::test;

hal_adc_window_t window_with(double a, double b) {
  const auto codes = [](double amps) { return 2048.0 + amps / 20.0 * 2048.0; };
  hal_adc_window_t w = still_window();
  w.start_a = static_cast<std::uint16_t>(4 * codes(a));
  w.end_a = static_cast<std::uint16_t>(3 * codes(a));
  w.start_b = static_cast<std::uint16_t>(4 * codes(b));
  w.end_b = static_cast<std::uint16_t>(3 * codes(b));
  return w;
}

class Protection : public Drive {
 protected:
  /// Periods until the drive leaves RUN, at most `most`, with something held in each.
  template <typename Hold>
  int while_running(int most, Hold hold) {
    int n = 0;
    for (; n < most && inside::state() == DRIVE_RUN; ++n) {
      hold();
      period();
    }
    return n;
  }
  /// These windows are no machine's.
  static void trust_synchronism() { inside::config().synchronism.bad_periods = 1000000; }
  static void hold_avv_apart() { inside::avv_angle_bam() = encoder.observer.angle_bam + 0x31C71C72u; }
};

TEST_F(Protection, EachPhaseTripsInEitherDirection) {
  for (const auto& [a, b] :
       {std::pair{18.5, -9.0}, {-18.5, 9.0}, {-9.0, 18.5}, {9.0, -18.5}, {9.4, 9.4}, {-9.4, -9.4}}) {
    SetUp();
    make_run();
    period(window_with(a * 0.95, b * 0.95));
    EXPECT_EQ(inside::state(), DRIVE_RUN) << a;
    period(window_with(a, b));
    EXPECT_EQ(inside::fault(), FAULT_CURRENT_LIMIT) << a << " " << b;
    EXPECT_FALSE(board.gates_on);
  }
}

TEST_F(Protection, GatesThatGoOffByThemselvesAreNamedByTheirCause) {
  for (const bool pressed : {false, true}) {
    SetUp();
    make_run();
    parameters.emergency_stop = 1;
    use_parameters();
    board.emergency = pressed;
    board.gates_on = false;  // the hardware, not the comparator
    period();
    EXPECT_EQ(inside::state(), DRIVE_FAULT);
    EXPECT_EQ(inside::fault(), pressed ? FAULT_EMERGENCY : FAULT_GATES_OFF);
  }
}

TEST_F(Protection, ASpeedFarBeyondTheLimitIsDivergence) {
  for (const double share : {1.45, 1.55}) {
    SetUp();
    make_run();
    trust_synchronism();
    use_source(POSITION_AVV);
    const auto speed = static_cast<std::int32_t>(bpp_of(3300) * share);
    const int allowed = parameters.divergence_time * DRIVE_PERIODS_PER_MS;
    const int n = while_running(2 * allowed, [&] {
      inside::avv_speed_bpp() = speed;
      inside::selected().speed_bpp = speed;
    });
    EXPECT_EQ(inside::state(), share > 1.5 ? DRIVE_FAULT : DRIVE_RUN);
    if (share > 1.5) {
      EXPECT_EQ(inside::fault(), FAULT_DIVERGENCE);
      EXPECT_NEAR(n, allowed, 5);
    }
  }
}

// Beside the encoder AVV is a second opinion only where it has active windows and nothing else stands in its place.
TEST_F(Protection, WhatIsBesideTheEncoderCountsWhereItIsOne) {
  const struct {
    std::int32_t parameters_t::* parameter;
    std::int32_t value;
    bool counts;
  } cases[] = {{&parameters_t::excitation, 2, true},  {&parameters_t::excitation, 0, false},
               {&parameters_t::excitation, 4, false}, {&parameters_t::excitation, 5, false},
               {&parameters_t::excitation, 1, true},  {&parameters_t::flux_beside, 1, false}};
  for (const auto& c : cases) {
    SetUp();
    make_run();
    trust_synchronism();
    parameters.*c.parameter = c.value;
    use_parameters();
    const int allowed = parameters.divergence_time * DRIVE_PERIODS_PER_MS;
    (void)while_running(3 * allowed, [&] {
      hold_avv_apart();
      if (c.parameter == &parameters_t::flux_beside) inside::high_speed_estimate().quality_q15 = 32767;
    });
    EXPECT_EQ(inside::state(), c.counts ? DRIVE_FAULT : DRIVE_RUN) << c.value;
    if (c.counts) {
      EXPECT_EQ(inside::fault(), FAULT_DIVERGENCE);
    }
  }
}

// Two sources that take turns must agree where both are in use; the observer and AVV beside it everywhere; a source
// that is alone has nobody to agree with.
TEST_F(Protection, SourcesMustAgreeWhereBothAreInUse) {
  const struct {
    std::int32_t source;
    blend_region_t region;
    bool counts;
  } cases[] = {{POSITION_PAPER, BLEND_BOTH, true},        {POSITION_PAPER, BLEND_LOW, false},
               {POSITION_PAPER, BLEND_HIGH, false},       {POSITION_FLUX_CONV, BLEND_BOTH, true},
               {POSITION_FLUX_CONV, BLEND_HIGH, false},   {POSITION_OBSERVER_AVV, BLEND_LOW, true},
               {POSITION_OBSERVER_AVV, BLEND_HIGH, true}, {POSITION_AVV, BLEND_BOTH, false}};
  for (const auto& c : cases) {
    if (!has_source(c.source)) continue;
    SetUp();
    make_run();
    trust_synchronism();
    use_source(c.source);
    inside::diverged_periods() = static_cast<std::uint16_t>(parameters.divergence_time * DRIVE_PERIODS_PER_MS);
    inside::judges_synchronism() = true;
    inside::modulator().is_alternating = true;
    inside::blend_region() = c.region;
    inside::low_speed_estimate().quality_q15 = inside::high_speed_estimate().quality_q15 = 32767;
    inside::high_speed_estimate().angle_bam = inside::low_speed_estimate().angle_bam + bam(1.2);
    inside::protect_step();
    EXPECT_EQ(inside::fault(), c.counts ? FAULT_DIVERGENCE : FAULT_NONE) << c.source << " " << c.region;
  }
}

// In degrees, of the electrical turn.
TEST_F(Protection, TheLimitOfADisagreementIsInDegrees) {
  for (const double part : {0.98, 1.02, -0.98, -1.02}) {
    SetUp();
    make_run();
    trust_synchronism();
    parameters.divergence_limit = raw(50.0, 16);
    use_parameters();
    inside::diverged_periods() = static_cast<std::uint16_t>(parameters.divergence_time * DRIVE_PERIODS_PER_MS);
    inside::judges_synchronism() = true;
    inside::low_speed_estimate().quality_q15 = inside::high_speed_estimate().quality_q15 = 32767;
    inside::high_speed_estimate().angle_bam = inside::low_speed_estimate().angle_bam + bam(part * 50.0 * kDegree);
    inside::protect_step();
    EXPECT_EQ(inside::fault(), std::fabs(part) > 1.0 ? FAULT_DIVERGENCE : FAULT_NONE) << part;
  }
}

// A disagreement counts from divergence_limit on, and where it ends the time begins anew.
TEST_F(Protection, DivergenceIsAsLargeAndAsLongAsTheParametersSay) {
  const auto apart = [](double degrees) {
    inside::avv_angle_bam() = inside::high_speed_estimate().angle_bam =
        encoder.observer.angle_bam + static_cast<std::uint32_t>(std::ldexp(degrees / 360.0, 32));
  };
  make_run();
  trust_synchronism();
  const int allowed = parameters.divergence_time * DRIVE_PERIODS_PER_MS;
  (void)while_running(3 * allowed, [&] { apart(40.0); });  // AVV is pulled back a little before it is looked at
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  for (int n = 0; n < 3; ++n) {
    (void)while_running(allowed - 12, [&] { apart(70.0); });
    ASSERT_EQ(inside::state(), DRIVE_RUN);
    (void)while_running(12, [&] { apart(0.0); });
  }
  EXPECT_EQ(inside::diverged_periods(), 0);
  (void)while_running(3 * allowed, [&] { apart(70.0); });
  EXPECT_EQ(inside::fault(), FAULT_DIVERGENCE);
}

// An estimator that says itself that it knows nothing disagrees with nobody.
TEST_F(Protection, AnEstimatorWithoutAnAngleIsNoSecondOpinion) {
  for (const auto& [low, high] : {std::pair{32767, 32767}, {0, 32767}, {32767, 0}}) {
    SetUp();
    make_run();
    trust_synchronism();
    inside::diverged_periods() = static_cast<std::uint16_t>(parameters.divergence_time * DRIVE_PERIODS_PER_MS);
    inside::judges_synchronism() = true;
    inside::low_speed_estimate().quality_q15 = low;
    inside::high_speed_estimate().quality_q15 = high;
    inside::high_speed_estimate().angle_bam = inside::low_speed_estimate().angle_bam + ANGLE_BAM_HALF_TURN;
    inside::protect_step();
    EXPECT_EQ(inside::fault(), (low != 0 && high != 0) ? FAULT_DIVERGENCE : FAULT_NONE) << low << " " << high;
  }
}

// What the observer's windows left over is judged once; with no windows since there is nothing to judge.
TEST_F(Protection, ResidualsAreJudgedOnce) {
  make_run();
  use_source(POSITION_OBSERVER);
  inside::judges_synchronism() = true;
  inside::config().synchronism.bad_periods = 0;
  inside::config().synchronism.floor_q16 = raw(0.5, 16);
  inside::config().synchronism.share_q15 = 0;
  inside::protect_step();
  EXPECT_EQ(inside::state(), DRIVE_RUN) << "nothing was seen yet";
  estimator_window_t w = inside::windows()[0];
  w.change_q19 = raw_change({5.0, 5.0}, w.span_ticks);  // no machine of this model does that
  const estimator_input_t in = {&inside::model(), &w, 1, 0, false, false, false, false, nullptr, 0};
  for (int n = 0; n < 4; ++n) (void)deviation_observer_step(&inside::observer(), &inside::config().observer, &in);
  inside::protect_step();
  EXPECT_EQ(inside::fault(), FAULT_SYNCHRONISM);
}

// Beside the flux it is the observer's residuals that are judged, in their turns; alone the flux is judged by windows.
TEST_F(Protection, TheObserverBesideTheFluxIsJudgedByItsResiduals) {
  NEEDS("sources/flux");
  for (const bool alone : {false, true}) {
    for (const bool asked : {false, true}) {
      SetUp();
      make_run();
      trust_synchronism();
      use_source(POSITION_FLUX_CONV);
      inside::blend_region() = alone ? BLEND_HIGH : BLEND_BOTH;
      inside::blend_share_q15() = alone ? 0 : 16384;
      polarity_watch.open = false;
      inside::judges_synchronism() = asked;
      inside::modulator().is_alternating = true;
      inside::observer().residual = {0, 0, 3000, 1};
      inside::judged_at() = static_cast<std::uint16_t>(inside::heartbeat() - 1u);
      inside::protect_step();
      EXPECT_EQ(inside::observer().residual.span_ticks, (!alone && asked) ? 0 : 3000) << alone << asked;
      EXPECT_EQ(inside::judged_at() == inside::heartbeat(), alone || asked) << alone << asked;
    }
  }
}

// What the paper's AVV has made of a period's windows is what is judged, and the windows where it has seen nothing.
TEST_F(Protection, ThePapersAvvIsJudgedByItsRegression) {
  NEEDS("sources/paper");
  for (const bool seen : {true, false}) {
    SetUp();
    make_run();
    use_source(POSITION_PAPER);
    inside::config().synchronism.bad_periods = 0;
    inside::config().synchronism.floor_q16 = raw(0.5, 16);
    inside::config().synchronism.share_q15 = 0;
    inside::judges_synchronism() = true;
    synchronism_reset(&inside::synchronism());
    inside::window_count() = 1;
    inside::windows()[0] = {{0, 0}, {0, 0}, {0, 0}, 5000, 5000, true};
    inside::selected().speed_bpp = 0;
    inside::avv().regression = {};
    inside::avv().regression.mean_q20 = {raw(5.0, 20), raw(5.0, 20)};  // no machine of this model does that
    inside::avv_information() = seen ? 1000 : 0;
    for (int n = 0; n < 8; ++n) {
      inside::heartbeat()++;
      inside::protect_step();
    }
    EXPECT_EQ(inside::fault(), seen ? FAULT_SYNCHRONISM : FAULT_NONE);
  }
}

// What the frame in use has turned beside its speed since it was last judged, for each period; unknown when that is
// longer ago than six.
TEST_F(Protection, TheFramesOwnSpeedIsWhatItHasTurned) {
  for (const int since : {1, 5, 6, 7}) {
    for (const int ahead : {40, -40}) {
      SetUp();
      make_run();
      trust_synchronism();
      use_source(POSITION_OBSERVER);
      inside::selected().speed_bpp = bpp_of(300);
      inside::judged_bam() = inside::selected().angle_bam = 0xFFFFF000u;  // and on past the turn's end
      inside::judged_at() = inside::heartbeat() = 65533u;                 // and the counter's
      const estimator_window_t still = {{0, 0}, {0, 0}, {0, 0}, 5000, 5000, true};
      const estimator_input_t in = {&inside::model(), &still, 1, 0, false, false, false, false, nullptr, 0};
      (void)deviation_observer_step(&inside::observer(), &inside::config().observer, &in);
      synchronism_reset(&inside::synchronism());
      inside::heartbeat() = static_cast<std::uint16_t>(inside::heartbeat() + static_cast<unsigned>(since));
      inside::selected().angle_bam += static_cast<std::uint32_t>(since * bpp_of(300 + ahead));
      inside::judges_synchronism() = true;
      inside::protect_step();
      const synchronism_t& s = inside::synchronism();
      const double emf = real(inside::model().emf_q16, 16) * std::ldexp(bpp_of(ahead), -32) * kTurn;
      EXPECT_NEAR(real(s.turned_q16 - s.error_q16.q, 16), since <= 6 ? 0.25 * emf : 0.0, 0.01) << since;
      EXPECT_EQ(inside::judged_bam(), inside::selected().angle_bam);
    }
  }
}

// A back-EMF of the wrong sign at speed, as the watch itself sees it; of the right sign it ends the watch.
TEST_F(Protection, AReversedBackEmfIsThePolarity) {
  for (const bool reversed : {false, true}) {
    SetUp();
    make_run();
    trust_synchronism();
    const std::int32_t speed = bpp_of(600);  // 40 V
    polarity_watch.open = true;
    polarity_watch.samples_invalid = false;
    inside::window_count() = ESTIMATOR_WINDOWS;
    inside::selected().speed_bpp = polarity_watch.axis.speed_bpp = speed;
    polarity_watch.axis.angle_bam = inside::selected().angle_bam;
    inside::current_dq_q20() = {0, 0};
    inside::command_dq_q16() = {0, raw(reversed ? -40.0 : 40.0, 16)};
    int n = 0;
    for (; n < 400 && polarity_watch.open && inside::state() == DRIVE_RUN; ++n) {
      inside::scheduled_slot() =
          n % 5 == 0 ? SLOT_VOLTAGE : SCHEDULE_SLOTS;  // the back-EMF's place in the round, and none
      inside::selected().angle_bam += static_cast<std::uint32_t>(speed);
      inside::protect_step();
    }
    EXPECT_GT(n, 50);
    EXPECT_EQ(inside::fault(), reversed ? FAULT_POLARITY : FAULT_NONE);
    EXPECT_EQ(inside::state(), reversed ? DRIVE_FAULT : DRIVE_RUN);
    EXPECT_FALSE(polarity_watch.open);
  }
}

// An angle error that is asked for is no loss of synchronism.
TEST_F(Protection, AnEncoderThatIsTrimmedIsNotJudged) {
  for (const bool trimmed : {false, true}) {
    SetUp();
    make_run();
    parameters.encoder_trim = trimmed ? raw(30.0, 16) : 0;
    use_parameters();
    (void)while_running(400, [] {
      board.encoder = (board.encoder + 4u) & 4095u;
      inside::avv_angle_bam() = encoder.observer.angle_bam;
    });
    EXPECT_EQ(inside::state(), trimmed ? DRIVE_RUN : DRIVE_FAULT);
  }
}

// The loss of synchronism of a magnet that looked reversed until then is a wrong polarity.
TEST_F(Protection, ALossWithAReversedEmfIsThePolarity) {
  for (const bool open : {false, true}) {
    SetUp();
    make_run();
    (void)while_running(400, [&] {
      board.encoder = (board.encoder + 4u) & 4095u;
      inside::avv_angle_bam() = encoder.observer.angle_bam;
      polarity_watch.open = open;
      polarity_watch.samples_invalid = true;  // it has no say of its own for now
      polarity_watch.sign.expected_q16 = raw(8.0, 16);
      polarity_watch.sign.seen_q16 = raw(-3.0, 16);
    });
    EXPECT_EQ(inside::fault(), open ? FAULT_POLARITY : FAULT_SYNCHRONISM);
  }
}

TEST_F(Protection, EveryFaultOpensTheGatesBeforeAnythingElse) {
  for (int fault = FAULT_NONE + 1; fault <= FAULT_SELF_TEST; ++fault) {
    SetUp();
    make_run();
    ASSERT_TRUE(board.gates_on);
    drive_trip(&drive, static_cast<drive_fault_t>(fault));
    EXPECT_FALSE(board.gates_on) << fault;
    EXPECT_FALSE(board.lit_with_gates_on) << fault;
    EXPECT_TRUE(board.lamp) << fault;
    periods(100);
    EXPECT_EQ(inside::fault(), fault) << "latched";
    EXPECT_FALSE(board.gates_on) << fault;
  }
}

TEST_F(Protection, TheFaultRecordSaysWhatWas) {
  make_run();
  inside::current_dq_q20() = {raw(1.5, 20), raw(-2.5, 20)};
  inside::time_ms() = 12345;
  drive_trip(&drive, FAULT_LINK_LOW);
  drive_trip(&drive, FAULT_OVERRUN);  // the first stays
  EXPECT_EQ(inside::fault(), FAULT_LINK_LOW);
  EXPECT_EQ(inside::periods(), 0u);
  EXPECT_EQ(inside::target_bpp(), 0);
  EXPECT_FALSE(inside::loop_is_closed());
}

// The history counts as far as it can and goes on keeping the last.
TEST_F(Protection, TheHistorysCountEndsAtItsEnd) {
  fault_history_reset();
  fault_record_t r = {};
  for (std::uint32_t n = 0; n < 65600; ++n) {
    r.time_ms = n;
    fault_history_add(&r);
  }
  EXPECT_EQ(fault_history_total(), 65535);
  ASSERT_TRUE(fault_history_read(0, &r));
  EXPECT_EQ(r.time_ms, 65599u);
  ASSERT_TRUE(fault_history_read(15, &r));
  EXPECT_EQ(r.time_ms, 65584u);
}

}  // namespace
