// The captured scope on interrupts that count themselves.

#ifndef STILLSPIN_TESTS_FIRMWARE_SCOPE_HPP
#define STILLSPIN_TESTS_FIRMWARE_SCOPE_HPP

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/mode/states.h"
#include "firmware/scope/scope.h"
}

namespace stillspin::test {

enum : std::uint16_t {
#define SIGNAL(name, unit, q, of, value, meaning) signal_##name,
#include "firmware/dictionary/all_signals.h"
#undef SIGNAL
  signals_listed
};

class Scope : public Drive {
 protected:
  void SetUp() override {
    NEEDS("scope");
    Drive::SetUp();
  }

  /// Interrupt number n: `current_d` is n, `current_q` what the test says.
  void interrupt(std::int32_t current = 0) {
    inside::be_in(DRIVE_RUN);
    inside::current_dq_q20().d = static_cast<std::int32_t>(n_);
    inside::current_dq_q20().q = current;
    inside::time_ms() = n_ / 10u;
    if (drive_onlooker != nullptr) drive_onlooker();
    n_++;
  }
  void interrupts(int count, std::int32_t current = 0) {
    for (int k = 0; k < count; ++k) interrupt(current);
  }

  /// Records the interrupt's number, triggers when current_q rises to 100.
  scope_setup_t counting() const {
    scope_setup_t s = {};
    s.decimation = 1;
    s.trigger = signal_current_q;
    s.level = 100;
    s.count = 1;
    s.channel[0] = {signal_current_d, 0};
    return s;
  }

  void arm(const scope_setup_t& s) {
    ASSERT_TRUE(scope_setup(&s));
    ASSERT_TRUE(scope_arm());
  }

  static std::vector<int> read(std::uint16_t channel = 0) {
    std::vector<int> all;
    std::array<std::int16_t, 100> words;
    for (;;) {
      const std::uint16_t got =
          scope_read(channel, static_cast<std::uint16_t>(all.size()), words.data(), std::uint16_t(words.size()));
      all.insert(all.end(), words.begin(), words.begin() + got);
      if (got < words.size()) return all;
    }
  }

  void expect_consecutive(const std::vector<int>& words, int first, int step = 1) {
    ASSERT_EQ(words.size(), SCOPE_DEPTH);
    for (int k = 0; k < int(SCOPE_DEPTH); ++k) ASSERT_EQ(words[std::size_t(k)], first + k * step) << k;
  }

  std::uint32_t n_ = 0;
};

}  // namespace stillspin::test

#endif
