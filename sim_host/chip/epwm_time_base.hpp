// The time base and counter-compare submodules of one ePWM: where the counter is, and when it next reaches a value
// that somebody acts upon.
//
// The counter is never stepped. Its place is kept as a *phase*, the number of counts since zero in the direction of
// counting, which grows by one each TBCLK in all three modes and returns to 0 after `length` counts:
//     up       phase = count                                   length = TBPRD + 1
//     down     phase = 0 at count 0, else TBPRD + 1 - count    length = TBPRD + 1
//     up-down  phase = count (up), 2 TBPRD - count (down)      length = 2 TBPRD
// A stop is a phase at which something happens. Zero is always one, so phase + elapsed counts never wraps in between.
//
// Source: TI SPRU791 / SPRUG04 (type 0 ePWM), behaviour of the compare events as in the action qualifier's tables:
// in up-down mode the direction is "up" at zero and "down" at the period; a compare value at or beyond the period acts
// at the period in the down and up-down modes and never in up mode.
//
// Not modelled: period 0. The counter then stands at zero and its events happen once per register write, not at every
// TBCLK.

#ifndef STILLSPIN_SIM_HOST_CHIP_EPWM_TIME_BASE_HPP
#define STILLSPIN_SIM_HOST_CHIP_EPWM_TIME_BASE_HPP

#include <cstdint>

#include "sim_host/chip/world.hpp"

namespace stillspin::chip {

/// What can happen at a count. Bit i goes with the two-bit action field at 2 i of AQCTLA/AQCTLB.
enum CountEvent : unsigned {
  kCountZero = 1u << 0,
  kCountPeriod = 1u << 1,
  kCountAUp = 1u << 2,
  kCountADown = 1u << 3,
  kCountBUp = 1u << 4,
  kCountBDown = 1u << 5,
};

enum class CountMode : unsigned { up = 0, down = 1, up_down = 2, stopped = 3 };

class TimeBase {
 public:
  void reset(Tick t);

  std::uint16_t count(Tick t) const;
  bool counting_up(Tick t) const;
  CountMode mode() const { return mode_; }
  bool running() const { return running_; }
  bool starting() const { return first_clock_; }  // the first TBCLK after standing still is yet to come
  Tick clock_period() const { return clock_period_; }
  std::uint16_t period() const { return period_; }
  std::uint16_t compare_a() const { return compare_a_; }
  std::uint16_t compare_b() const { return compare_b_; }

  /// New counting mode, TBCLK period in ticks, or gate. The count is kept; a counter that starts sees the event of the
  /// count at which it stood in its first TBCLK, which is what loads the shadow registers after configuration.
  void configure(CountMode mode, Tick clock_period, bool gate_open, Tick t);

  /// A write to TBCTR: no event at the value itself while counting (TI: "needs at least 1 TBCLK").
  void write_count(std::uint16_t value, Tick t);

  /// The last TBCLK edge at or before t.
  Tick last_edge(Tick t) const;

  /// Phase load by a synchronisation pulse. True if the counter moved; then its events at t are due: take_stop(t).
  bool load_phase(std::uint16_t value, bool up, Tick t);
  bool would_move(std::uint16_t value, bool up, Tick t) const;

  /// The active registers change. `t` only matters for the period.
  void set_period(std::uint16_t value, Tick t);
  void set_compare_a(std::uint16_t value) { compare_a_ = value; }
  void set_compare_b(std::uint16_t value) { compare_b_ = value; }

  /// Which events are acted upon (CountEvent bits). After this or a setter: schedule().
  void set_interest(unsigned events) { interest_ = events; }

  /// Recompute the stops and the next one, seen from t.
  void schedule(Tick t);

  /// A standing counter (period 0) sees zero again in the next TBCLK.
  void poke(Tick t);

  Tick next_stop() const { return next_stop_; }

  /// Move to the stop that is due at t; returns its events.
  unsigned take_stop(Tick t);

  /// The counter reached 0xFFFF since the last clear (TBSTS.CTRMAX).
  bool reached_max() const { return reached_max_; }
  void clear_max() { reached_max_ = false; }

 private:
  struct Stop {
    std::int32_t phase;
    unsigned event;
  };
  enum class Outside { no, to_wrap, to_period };  // count > period: which way back

  std::int32_t counts_since_anchor(Tick t) const;
  std::int32_t phase(Tick t) const;
  std::int32_t length() const;
  bool phase_is_up(std::int32_t p) const;
  std::uint16_t count_at_phase(std::int32_t p) const;
  void locate(std::uint16_t value, bool up, Tick t);
  void settle(Tick t);
  void add_stop(std::int32_t p, unsigned event);
  void rebuild_stops();
  Tick tick_of_next_stop() const;
  unsigned take_usual_stop(Tick t);

  CountMode mode_ = CountMode::stopped;
  bool running_ = false;
  bool up_ = true;            // direction kept while stopped
  bool first_clock_ = false;  // the events at the anchor itself are still due
  bool reached_max_ = false;
  Outside outside_ = Outside::no;
  std::uint16_t outside_count_ = 0;  // count at the anchor while outside
  std::uint16_t period_ = 0;
  std::uint16_t compare_a_ = 0;
  std::uint16_t compare_b_ = 0;
  unsigned interest_ = 0;
  std::int32_t anchor_phase_ = 0;
  Tick anchor_ = 0;
  Tick clock_period_ = 1;
  Tick next_stop_ = kNever;
  Stop stops_[5] = {};
  int stop_count_ = 0;
};

}  // namespace stillspin::chip

#endif
