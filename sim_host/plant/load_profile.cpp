#include "sim_host/plant/load_profile.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "sim_host/plant/gates.hpp"

namespace stillspin::plant {

void LoadProfile::set(std::vector<LoadPoint> points) {
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (!(std::fabs(points[n].torque) <= 1e4)) {
      throw std::invalid_argument("plant load: point " + std::to_string(n) + " has torque " +
                                  std::to_string(points[n].torque) + " N m, outside -10000..10000 N m");
    }
    if (n > 0 && points[n].tick < points[n - 1].tick) {
      throw std::invalid_argument("plant load: point " + std::to_string(n) + " at tick " +
                                  std::to_string(points[n].tick) + " lies before its predecessor at tick " +
                                  std::to_string(points[n - 1].tick) + "; sort the points by time");
    }
  }
  points_ = std::move(points);
  passed_ = 0;
}

LoadProfile::Piece LoadProfile::at(Tick t) {
  while (passed_ < points_.size() && points_[passed_].tick <= t) ++passed_;
  if (points_.empty()) return {0.0, 0.0, kNever};
  if (passed_ == 0) return {points_.front().torque, 0.0, points_.front().tick};
  const LoadPoint& from = points_[passed_ - 1];
  if (passed_ == points_.size()) return {from.torque, 0.0, kNever};
  const LoadPoint& to = points_[passed_];
  const double slope = (to.torque - from.torque) / (static_cast<double>(to.tick - from.tick) * kSecondsPerTick);
  const double elapsed = static_cast<double>(t - from.tick) * kSecondsPerTick;
  return {from.torque + slope * elapsed, slope, to.tick};
}

}  // namespace stillspin::plant
