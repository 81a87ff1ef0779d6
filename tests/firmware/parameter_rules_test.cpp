// Every rule that joins parameters: kept at its limit, refused beyond it, and named in words.

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/api/actions.h"
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/text/text.h"
}

namespace {

using namespace stillspin::test;
using stillspin::bench::text_of;

class ParameterRules : public Drive {
 protected:
  static void keeps() {
    const packed_text_t conflict = parameter_conflict();
    EXPECT_EQ(conflict, PACKED_NONE) << text_of(conflict);
  }
  static void refuses(const char* words) {
    const packed_text_t conflict = parameter_conflict();
    ASSERT_NE(conflict, PACKED_NONE) << words;
    EXPECT_NE(text_of(conflict).find(words), std::string::npos) << text_of(conflict);
  }
};

TEST_F(ParameterRules, AParameterThatIsNotInTheTableIsNotSet) {
  parameter_info_t strange = *parameter_info(0);
  strange.id = 1023;
  std::uint16_t octets[80];
  octet_writer_t why = octet_writer(octets, 80);
  EXPECT_EQ(action_set(&strange, 4, &why), ANSWER_UNKNOWN);
  EXPECT_EQ(why.count, 0);
  EXPECT_EQ(action_set(parameter_info(0), 4, &why), ANSWER_OK);
}

// A parameter at the largest (or least) value that a rule lets it have, and one step beyond.
struct Rule {
  std::int32_t parameters_t::* parameter;
  std::int32_t kept, refused;
  const char* words;
};

TEST_F(ParameterRules, EachHoldsUpToItsLimit) {
  parameters.magnet_flux = raw(0.03, 28);  // no EMF that charges the link
  const parameters_t p = parameters;
  const Rule rules[] = {
      {&parameters_t::inductance_q, p.inductance_d, p.inductance_d - 1, "inductance_q must be"},
      {&parameters_t::blend_high, p.blend_low + raw(1.0, 16), p.blend_low, "blend_high"},
      {&parameters_t::window_maximum, p.window_minimum, p.window_minimum - 1, "window_maximum"},
      {&parameters_t::link_regulation, p.link_minimum + 1, p.link_minimum, "link_regulation"},
      {&parameters_t::link_regulation, p.link_maximum - 65536, p.link_maximum - 65535, "link_regulation"},
      {&parameters_t::turn_off_delay, p.dead_time + p.turn_on_delay, p.dead_time + p.turn_on_delay + 1,
       "turn_off_delay must not"},
      {&parameters_t::dead_time, raw(2.4, 16) - p.turn_on_delay - 1, raw(2.4, 16) - p.turn_on_delay + 1, "2.4 us"},
      {&parameters_t::trip_current, p.current_limit, p.current_limit - 1, "trip_current must be at least"},
      {&parameters_t::trip_current, p.current_full_scale / 100 * 97, p.current_full_scale / 100 * 97 + 1,
       "97 % of current_full_scale"},
      {&parameters_t::link_maximum, p.link_full_scale / 100 * 97, p.link_full_scale / 100 * 97 + 1,
       "97 % of link_full_scale"},
      {&parameters_t::weakening_limit, p.current_limit, p.current_limit + 1, "weakening_limit"},
      {&parameters_t::window_minimum, p.settle_time + raw(4.5, 16), p.settle_time + raw(4.5, 16) - 1,
       "window_minimum must be settle_time"},
      {&parameters_t::speed_limit, raw(15000.0, 8), raw(15000.0, 8) + 1, "1 kHz"},
  };
  for (const Rule& rule : rules) {
    parameters = p;
    parameters.*rule.parameter = rule.kept;
    SCOPED_TRACE(rule.words);
    keeps();
    parameters.*rule.parameter = rule.refused;
    refuses(rule.words);
  }
}

// At each of the map's four currents the inductance along q is that along d or more; the mutual one may be what it is.
TEST_F(ParameterRules, TheSaliencyKeepsItsSenseAtEveryPointOfTheMap) {
  const parameters_t p = parameters;
  const std::int32_t full = raw(100.0, 16);
  const struct {
    std::int32_t parameters_t::* along_q;
    std::int32_t parameters_t::* along_d;
  } points[] = {{&parameters_t::lqq_1, &parameters_t::ldd_1},
                {&parameters_t::lqq_2, &parameters_t::ldd_2},
                {&parameters_t::lqq_3, &parameters_t::ldd_3},
                {&parameters_t::lqq_4, &parameters_t::ldd_4}};
  for (const auto& point : points) {
    parameters = p;
    parameters.inductance_d = parameters.inductance_q = raw(50.0, 20);
    parameters.*point.along_q = parameters.*point.along_d = full / 2;
    keeps();
    parameters.*point.along_q -= 1;
    refuses("lqq_n");
    parameters.*point.along_d -= 1;
    keeps();
    parameters.inductance_d += 1;
    parameters.inductance_q += 1;
    keeps();
  }
  parameters = p;
  parameters.inductance_d = raw(50.0, 20);
  parameters.inductance_q = raw(60.0, 20);
  parameters.ldq_1 = raw(20.0, 20);
  keeps();
}

TEST_F(ParameterRules, LinkMaximumLiesAboveLinkMinimum) {
  parameters.link_minimum = parameters.link_maximum;
  parameters.link_regulation = parameters.link_maximum;
  refuses("link_maximum must be above");
}

TEST_F(ParameterRules, ThePulseLeavesRoomForItsWindow) {
  parameters.settle_time = parameters.pulse_time / 20 * 13 - raw(4.5, 16);
  parameters.window_minimum = parameters.window_maximum = raw(30.0, 16);
  keeps();
  parameters.settle_time += raw(0.01, 16);
  refuses("0.65 x pulse_time");
  parameters.pulse_time = raw(15.0, 16);
  parameters.settle_time = raw(5.25, 16);
  keeps();
  parameters.settle_time += raw(0.01, 16);
  refuses("0.65 x pulse_time");
}

TEST_F(ParameterRules, ThePapersSchemeNeedsItsCurrentInEitherDirection) {
  NEEDS("sources/paper");
  parameters.position_source = POSITION_PAPER;
  for (const double amps : {0.0, 0.99, -0.99}) {
    parameters.id_low_speed = raw(amps, 20);
    refuses("id_low_speed");
  }
  for (const double amps : {1.0, -1.0}) {
    parameters.id_low_speed = raw(amps, 20);
    keeps();
  }
}

TEST_F(ParameterRules, AvvNeedsTwoActiveVectors) {
  for (const int source : {0, 2, 3, 4}) {
    for (const int excitation : {0, 1, 2, 3, 4, 5}) {
      parameters.position_source = source;
      parameters.excitation = excitation;
      const bool avv = source == 2 || source == 3;
      SCOPED_TRACE(testing::Message() << source << " " << excitation);
      if (avv && (excitation == 0 || excitation >= 4)) {
        refuses("AVV needs two active vectors");
      } else {
        keeps();
      }
    }
  }
}

TEST_F(ParameterRules, AHoldNeedsOppositeWindows) {
  for (const int excitation : {0, 1, 2, 3, 4, 5}) {
    parameters.excitation = excitation;
    for (const int time : {0, 100}) {
      parameters.hold_time = time;
      SCOPED_TRACE(excitation);
      if (time > 0 && (excitation < 2 || excitation == 4)) {
        refuses("hold_time");
      } else {
        keeps();
      }
    }
  }
}

TEST_F(ParameterRules, HysteresisNeedsTheEncoderAndWholeSlices) {
  NEEDS("hysteresis");
  for (const int source : {0, 4}) {
    parameters.position_source = source;
    parameters.current_law = 1;
    source == 0 ? keeps() : refuses("current_law 1");
    parameters.current_law = 0;
    keeps();
  }
  parameters.slice_time = raw(10.0, 16);
  keeps();
  parameters.slice_time = raw(11.0, 16);
  refuses("slice_time");
}

TEST_F(ParameterRules, AFluxThatLooksOnNeedsTheEncoder) {
  NEEDS("sources/flux");
  for (const int source : {0, 4}) {
    parameters.position_source = source;
    parameters.flux_beside = 1;
    source == 0 ? keeps() : refuses("flux_beside");
    parameters.flux_beside = 0;
    keeps();
  }
  parameters.flux_high = parameters.flux_low + 1;
  keeps();
}

TEST_F(ParameterRules, AVectorsStartDoesNotBeginWithTheEncoder) {
  NEEDS("start/if_start");
  parameters.start_method = 1;
  parameters.position_source = 0;
  refuses("start_method 1 needs");
  parameters.position_source = 4;
  keeps();
}

// What an edition has not has nothing against the rest: values that another one saved are kept as they are.
TEST_F(ParameterRules, AFeatureThatIsLeftOutHasNoRules) {
  parameters.flux_high = parameters.flux_low;
  missing_of({"sources/flux"}).empty() ? refuses("flux_high") : keeps();
}

TEST_F(ParameterRules, TheVectorsCurrentIsLimitedWhereThereIsOne) {
  NEEDS("start/if_start");
  parameters.if_current = parameters.current_limit + 1;
  keeps();
  parameters.start_method = 1;
  refuses("if_current");
  parameters.if_current = parameters.current_limit;
  keeps();
}

TEST_F(ParameterRules, TheCurrentLoopsDelayBoundsItsBandwidth) {
  for (const int divider : {1, 2}) {
    parameters.current_divider = divider;
    parameters.current_bandwidth = 10400 / (3 + divider);
    keeps();
    parameters.current_bandwidth++;
    refuses("current_bandwidth");
  }
}

// What no table of two parameters says, the configuration itself finds.
TEST_F(ParameterRules, AMachineBeyondTheFormatsIsRefused) {
  const parameters_t p = parameters;
  parameters.inductance_d = raw(0.05, 20);  // 2 T/L: no inverse inductance of this format
  parameters.inductance_q = raw(0.05, 20);
  refuses("too extreme");
  parameters = p;
  parameters.inertia = raw(0.5, 24);
  parameters.magnet_flux = raw(0.002, 28);
  refuses("too extreme");
}

TEST_F(ParameterRules, AMachineThatSwingsTooFastForTheIFStartIsRefused) {
  NEEDS("start/if_start");
  parameters.start_method = 1;
  parameters.inertia = raw(1e-4, 24);  // so light under so much current that it swings faster than it can be damped
  parameters.magnet_flux = raw(0.35, 28);
  parameters.speed_limit = raw(1000.0, 8);
  parameters.if_current = parameters.current_limit;
  refuses("too extreme");
  parameters.start_method = 0;
  keeps();
}

// The sources have the same numbers in every edition.
TEST_F(ParameterRules, ASourceIsRefusedForTheEditionWhereItIsNotInItAndOnlyThere) {
  const parameters_t p = parameters;
  for (std::int32_t source = POSITION_ENCODER; source <= POSITION_FLUX_ACTIVE; ++source) {
    parameters = p;
    parameters.position_source = source;
    const packed_text_t conflict = parameter_conflict();
    const std::string said = (conflict == PACKED_NONE) ? "" : text_of(conflict);
    EXPECT_EQ(said.find("position_source is not in this edition") == std::string::npos, has_source(source)) << said;
  }
}

// The drive takes no such machine over, and says why; the one that it had stays.
TEST_F(ParameterRules, AMachineThatIsRefusedIsNotLoaded) {
  const std::int32_t had = inside::config().values.link_minimum;
  parameters.inductance_d = parameters.inductance_q = raw(0.05, 20);
  parameters.link_minimum = had - 65536;
  inside::request_reload();
  background_step(&drive);
  EXPECT_FALSE(inside::config_valid());
  EXPECT_NE(text_of(inside::conflict()).find("too extreme"), std::string::npos);
  EXPECT_EQ(inside::config().values.link_minimum, had);
}

TEST_F(ParameterRules, AMachineMayHaveAllPolePairsOfTheTable) {
  parameters.speed_limit = raw(300.0, 8);
  parameters.pole_pairs = 30;
  keeps();
}

// With twice the sensors' full scale along d the reluctance adds 51 N m/A to a torque constant at most.
TEST_F(ParameterRules, AReluctanceBeyondTheTorquesFormatsIsRefused) {
  parameters.inductance_d = raw(60.0, 20);
  parameters.inductance_q = raw(200.0, 20);
  parameters.speed_limit = raw(300.0, 8);
  parameters.current_full_scale = raw(25.0, 20);
  parameters.pole_pairs = 4;  // 6 * 0.14 * 50 = 42 N m/A
  keeps();
  parameters.pole_pairs = 5;  // 52.5
  refuses("too extreme");
  parameters.pole_pairs = 4;
  parameters.current_full_scale = raw(30.0, 20);  // 50.4
  keeps();
  parameters.current_full_scale = raw(31.0, 20);  // 52.1
  refuses("too extreme");
  parameters.inductance_d = raw(179.5, 20);
  parameters.current_full_scale = raw(200.0, 20);  // 6 * 0.0205 * 400 = 49.2
  keeps();
}

// What the look takes off the slope of the current, per period and A: T R / L, and (L_q / L_d - 1) times what the rotor
// turns in a period, 2 at most.
TEST_F(ParameterRules, AMachineThatAPeriodIsTooLongForIsRefused) {
  const parameters_t p = parameters;
  parameters.magnet_flux = raw(0.01, 28);
  parameters.inductance_d = raw(2.0, 20);
  parameters.inductance_q = raw(16.0, 20);
  parameters.speed_limit = raw(4200.0, 8);  // 0.264 rad per period on six pole pairs
  parameters.pole_pairs = 6;
  keeps();                                  // 0.02 + 7 * 0.264 = 1.87
  parameters.speed_limit = raw(4600.0, 8);  // 2.04
  refuses("too extreme");
  parameters = p;
  parameters.inductance_d = parameters.inductance_q = raw(0.25, 20);
  parameters.stator_resistance = raw(4.9, 24);
  keeps();  // a time constant of 51 us
  parameters.stator_resistance = raw(5.1, 24);
  refuses("too extreme");
}

}  // namespace
