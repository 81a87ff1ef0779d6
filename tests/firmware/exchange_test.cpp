// The interrupts read the configuration that is exchanged as a whole, and never the table of parameters: what is set
// there, and what is refused, they do not see.

#include <cstring>
#include <tuple>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/api/actions.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/config/config.h"
#include "firmware/config/rules.h"
#include "firmware/hysteresis/hysteresis.h"
#include "firmware/mode/commands.h"
#include "firmware/sources/encoder/encoder.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/paper/paper.h"
#include "firmware/start/if_start/if_start.h"
}

namespace stillspin::test {
namespace {

constexpr std::uint16_t kPositionSource = 60, kLinkRegulation = 164;  // numbers of parameters

class Exchange : public Drive {
 protected:
  // Every parameter at an end of its range, and not where it was.
  static void spoil_table() {
    for (std::uint16_t k = 0; k < parameter_count(); ++k) {
      const parameter_info_t* const p = parameter_info(k);
      std::int32_t& value = *parameter_in_use(p);
      value = (value == parameter_maximum(p)) ? parameter_minimum(p) : parameter_maximum(p);
    }
  }

  // The link rises until it is braked with less, and falls in the end.
  static hal_adc_window_t window(int n) {
    hal_adc_window_t w = still_window(n < 250 ? 300.0 + n / 2.0 : 150.0);
    w.start_a = static_cast<std::uint16_t>(w.start_a + n % 40);
    return w;
  }

  using Seen = std::tuple<drive_state_t, drive_fault_t, std::int32_t, std::int32_t, std::int32_t, std::uint32_t,
                          std::int32_t, std::int32_t, std::vector<std::uint16_t>, std::uint16_t>;
  static Seen seen() {
    std::vector<std::uint16_t> edges(std::begin(board.frame.edge_tick), std::end(board.frame.edge_tick));
    edges.insert(edges.end(), board.frame.burst_start_tick, board.frame.burst_start_tick + 3);
    const drive_control_t& c = inside::control();
    const dq_t& wanted = inside::reference_dq_q20();
    return {inside::state(),
            inside::fault(),
            inside::all_limits(),
            wanted.d,
            wanted.q,
            inside::selected().angle_bam,
            c.command_q16.d,
            c.braking_headroom_q20,
            edges,
            board.legs};
  }

  // What the interrupts do in 300 periods, with a table that stays, or that is spoilt before each of them.
  template <typename Begin>
  std::vector<Seen> course(Begin begin, bool spoils) {
    SetUp();
    begin();
    std::vector<Seen> all;
    for (int n = 0; n < 300; ++n) {
      if (spoils) spoil_table();
      if (inside::sliced() != 0u) {
        for (int k = 0; k < 20; ++k) drive_window_interrupt();
      }
      period(window(n), inside::sliced() != 0u ? inside::sampled_pattern().window_count : 0);
      all.push_back(seen());
    }
    return all;
  }

  template <typename Begin>
  void expect_no_difference(Begin begin, drive_state_t state) {
    const std::vector<Seen> usual = course(begin, false), spoilt = course(begin, true);
    EXPECT_EQ(std::get<0>(usual.front()), state);
    for (std::size_t n = 0; n < usual.size(); ++n) ASSERT_EQ(usual[n], spoilt[n]) << n;
  }

  void make_exchanged() {
    ASSERT_TRUE(drive_config_load(&inside::config()));
    make_ready();
  }
};

TEST_F(Exchange, ARunDoesNotSeeTheTable) {
  NEEDS("sources/paper");
  for (const std::int32_t source : {POSITION_ENCODER, POSITION_PAPER, POSITION_OBSERVER, POSITION_FLUX_CONV}) {
    expect_no_difference(
        [&] {
          make_run();
          use_source(source);
          drive_command_speed(raw(source == POSITION_ENCODER ? 900.0 : 0.0, 16));
        },
        DRIVE_RUN);
  }
}

TEST_F(Exchange, AStopAndItsEndDoNot) {
  expect_no_difference(
      [&] {
        make_run();
        inside::ramped_bpp() = bpp_of(100);
        drive_command_stop();
      },
      DRIVE_STOP);
}

TEST_F(Exchange, HysteresisDoesNot) {
  expect_no_difference(
      [&] {
        use_source(POSITION_ENCODER);
        parameters.current_law = CURRENT_LAW_HYSTERESIS;
        ASSERT_TRUE(drive_config_load(&inside::config()));
        make_run();
      },
      DRIVE_RUN);
}

class ExchangeOfAStart : public Exchange {
 protected:
  void expect_none(int method) {
    for (int bits = 0; bits < 4; ++bits) {
      expect_no_difference(
          [&] {
            parameters.flying_start = bits & 1;
            parameters.bootstrap_time = (bits & 2) != 0 ? raw(3.0, 16) : 0;
            parameters.start_method = method;
            parameters.wiring_check = 0;
            make_exchanged();
            drive_command_start();
          },
          DRIVE_START);
    }
  }
};

TEST_F(ExchangeOfAStart, ByTheAxisDoesNot) { expect_none(0); }

TEST_F(ExchangeOfAStart, ByACurrentVectorDoesNot) {
  NEEDS("start/if_start");
  expect_none(1);
}

TEST_F(Exchange, ACommissioningDoesNot) {
  NEEDS("commissioning");
  expect_no_difference(
      [&] {
        parameters.polarity_check = 0;
        make_exchanged();
        drive_command_commission();
        for (int n = 0; n < 350 && inside::state() != DRIVE_COMMISSION; ++n) period();
      },
      DRIVE_COMMISSION);
}

// Another source is chosen with the rest.
TEST_F(Exchange, ASourceThatIsSetIsNotChosenYet) {
  make_ready();
  ASSERT_EQ(parameter_set(kPositionSource, POSITION_AVV), SET_OK);
  EXPECT_EQ(inside::source(), position_sources[POSITION_OBSERVER]);
  period();
  EXPECT_EQ(inside::source(), position_sources[POSITION_OBSERVER]);
  background_step(&drive);
  EXPECT_EQ(inside::source(), position_sources[POSITION_AVV]);
}

TEST_F(Exchange, WhatIsSetComesWithTheExchange) {
  make_run();
  const std::int32_t before = inside::config().values.link_regulation, wanted = raw(380.0, 16);
  ASSERT_EQ(parameter_set(kLinkRegulation, wanted), SET_OK);
  period();
  EXPECT_EQ(inside::config().values.link_regulation, before);
  background_step(&drive);
  EXPECT_EQ(inside::config().values.link_regulation, wanted);
}

// A set that is refused is nowhere: neither in the table, nor in what is exchanged next.
TEST_F(Exchange, ARefusedSetNeverComes) {
  make_run();
  background_step(&drive);
  const config_values_t before = inside::config().values;
  const std::int32_t set = parameters.link_regulation;
  std::uint16_t octets[200];
  octet_writer_t why = octet_writer(octets, 200);
  const parameter_info_t* const p = parameter_by_id(kLinkRegulation);
  EXPECT_EQ(action_set(p, parameters.link_maximum, &why), ANSWER_CONFLICT);
  EXPECT_EQ(parameters.link_regulation, set);
  period();
  background_step(&drive);
  EXPECT_EQ(std::memcmp(&inside::config().values, &before, sizeof before), 0);
  EXPECT_TRUE(inside::config_valid());
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

// What is made of other values is in use when it is taken, and then all that the features have made of them, too.
TEST_F(Exchange, WhatIsMadeIsNotInUseYet) {
  NEEDS("sources/encoder", "sources/flux", "sources/paper", "start/if_start");
  const auto in_use = [] {
    return std::vector<std::int32_t>{flux_config.cutoff_q30, paper_config.kp_q30, if_ramp_config.align_periods,
                                     static_cast<std::int32_t>(encoder.trim_bam)};
  };
  const std::vector<std::int32_t> before = in_use();
  for (std::int32_t* value : {&parameters.flux_cutoff, &parameters.zvv_proportional, &parameters.encoder_trim}) {
    *value += 65536;
  }
  parameters.if_align += 1;
  ASSERT_EQ(drive_config_make(), PACKED_NONE);
  EXPECT_EQ(in_use(), before);
  drive_config_take(&inside::config());
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_NE(in_use()[k], before[k]) << k;
}

// Asking what a value would conflict with asks for nothing.
TEST_F(Exchange, AQuestionChangesNothing) {
  make_ready();
  background_step(&drive);
  const std::int32_t set = parameters.link_regulation;
  const parameter_info_t* const regulation = parameter_by_id(kLinkRegulation);
  EXPECT_NE(parameter_conflict_with(regulation, parameters.link_maximum), PACKED_NONE);
  EXPECT_EQ(parameter_conflict_with(regulation, set), PACKED_NONE);
  EXPECT_EQ(parameters.link_regulation, set);
  EXPECT_FALSE(inside::reload_requested());
  EXPECT_EQ(parameter_conflict_known(), PACKED_NONE);
}

}  // namespace
}  // namespace stillspin::test
