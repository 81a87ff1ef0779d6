// Faults that befall the plant at given times: what the section `fault` of profiles and scenarios says.
//
// One event of each kind, any number of kinds together. Times count from the end of the start procedure, as those of
// commands and load, or from power-on: what is wired wrongly is so before the first start. An event takes effect at the
// next start of a PWM period.

#ifndef STILLSPIN_SIM_HOST_BENCH_FAULT_PLAN_HPP
#define STILLSPIN_SIM_HOST_BENCH_FAULT_PLAN_HPP

#include <vector>

#include "sim_host/bench/board.hpp"

namespace stillspin::bench {

/// Phases are 0 none, 1 a, 2 b, 3 c. What is at its default does not happen.
struct FaultPlan {
  double open_phase = 0, open_phase_at = 0;
  double stuck_sensor = 0, stuck_sensor_at = 0, stuck_sensor_value = 0;  // A
  double drift_sensor = 0, drift_sensor_at = 0, drift_sensor_rate = 0;   // A/s
  double gain_sensor = 0, gain_sensor_at = 0, gain_sensor_factor = 1;    // of the gain before
  double link_sag = 1, link_sag_at = 0, link_sag_time = 3600;            // factor on the source, s
  double lost_triggers_at = 0, lost_triggers_time = 0;                   // s
  double blocked_shaft = 0, blocked_shaft_at = 0;
  double from_power_on = 0;                                                         // all these times
  double late_interrupts = 0, late_interrupts_at = 0, late_interrupts_time = 3600;  // us, s
};

/// Carries a plan out.
class FaultPlayer {
 public:
  explicit FaultPlayer(const FaultPlan& plan);

  /// At the start of every period, with the time since the end of the start procedure, negative before it, and since
  /// power-on.
  void step(double since_start, double since_power_on, Board& board);

 private:
  struct Event {
    double time;
    void (*act)(const FaultPlan&, Board&);
  };
  FaultPlan plan_;
  std::vector<Event> events_;  // in the order of time
  std::size_t next_ = 0;
};

}  // namespace stillspin::bench

#endif
