// The event-driven ePWM against one that steps its counter clock by clock, over random configurations and writes.
//
// The reference below is written from the tables of the type 0 manual on its own: it knows no stops, phases or anchors.

#include <array>
#include <random>

#include "tests/chip/epwm.hpp"

namespace stillspin::chip::testing {
namespace {

/// One module's time base and action qualifier, stepped. Only what the test uses.
struct SteppedEPwm {
  unsigned mode = kFrozen;
  unsigned count = 0;
  bool up = true;
  unsigned period = 0, period_shadow = 0;
  std::array<unsigned, 2> compare{}, compare_shadow{};
  std::array<unsigned, 2> load_mode{};
  std::array<unsigned, 2> action_control{};
  std::array<bool, 2> level{};

  unsigned action_of(int output, unsigned lsb) const { return (action_control[output] >> lsb) & 3u; }

  void apply() {
    const bool zero = count == 0;
    const bool top = count == period;
    if (mode == kUpDown) {
      up = zero ? true : (top ? false : up);
    } else {
      up = mode == kUp;
    }
    std::array<bool, 2> rising{}, falling{};
    for (int i = 0; i < 2; ++i) {
      const bool match = count == compare[i];
      const bool beyond = compare[i] >= period && top;
      if (mode == kUp) {
        rising[i] = match;
      } else if (mode == kDown) {
        falling[i] = match || beyond;
      } else {
        rising[i] = (up && match) || beyond;
        falling[i] = (!up && match) || beyond;
      }
    }
    for (int o = 0; o < 2; ++o) {
      // Lowest priority first, so that the last one that acts wins.
      std::array<std::pair<bool, unsigned>, 6> order{};
      const std::pair<bool, unsigned> z{zero, EPWM_AQCTLA_ZRO_LSB}, p{top, EPWM_AQCTLA_PRD_LSB};
      const std::pair<bool, unsigned> au{rising[0], EPWM_AQCTLA_CAU_LSB}, bu{rising[1], EPWM_AQCTLA_CBU_LSB};
      const std::pair<bool, unsigned> ad{falling[0], EPWM_AQCTLA_CAD_LSB}, bd{falling[1], EPWM_AQCTLA_CBD_LSB};
      const std::pair<bool, unsigned> none{false, 0};
      if (mode == kUp) {
        order = {none, none, z, au, bu, p};
      } else if (mode == kDown) {
        order = {none, none, p, ad, bd, z};
      } else if (up) {
        order = {none, ad, bd, z, au, bu};
      } else {
        order = {none, au, bu, p, ad, bd};
      }
      unsigned chosen = 0;
      for (const auto& [happens, lsb] : order) {
        chosen = happens && action_of(o, lsb) != 0 ? action_of(o, lsb) : chosen;
      }
      level[o] = chosen == kToggle ? !level[o] : chosen == kSet ? true : chosen == kClear ? false : level[o];
    }
    for (int i = 0; i < 2; ++i) {
      const bool load =
          (zero && (load_mode[i] == 0 || load_mode[i] == 2)) || (top && (load_mode[i] == 1 || load_mode[i] == 2));
      compare[i] = load ? compare_shadow[i] : compare[i];
    }
    period = zero ? period_shadow : period;
  }

  /// A counter that starts from zero has its shadows loaded before its first count acts.
  void start() {
    period = period_shadow;
    for (int i = 0; i < 2; ++i) {
      compare[i] = load_mode[i] == 0 || load_mode[i] == 2 ? compare_shadow[i] : compare[i];
    }
    apply();
  }

  void step() {
    if (mode == kUp) {
      count = count == period ? 0 : count + 1;
    } else if (mode == kDown) {
      count = count == 0 ? period : count - 1;
    } else {
      count = up ? count + 1 : count - 1;
    }
    apply();
  }
};

class EPwmAgainstStepping : public EPwmBench, public ::testing::WithParamInterface<unsigned> {};

TEST_P(EPwmAgainstStepping, EveryTickAgrees) {
  std::mt19937 random(GetParam());
  const auto up_to = [&random](unsigned n) { return static_cast<unsigned>(random() % (n + 1)); };
  for (int trial = 0; trial < 60; ++trial) {
    bank.reset(now);
    SteppedEPwm reference;
    reference.mode = up_to(2);
    const unsigned first_period = 2 + up_to(18);
    reference.period_shadow = first_period;
    for (int i = 0; i < 2; ++i) {
      reference.load_mode[i] = up_to(3);
      reference.compare_shadow[i] = up_to(24);
      // No actions at zero and the period in every second trial: then those counts may be passed without a stop.
      reference.action_control[i] = up_to(0xFFF) & (trial % 2 == 0 ? 0xFFFu : 0xFF0u);
    }
    write(2, EPWM_TBCTL, reference.mode);
    write(2, EPWM_TBPRD, first_period);
    write(2, EPWM_CMPCTL, reference.load_mode[0] | (reference.load_mode[1] << EPWM_CMPCTL_LOADBMODE_LSB));
    write(2, EPWM_CMPA_CMPA, reference.compare_shadow[0]);
    write(2, EPWM_CMPB, reference.compare_shadow[1]);
    write(2, EPWM_AQCTLA, reference.action_control[0]);
    write(2, EPWM_AQCTLB, reference.action_control[1]);
    start();
    reference.start();
    for (int tick = 0; tick < 400; ++tick) {
      const bool a = !services.edges.empty() && services.edges.back().a;
      const bool b = !services.edges.empty() && services.edges.back().b;
      ASSERT_EQ(read(2, EPWM_TBCTR), reference.count) << "trial " << trial << " tick " << tick;
      ASSERT_EQ(a, reference.level[0]) << "trial " << trial << " tick " << tick << " mode " << reference.mode;
      ASSERT_EQ(b, reference.level[1]) << "trial " << trial << " tick " << tick << " mode " << reference.mode;
      if (up_to(19) == 0) {
        const unsigned value = up_to(24);
        reference.compare_shadow[0] = value;
        write(2, EPWM_CMPA_CMPA, value);
      }
      if (up_to(19) == 0) {
        const unsigned value = up_to(24);
        reference.compare_shadow[1] = value;
        write(2, EPWM_CMPB, value);
      }
      if (up_to(79) == 0) {
        const unsigned value = 2 + up_to(18);
        reference.period_shadow = value;
        write(2, EPWM_TBPRD, value);
      }
      run(now + 1);
      reference.step();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EPwmAgainstStepping, ::testing::Values(1u, 2u, 3u, 4u, 5u));

}  // namespace
}  // namespace stillspin::chip::testing
