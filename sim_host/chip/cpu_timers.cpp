#include "sim_host/chip/cpu_timers.hpp"

#include <algorithm>

#include "hal/f2808/registers.h"
#include "sim_host/chip/interrupts.hpp"

namespace stillspin::chip {
namespace {

constexpr std::uint16_t kTimerSpan = 8;  // words from one timer to the next
constexpr std::uint16_t kControlMask =
    CPUTIMER_TCR_FREE_MASK | CPUTIMER_TCR_SOFT_MASK | CPUTIMER_TCR_TIE_MASK | CPUTIMER_TCR_TSS_MASK;
constexpr std::array<unsigned, 3> kVectors = {VECTOR_TINT0, Interrupts::kVectorInt13, VECTOR_TINT2};

std::uint32_t with_low(std::uint32_t word, std::uint16_t low) { return (word & 0xFFFF0000u) | low; }
std::uint32_t with_high(std::uint32_t word, std::uint16_t high) {
  return (word & 0xFFFFu) | static_cast<std::uint32_t>(high) << 16;
}
std::uint16_t low_of(std::uint32_t word) { return static_cast<std::uint16_t>(word & 0xFFFFu); }
std::uint16_t high_of(std::uint32_t word) { return static_cast<std::uint16_t>(word >> 16); }
// The prescaler registers interleave two bytes: TPR holds the low bytes of PSC and TDDR, TPRH the high ones.
std::uint16_t byte_pair(std::uint32_t psc, std::uint32_t tddr, unsigned shift) {
  return static_cast<std::uint16_t>(((psc >> shift) & 0xFFu) << 8 | ((tddr >> shift) & 0xFFu));
}

}  // namespace

bool CpuTimers::Timer::running() const { return (control & CPUTIMER_TCR_TSS_MASK) == 0; }

std::int64_t CpuTimers::Timer::counted(Tick t, Tick clock) const {
  if (!running()) return cycles;
  const std::int64_t elapsed = clock == 1 ? t - since : (t - since) / clock;  // 100 MHz spares the division
  if (elapsed <= cycles) return cycles - elapsed;
  const std::int64_t span = wrap();
  return span - 1 - (elapsed - cycles - 1) % span;
}

std::uint32_t CpuTimers::Timer::count(Tick t, Tick clock) const {
  const std::int64_t left = counted(t, clock);
  return static_cast<std::uint32_t>(prescale == 0 ? left : left / (std::int64_t{prescale} + 1));
}

std::uint32_t CpuTimers::Timer::psc(Tick t, Tick clock) const {
  return static_cast<std::uint32_t>(counted(t, clock) % (std::int64_t{prescale} + 1));
}

void CpuTimers::Timer::settle(Tick t, Tick clock) {
  // Whole cycles only: the rest of a started cycle is not lost while the clock stays the same.
  const Tick rest = running() ? (t - since) % clock : 0;
  cycles = counted(t, clock);
  since = t - rest;
}

void CpuTimers::Timer::load(std::uint32_t tim, std::uint32_t psc) {
  cycles = std::int64_t{tim} * (std::int64_t{prescale} + 1) + std::min(psc, prescale);
}

void CpuTimers::Timer::plan(Tick clock) {
  const bool matters = !flag || (control & CPUTIMER_TCR_TIE_MASK) != 0;
  if (!running() || !matters) {
    zero = kNever;
    return;
  }
  const std::int64_t to_zero = cycles > prescale ? cycles - prescale : cycles + wrap() - prescale;
  zero = since + to_zero * clock;
}

void CpuTimers::replan(Timer& timer) {
  timer.plan(clock_);
  next_event_ = std::min({timers_[0].zero, timers_[1].zero, timers_[2].zero});
}

void CpuTimers::reset(Tick t) {
  clock_ = services_.sysclk_period();
  for (Timer& timer : timers_) {
    timer = Timer{};
    timer.since = t;
    replan(timer);
  }
}

void CpuTimers::run_event(Tick t) {
  for (unsigned i = 0; i < timers_.size(); ++i) {
    Timer& timer = timers_[i];
    if (timer.zero > t) continue;
    timer.settle(t, clock_);
    timer.flag = true;
    if ((timer.control & CPUTIMER_TCR_TIE_MASK) != 0) services_.raise_interrupt(kVectors[i], t);
    replan(timer);
  }
}

void CpuTimers::clocks_changed(Tick t) {
  for (Timer& timer : timers_) {
    timer.settle(t, clock_);
    timer.since = t;
  }
  clock_ = services_.sysclk_period();
  for (Timer& timer : timers_) replan(timer);
}

std::uint16_t CpuTimers::read(std::uint16_t offset, Tick t) {
  if (offset >= kTimerSpan * timers_.size()) return 0;
  const Timer& timer = timers_[offset / kTimerSpan];
  switch (offset % kTimerSpan) {
    case CPUTIMER_TIM_LSW:
      return low_of(timer.count(t, clock_));
    case CPUTIMER_TIM_MSW:
      return high_of(timer.count(t, clock_));
    case CPUTIMER_PRD_LSW:
      return low_of(timer.period);
    case CPUTIMER_PRD_MSW:
      return high_of(timer.period);
    case CPUTIMER_TCR:
      return static_cast<std::uint16_t>(timer.control | (timer.flag ? CPUTIMER_TCR_TIF_MASK : 0));
    case CPUTIMER_TPR:
      return byte_pair(timer.psc(t, clock_), timer.prescale, 0);
    case CPUTIMER_TPRH:
      return byte_pair(timer.psc(t, clock_), timer.prescale, 8);
    default:
      return 0;
  }
}

void CpuTimers::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  if (offset >= kTimerSpan * timers_.size()) return;
  Timer& timer = timers_[offset / kTimerSpan];
  timer.settle(t, clock_);
  write_register(timer, offset % kTimerSpan, value);
  replan(timer);
}

void CpuTimers::write_register(Timer& timer, std::uint16_t reg, std::uint16_t value) {
  const std::int64_t divider = std::int64_t{timer.prescale} + 1;
  const auto tim = static_cast<std::uint32_t>(timer.cycles / divider);
  const auto psc = static_cast<std::uint32_t>(timer.cycles % divider);
  switch (reg) {
    case CPUTIMER_TIM_LSW:
      timer.load(with_low(tim, value), psc);
      break;
    case CPUTIMER_TIM_MSW:
      timer.load(with_high(tim, value), psc);
      break;
    case CPUTIMER_PRD_LSW:
      timer.period = with_low(timer.period, value);
      break;
    case CPUTIMER_PRD_MSW:
      timer.period = with_high(timer.period, value);
      break;
    case CPUTIMER_TCR:
      write_control(timer, value);
      break;
    case CPUTIMER_TPR:
      timer.prescale = (timer.prescale & 0xFF00u) | (value & CPUTIMER_TPR_TDDR_MASK);
      timer.load(tim, psc);
      break;
    case CPUTIMER_TPRH:
      timer.prescale = (timer.prescale & 0x00FFu) | static_cast<std::uint32_t>(value & CPUTIMER_TPRH_TDDRH_MASK) << 8;
      timer.load(tim, psc);
      break;
    default:
      break;
  }
}

void CpuTimers::write_control(Timer& timer, std::uint16_t value) {
  if ((value & CPUTIMER_TCR_TIF_MASK) != 0) timer.flag = false;  // write 1 clears
  timer.control = static_cast<std::uint16_t>(value & kControlMask);
  if ((value & CPUTIMER_TCR_TRB_MASK) != 0) timer.load(timer.period, timer.prescale);
}

}  // namespace stillspin::chip
