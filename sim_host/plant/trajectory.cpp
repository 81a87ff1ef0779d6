#include "sim_host/plant/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace stillspin::plant {
namespace {

constexpr double kStandingStill = 1e-14;  // s
constexpr int kSettled = 20;              // events at one instant after which what rounding says is not asked again
constexpr double kMoment = 1e-12;         // s: goes on by this then
constexpr int kMaxAtOnce = 60;            // more events than that at one instant are a defect of the model, as are
                                          // more such moments with nothing but events between them
constexpr int kResetAfter = 64;           // segments
constexpr double kGrazing = 1e-9;         // A: a double crossing less deep does not matter

}  // namespace

Trajectory::Trajectory(const PlantConfig& c)
    : model_(c), flow_(make_flow(c.solver)), ripple_speed_(2.0 * kPi * c.link.ripple_frequency) {
  const double turn = std::floor(c.initial.angle / (2.0 * kPi) + 0.5);
  angle_ = c.initial.angle - 2.0 * kPi * turn;
  turns_ = static_cast<std::int64_t>(turn);
  const double link = c.initial.link_voltage < 0.0 ? c.link.source_voltage : c.initial.link_voltage;
  start_.y = {c.initial.current_d, c.initial.current_q, c.mechanics.locked ? 0.0 : c.initial.speed, 0.0, link};
  model_.base = rotation(angle_);
  model_.anchor = model_.machine.anchor(start_.y[kIq]);
  model_.resolve(start_.y, {});
}

void Trajectory::begin() {
  model_.anchor = model_.machine.anchor_near(start_.y[kIq], model_.anchor);
  start_.flux = model_.machine.flux_at(start_.y[kId], start_.y[kIq], model_.anchor);
  model_.derive_at_start(start_.y, start_.flux, start_.slope, start_.flux_slope);
  origin_current_ = start_current();
  origin_slope_ = start_slope();
  started_ = true;
}

void Trajectory::look_ahead(Tick end) {
  if (!started_) begin();
  const double h = time_to(end);
  // Devices without drops on a shaft that begins to turn: which current the voltage will drive is not to be seen before
  // there is some, a moment later.
  flow_->advance(model_, start_, at_once_ > kSettled ? std::min(h, kMoment) : h, end_, step_);
  if (!step_.event && !step_.far && !crosses()) {
    const double dip = grazing_instant();
    if (dip > 0.0) {
      // Stop at the lowest point: there the event function is negative, so that the flow finds the first crossing.
      ++grazing_;
      flow_->advance(model_, start_, dip, end_, step_);
    }
  }
  // Short of the end: an event of nothing, so that the segment may end inside a tick.
  if (step_.reached < h && !crosses()) step_.event = true;
  end_tick_ = end;
  ahead_ = true;
  end_slope_known_ = step_.has_end_slope;
}

void Trajectory::locate() {
  if (!crosses()) return;
  flow_->locate(model_, start_, end_, step_);
  end_slope_known_ = step_.has_end_slope;
}

/// A current that falls and comes back inside the segment may have crossed zero twice, which its end does not show.
/// When it may have: the instant of its minimum, else 0.
double Trajectory::grazing_instant() {
  end_slope_known_ = step_.has_end_slope;
  if (model_.clamp == Clamp::kAll) return 0.0;
  const double h = step_.reached;
  const std::array<double, 3> i0 = phases(origin_current_), d0 = phases(origin_slope_);
  for (int k = 0; k < 3; ++k) {
    const double g0 = model_.direction[k] * i0[k], s0 = model_.direction[k] * d0[k];
    // Convex curves lie above their tangent: one that does not fall, or not as far as zero, has nothing to look for.
    if (int{s0 >= 0.0} | int{g0 + s0 * h >= 0.0} | int{model_.legs[k].perfect}) continue;  // one branch
    const AlphaBeta axis = model_.direction[k] * stator_axis(k);
    double lowest = 0.0, where = 0.0;
    for (int n = 1; n < 16; ++n) {
      const double x = h * n / 16.0;
      const double g = axis.dot(current(at_offset(x)));
      if (g < lowest) {
        lowest = g;
        where = x;
      }
    }
    if (lowest < -kGrazing) return std::max(1.0, std::floor(where / kEventCell + 0.5)) * kEventCell;
  }
  return 0.0;
}

void Trajectory::find_end_slope() const {
  model_.derive(step_.reached, end_, step_.end_slope);
  end_slope_known_ = true;
}

State Trajectory::at_offset(double s) const {
  const double h = step_.reached;
  return s >= h ? end_ : hermite(start_, end_, end_slope(), h, s);
}

double Trajectory::link_voltage_at_offset(double s) const {
  const double h = step_.reached;
  if (model_.link.stiff || s >= h) return model_.link_voltage(s, end_);
  return Hermite(h, s)(start_, end_, end_slope(), kLink);
}

void Trajectory::commit() {
  model_.project(end_);
  const double turned_by = end_[kAngle];
  angle_ += turned_by;
  if (std::fabs(angle_) > kPi) {
    const std::int64_t turn = nearest(angle_ / (2.0 * kPi));
    angle_ -= 2.0 * kPi * static_cast<double>(turn);
    turns_ += turn;
  }
  end_[kAngle] = 0.0;
  start_.y = end_;
  at_once_ = step_.reached > kStandingStill ? 0 : at_once_ + 1;
  if (at_once_ == 0) moments_ = step_.reached > kMoment ? 0 : moments_ + 1;
  if (at_once_ > kMaxAtOnce || moments_ > kMaxAtOnce) {
    throw std::runtime_error("plant: more than " + std::to_string(kMaxAtOnce) + " events at tick " +
                             std::to_string(tick_) + "; the conduction modes do not settle");
  }
  if (step_.event) {
    const double local = fraction_ + step_.reached;
    const Tick whole = static_cast<Tick>(local * 1e8);
    tick_ += whole;
    fraction_ = std::max(0.0, local - static_cast<double>(whole) * kSecondsPerTick);
  } else {
    tick_ = end_tick_;
    fraction_ = 0.0;
  }
  model_.load_start += model_.load_slope * step_.reached;
  turn_bases(turned_by);
  restart();
}

/// Rotations follow by small turns; every so often they are set anew, so that rounding does not add up.
void Trajectory::turn_bases(double angle) {
  if (++since_set_ < kResetAfter) {
    model_.base = turned(model_.base, angle);
    model_.ripple_base = turned(model_.ripple_base, ripple_speed_ * step_.reached);
    return;
  }
  since_set_ = 0;
  model_.anchor = model_.machine.anchor(start_.y[kIq]);
  model_.base = rotation(angle_);
  const double cycles = ripple_speed_ / (2.0 * kPi) * (static_cast<double>(tick_) * kSecondsPerTick + fraction_);
  model_.ripple_base = rotation(2.0 * kPi * (cycles - std::floor(cycles)));
}

}  // namespace stillspin::plant
