// A machine whose commissioning has gone well: all sums are right.

#ifndef STILLSPIN_TESTS_FIRMWARE_COMMISSIONING_JUDGE_HPP
#define STILLSPIN_TESTS_FIRMWARE_COMMISSIONING_JUDGE_HPP

#include <string>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/commissioning_sums.hpp"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/commissioning/outcome.h"
#include "firmware/commissioning/result.h"
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
}

namespace stillspin::test {

inline constexpr Inductances kUnsaturated = {4.655e-3, 7.41e-3, 0.0};

// Of a level of the map; what a torque current of 3.5 A does.
constexpr Inductances saturated(int level) { return {4.655e-3, 7.41e-3 - 0.4e-3 * level, 0.04e-3 * level}; }

class CommissioningJudge : public Drive {
 protected:
  void SetUp() override {
    NEEDS("commissioning");
    Drive::SetUp();
    const machine_model_t m = nameplate();
    c.model = m;
    c.staircase = climbed(m, 0.387, 0.08, -0.15);
    unsaturated(kUnsaturated);
    c.map.most_q20 = parameters.current_limit;
    c.map.levels = MAP_LEVELS;
    for (int level = 1; level <= 4; ++level) measured(level, saturated(level), 3.5 * level);
    c.spin = spun(0.1552, 0.00546, 0.003, 0.387);
  }
  void TearDown() override { drive_reset(); }

  void unsaturated(const Inductances& l) {
    tensor_reset(&c.unsaturated);
    add_pairs(&c.unsaturated, c.model, l, 0.0, 0.0, 99);
  }
  void measured(int level, const Inductances& l, double current) {
    for (int k = 0; k < 4; ++k) {
      map_group_t& g = c.map.group[level - 1][k] = {};
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      add_pairs(&g.tensor, c.model, {l.dd, l.qq, sign * l.dq}, 0.0, 0.0, 60);
      g.current = 60LL * raw(sign * current, 20);
      g.position = 60LL * (k < 2 ? 50000000LL : -50000000LL);
    }
  }
  commissioning_verdict_t verdict(const std::string& name) {
    commissioning_report_t report;
    commissioning_judge(&c, &report);
    for (int k = 0; k < report.count; ++k) {
      if (name == stillspin::bench::text_of(parameter_name(parameter_by_id(report.list[k].id))))
        return report.list[k].verdict;
    }
    ADD_FAILURE() << name;
    return VERDICT_DEPENDS;
  }

  commissioning_t c{};
};

}  // namespace stillspin::test

#endif
