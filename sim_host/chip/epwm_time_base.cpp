#include "sim_host/chip/epwm_time_base.hpp"

#include <algorithm>

namespace stillspin::chip {

namespace {
constexpr std::int32_t kFullScale = 0x10000;  // an up-counter that missed its period wraps here
}

void TimeBase::reset(Tick t) {
  *this = TimeBase{};
  anchor_ = t;
}

std::int32_t TimeBase::length() const {
  return mode_ == CountMode::up_down ? 2 * static_cast<std::int32_t>(period_) : static_cast<std::int32_t>(period_) + 1;
}

std::int32_t TimeBase::counts_since_anchor(Tick t) const {
  if (!running_) {
    return 0;
  }
  const Tick elapsed = t - anchor_;
  return static_cast<std::int32_t>(clock_period_ == 1 ? elapsed : elapsed / clock_period_);
}

Tick TimeBase::last_edge(Tick t) const {
  return running_ ? anchor_ + static_cast<Tick>(counts_since_anchor(t)) * clock_period_ : t;
}

std::int32_t TimeBase::phase(Tick t) const {
  if (mode_ == CountMode::stopped) {
    return anchor_phase_;
  }
  if (period_ == 0) {
    return 0;
  }
  // Past zero only when asked before the stop of this very tick has been taken.
  const std::int32_t p = anchor_phase_ + counts_since_anchor(t);
  return p >= length() ? p - length() : p;
}

bool TimeBase::phase_is_up(std::int32_t p) const {
  switch (mode_) {
    case CountMode::up:
      return true;
    case CountMode::down:
      return false;
    case CountMode::up_down:
      return p < static_cast<std::int32_t>(period_) || period_ == 0;
    case CountMode::stopped:
      break;
  }
  return up_;
}

std::uint16_t TimeBase::count_at_phase(std::int32_t p) const {
  switch (mode_) {
    case CountMode::down:
      return static_cast<std::uint16_t>(p == 0 ? 0 : static_cast<std::int32_t>(period_) + 1 - p);
    case CountMode::up_down:
      return static_cast<std::uint16_t>(std::min(p, 2 * static_cast<std::int32_t>(period_) - p));
    case CountMode::up:
    case CountMode::stopped:
      break;
  }
  return static_cast<std::uint16_t>(p);
}

std::uint16_t TimeBase::count(Tick t) const {
  if (outside_ == Outside::to_wrap) {
    return static_cast<std::uint16_t>(outside_count_ + counts_since_anchor(t));
  }
  if (outside_ == Outside::to_period) {
    return static_cast<std::uint16_t>(outside_count_ - counts_since_anchor(t));
  }
  return count_at_phase(phase(t));
}

bool TimeBase::counting_up(Tick t) const {
  if (outside_ != Outside::no && mode_ != CountMode::stopped) {
    return outside_ == Outside::to_wrap;
  }
  return phase_is_up(phase(t));
}

/// Put the anchor at t with the given count; direction matters in up-down mode only.
void TimeBase::locate(std::uint16_t value, bool up, Tick t) {
  anchor_ = t;
  up_ = up;
  outside_ = Outside::no;
  outside_count_ = value;
  if (mode_ == CountMode::stopped) {
    anchor_phase_ = value;
    return;
  }
  if (value > period_) {
    const bool rising = mode_ == CountMode::up || (mode_ == CountMode::up_down && up);
    outside_ = rising ? Outside::to_wrap : Outside::to_period;
    return;
  }
  switch (mode_) {
    case CountMode::down:
      anchor_phase_ = value == 0 ? 0 : static_cast<std::int32_t>(period_) + 1 - value;
      break;
    case CountMode::up_down:
      // At zero the counter counts up and at the period down, whatever was asked for.
      anchor_phase_ = (value == 0 || (up && value < period_)) ? value : 2 * static_cast<std::int32_t>(period_) - value;
      break;
    default:
      anchor_phase_ = value;
      break;
  }
}

void TimeBase::settle(Tick t) {
  const std::uint16_t value = count(t);
  const bool up = counting_up(t);
  locate(value, up, last_edge(t));
}

void TimeBase::configure(CountMode mode, Tick clock_period, bool gate_open, Tick t) {
  const bool run = gate_open && mode != CountMode::stopped;
  if (mode == mode_ && clock_period == clock_period_ && run == running_) {
    return;
  }
  const std::uint16_t value = count(t);
  const bool up = counting_up(t);
  const bool starts = run && !running_;
  mode_ = mode;
  clock_period_ = clock_period;
  running_ = run;
  first_clock_ = starts || (first_clock_ && run);
  locate(value, up, t);
}

void TimeBase::write_count(std::uint16_t value, Tick t) {
  const bool up = counting_up(t);
  locate(value, up, last_edge(t));
  first_clock_ = false;
}

bool TimeBase::would_move(std::uint16_t value, bool up, Tick t) const {
  if (count(t) != value) {
    return true;
  }
  const bool at_turn = value == 0 || value == period_;
  return mode_ == CountMode::up_down && !at_turn && counting_up(t) != up;
}

bool TimeBase::load_phase(std::uint16_t value, bool up, Tick t) {
  if (!would_move(value, up, t)) {
    return false;
  }
  locate(value, up, last_edge(t));
  first_clock_ = true;
  return true;
}

void TimeBase::set_period(std::uint16_t value, Tick t) {
  if (value == period_) {
    return;
  }
  const std::uint16_t at = count(t);
  const bool up = counting_up(t);
  const Tick edge = last_edge(t);
  period_ = value;
  locate(at, up, edge);
}

void TimeBase::add_stop(std::int32_t p, unsigned event) { stops_[stop_count_++] = Stop{p, event}; }

void TimeBase::rebuild_stops() {
  stop_count_ = 0;
  const std::int32_t top = period_;
  const std::int32_t compare[2] = {compare_a_, compare_b_};
  if ((interest_ & kCountPeriod) != 0) {
    add_stop(mode_ == CountMode::down ? std::min(top, 1) : top, kCountPeriod);
  }
  for (int i = 0; i < 2; ++i) {
    const unsigned up_event = i == 0 ? kCountAUp : kCountBUp;
    const unsigned down_event = i == 0 ? kCountADown : kCountBDown;
    const std::int32_t limited = std::min(compare[i], top);
    const bool wants_up = (interest_ & up_event) != 0;
    const bool wants_down = (interest_ & down_event) != 0;
    if (mode_ == CountMode::up && wants_up && compare[i] <= top) {
      add_stop(compare[i], up_event);
    } else if (mode_ == CountMode::down && wants_down) {
      add_stop(limited == 0 ? 0 : top + 1 - limited, down_event);
    } else if (mode_ == CountMode::up_down) {
      if (wants_up) {
        add_stop(limited, up_event);
      }
      if (wants_down && limited != 0) {
        add_stop(2 * top - limited, down_event);
      }
    }
  }
}

Tick TimeBase::tick_of_next_stop() const {
  if (!running_) {
    return kNever;
  }
  if (first_clock_) {
    return anchor_;
  }
  std::int32_t distance = 0;
  if (outside_ == Outside::to_wrap) {
    distance = kFullScale - outside_count_;
  } else if (outside_ == Outside::to_period) {
    distance = outside_count_ - period_;
  } else if (period_ == 0) {
    return kNever;
  } else {
    std::int32_t nearest = length();
    for (int i = 0; i < stop_count_; ++i) {
      const std::int32_t p = stops_[i].phase;
      nearest = (p > anchor_phase_ && p < nearest) ? p : nearest;
    }
    distance = nearest - anchor_phase_;
  }
  return anchor_ + static_cast<Tick>(distance) * clock_period_;
}

void TimeBase::schedule(Tick t) {
  if (running_ && !first_clock_ && t != anchor_) {
    settle(t);  // stops between the old anchor and t are past, also those that moved there
  }
  rebuild_stops();
  next_stop_ = tick_of_next_stop();
}

void TimeBase::poke(Tick t) {
  if (running_ && period_ == 0 && outside_ == Outside::no && !first_clock_) {
    anchor_ = last_edge(t) + clock_period_;
    first_clock_ = true;
    next_stop_ = anchor_;
  }
}

unsigned TimeBase::take_stop(Tick t) {
  if (running_ && outside_ == Outside::no && !first_clock_ && period_ != 0) {
    return take_usual_stop(t);
  }
  if (outside_ == Outside::to_wrap && !first_clock_) {
    reached_max_ = true;
    locate(0, true, t);
  } else if (outside_ == Outside::to_period && !first_clock_) {
    locate(period_, false, t);
  } else if (outside_ == Outside::no) {
    anchor_phase_ = phase(t);
    anchor_ = t;
  }
  first_clock_ = false;
  unsigned events = 0;
  if (outside_ == Outside::no) {
    events = anchor_phase_ == 0 ? kCountZero : 0u;
    for (int i = 0; i < stop_count_; ++i) {
      events |= stops_[i].phase == anchor_phase_ ? stops_[i].event : 0u;
    }
  }
  next_stop_ = tick_of_next_stop();
  return events;
}

/// The counter runs between zero and its period: what happens here and where it stops next, in one pass.
unsigned TimeBase::take_usual_stop(Tick t) {
  const std::int32_t end = length();
  const std::int32_t reached = anchor_phase_ + counts_since_anchor(t);
  const std::int32_t here = reached >= end ? reached - end : reached;
  unsigned events = here == 0 ? kCountZero : 0u;
  std::int32_t nearest = end;
  for (int i = 0; i < stop_count_; ++i) {
    const std::int32_t p = stops_[i].phase;
    events |= p == here ? stops_[i].event : 0u;
    nearest = (p > here && p < nearest) ? p : nearest;
  }
  anchor_phase_ = here;
  anchor_ = t;
  next_stop_ = t + static_cast<Tick>(nearest - here) * clock_period_;
  return events;
}

}  // namespace stillspin::chip
