#include "sim_host/bench/fault_plan.hpp"

#include <algorithm>
#include <cmath>

namespace stillspin::bench {
namespace {

constexpr double kTicksPerMicrosecond = 100.0;
constexpr double kSameTime = 1e-9;

void inject(Board& board, plant::FaultKind kind, double phase, double value) {
  board.plant().inject({kind, static_cast<int>(phase) - 1, value});
}

void inject_sag(Board& board, double factor) { board.plant().inject({plant::FaultKind::kLinkSag, 0, factor}); }

}  // namespace

FaultPlayer::FaultPlayer(const FaultPlan& plan) : plan_(plan) {
  const auto at = [this](bool wanted, double time, void (*act)(const FaultPlan&, Board&)) {
    if (wanted) events_.push_back({time, act});
  };
  using plant::FaultKind;
  const FaultPlan& p = plan;
  at(p.open_phase > 0, p.open_phase_at,
     [](const FaultPlan& f, Board& b) { inject(b, FaultKind::kOpenPhase, f.open_phase, 0.0); });
  at(p.stuck_sensor > 0, p.stuck_sensor_at,
     [](const FaultPlan& f, Board& b) { inject(b, FaultKind::kSensorStuck, f.stuck_sensor, f.stuck_sensor_value); });
  at(p.drift_sensor > 0, p.drift_sensor_at,
     [](const FaultPlan& f, Board& b) { inject(b, FaultKind::kSensorDrift, f.drift_sensor, f.drift_sensor_rate); });
  at(p.gain_sensor > 0, p.gain_sensor_at,
     [](const FaultPlan& f, Board& b) { inject(b, FaultKind::kSensorGain, f.gain_sensor, f.gain_sensor_factor); });
  at(p.link_sag != 1.0, p.link_sag_at, [](const FaultPlan& f, Board& b) { inject_sag(b, f.link_sag); });
  at(p.link_sag != 1.0, p.link_sag_at + p.link_sag_time, [](const FaultPlan&, Board& b) { inject_sag(b, 1.0); });
  at(p.lost_triggers_time > 0, p.lost_triggers_at, [](const FaultPlan&, Board& b) { b.lose_triggers(true); });
  at(p.lost_triggers_time > 0, p.lost_triggers_at + p.lost_triggers_time,
     [](const FaultPlan&, Board& b) { b.lose_triggers(false); });
  at(p.blocked_shaft != 0, p.blocked_shaft_at, [](const FaultPlan&, Board& b) { b.plant().set_locked(true); });
  at(p.late_interrupts > 0, p.late_interrupts_at,
     [](const FaultPlan& f, Board& b) { b.delay_interrupts(std::llround(f.late_interrupts * kTicksPerMicrosecond)); });
  at(p.late_interrupts > 0, p.late_interrupts_at + p.late_interrupts_time,
     [](const FaultPlan&, Board& b) { b.delay_interrupts(0); });
  std::stable_sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) { return a.time < b.time; });
}

void FaultPlayer::step(double since_start, double since_power_on, Board& board) {
  const double now = plan_.from_power_on != 0.0 ? since_power_on : since_start;
  if (now < 0.0) return;
  while (next_ < events_.size() && events_[next_].time <= now + kSameTime) events_[next_++].act(plan_, board);
}

}  // namespace stillspin::bench
