// What one leg does, seen from the motor terminal.
//
// Whatever its gates say, a leg is: voltage `low` while its current is positive, `high` while it is negative, anything
// in between while it is zero (low <= high). The gates only choose the two levels:
//   upper on   low = Vdc - Vce   high = Vdc + Vf
//   lower on   low = -Vf         high = Vce
//   both off   low = -Vf         high = Vdc + Vf
// and a slope resistance, that of the switch or of the diode that carries the current. Current positive out of the leg.

#ifndef STILLSPIN_SIM_HOST_PLANT_BRIDGE_HPP
#define STILLSPIN_SIM_HOST_PLANT_BRIDGE_HPP

#include <array>

#include "sim_host/plant/config.hpp"

namespace stillspin::plant {

/// v = rail * Vdc + constant - resistance * i; `rail` is also the share of the current drawn from the positive rail.
struct LegLine {
  double rail = 0.0;
  double constant = 0.0;
  double resistance = 0.0;

  double voltage(double link, double current) const { return rail * link + constant - resistance * current; }
};

struct Leg {
  LegLine low;           // positive current
  LegLine high;          // negative current
  bool open = false;     // the wire is cut: the terminal follows any voltage
  bool perfect = false;  // low and high are one line: the direction of the current does not matter

  static Leg make(const InverterConfig& c, bool upper, bool lower, bool open) {
    Leg leg;
    leg.open = open;
    const LegLine switch_up{1.0, -c.switch_threshold, c.switch_resistance};
    const LegLine diode_up{1.0, c.diode_threshold, c.diode_resistance};
    const LegLine switch_down{0.0, c.switch_threshold, c.switch_resistance};
    const LegLine diode_down{0.0, -c.diode_threshold, c.diode_resistance};
    leg.low = upper ? switch_up : diode_down;
    leg.high = lower ? switch_down : diode_up;
    leg.perfect = !open && (upper || lower) && leg.low.rail == leg.high.rail && leg.low.constant == leg.high.constant &&
                  leg.low.resistance == leg.high.resistance;
    return leg;
  }
};

/// Three legs as one voltage in alpha/beta: rail * Vdc + constant - resistance * i. The resistance matrix is symmetric:
/// r_mean on the diagonal, plus (r_plus, r_cross; r_cross, -r_plus) where the legs differ.
struct Bridge {
  double rail_alpha = 0.0, rail_beta = 0.0;
  double constant_alpha = 0.0, constant_beta = 0.0;
  double r_mean = 0.0, r_plus = 0.0, r_cross = 0.0;

  static Bridge make(const std::array<LegLine, 3>& l) {
    constexpr double kRoot = 0.57735026918962576;  // 1/sqrt(3)
    Bridge b;
    b.rail_alpha = (2.0 * l[0].rail - l[1].rail - l[2].rail) * (1.0 / 3.0);
    b.rail_beta = (l[1].rail - l[2].rail) * kRoot;
    b.constant_alpha = (2.0 * l[0].constant - l[1].constant - l[2].constant) * (1.0 / 3.0);
    b.constant_beta = (l[1].constant - l[2].constant) * kRoot;
    const double others = l[1].resistance + l[2].resistance;
    b.r_mean = (l[0].resistance + others) * (1.0 / 3.0);
    b.r_plus = (2.0 * l[0].resistance - others) * (1.0 / 6.0);
    b.r_cross = (l[2].resistance - l[1].resistance) * (0.5 * kRoot);
    return b;
  }
};

/// Direction of a leg's current: +1, -1, 0 = does not conduct.
using Directions = std::array<int, 3>;

}  // namespace stillspin::plant

#endif
