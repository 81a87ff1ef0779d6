// Current sensors between the true currents and the ADC input: first-order bandwidth, ringing after voltage edges, gain
// and offset. Exact between events instead of integrated (a 1 us time constant would make the machine stiff).
//
// Bandwidth: over a segment the current is a parabola u through start, start slope and end; then
//   y(h) = p(h) + (y(0) - p(0)) exp(-h/tau),   p = u - tau u' + tau^2 u''.
// Ringing: an edge of the leg voltage by dV adds A dV/V sin(2 pi f t) exp(-t/tau_r) to the switched phase and minus
// half of that to the others (V = source voltage). Both are linear and sum to zero over the phases, so alpha/beta
// suffices.

#ifndef STILLSPIN_SIM_HOST_PLANT_SENSORS_HPP
#define STILLSPIN_SIM_HOST_PLANT_SENSORS_HPP

#include <array>
#include <cmath>

#include "sim_host/plant/portable_math.hpp"
#include "sim_host/plant/trajectory.hpp"

namespace stillspin::plant {

class Sensors {
 public:
  Sensors(const PlantConfig& config, const AlphaBeta& initial);

  /// The segment from current i0 with slope d0 to i1, h seconds long, has passed.
  void commit(const AlphaBeta& i0, const AlphaBeta& d0, const AlphaBeta& i1, double h) {
    filtered_ = filtered(i0, d0, i1, h);
  }

  /// Filter output at i1, s seconds after the start of a segment.
  AlphaBeta filtered(const AlphaBeta& i0, const AlphaBeta& d0, const AlphaBeta& i1, double s) const {
    if (tau_ == 0.0) return i1;
    if (!(s > 0.0)) return filtered_;
    const double left = forgetting(s);
    const double per_square = s > kShortParabola ? 2.0 / (s * s) : 0.0;
    const AlphaBeta bend = per_square * (i1 - i0 - s * d0);
    const AlphaBeta at_start = i0 - tau_ * d0 + tau_ * tau_ * bend;
    const AlphaBeta at_end = i1 - tau_ * (d0 + s * bend) + tau_ * tau_ * bend;
    return at_end + left * (filtered_ - at_start);
  }

  /// Leg voltages jumped by `step` V at `fraction` s after tick t.
  void excite(Tick t, double fraction, const std::array<double, 3>& step);

  /// Ringing at t, which is not before the last edge.
  AlphaBeta ringing(Tick t) const;

  /// Reading of `phase` (A) at t for its current, filtered and with ringing.
  double reading(int phase, Tick t, double current) const {
    const Output& o = outputs_[phase];
    return o.faulty ? failing(phase, t, current) : o.gain * current + o.offset;
  }

  void stick(int phase, double value);
  void drift(int phase, Tick from, double per_second);
  void scale(int phase, double factor);
  void repair();

 private:
  struct Output {
    double gain = 1.0;    // A/A
    double offset = 0.0;  // A
    bool faulty = false;  // the rest matters
    bool stuck = false;
    double stuck_at = 0.0;  // A
    double drift = 0.0;     // A/s
    Tick drift_from = 0;
  };
  struct Phasor {
    double re = 0.0;
    double im = 0.0;
  };

  double failing(int phase, Tick t, double current) const;
  /// exp(-seconds/tau): from the tables for whole ticks up to their end, which is most of the time.
  double forgetting(double seconds) const {
    const double ticks = seconds * 1e8;
    const auto whole = static_cast<unsigned>(static_cast<int>(ticks + 0.5));
    if (whole < kFine * kCoarse && std::fabs(ticks - static_cast<int>(whole)) < kWholeTick) {
      return seconds * inverse_tau_ > kForgotten ? 0.0 : coarse_filter_[whole / kFine] * fine_filter_[whole % kFine];
    }
    return forgetting_between(seconds);
  }
  double forgetting_between(double seconds) const;
  static Phasor product(const Phasor& a, const Phasor& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  Phasor decay(double seconds) const;
  Phasor decay(Tick ticks) const;

  SensorConfig config_;
  double tau_;          // s, 0 = ideal
  double inverse_tau_;  // 1/s
  double ring_scale_;   // A/V
  Tick ring_end_;       // ticks after which nothing is left of a ringing
  AlphaBeta filtered_;
  Phasor ring_alpha_, ring_beta_;
  Tick ring_tick_ = 0;
  static constexpr double kForgotten = 40.0;      // time constants after which nothing is left (4e-18)
  static constexpr double kWholeTick = 1e-9;      // ticks: rounding of seconds
  static constexpr double kShortParabola = 1e-9;  // s: a shorter segment is a straight line (else mere rounding)
  static constexpr unsigned kFine = 64;
  static constexpr unsigned kCoarse = 128;
  std::array<Phasor, kFine> fine_;      // decay over 0..63 ticks
  std::array<Phasor, kCoarse> coarse_;  // decay over 0, 64, 128, ... ticks
  std::array<double, kFine> fine_filter_;
  std::array<double, kCoarse> coarse_filter_;
  std::array<Output, 3> outputs_;
};

}  // namespace stillspin::plant

#endif
