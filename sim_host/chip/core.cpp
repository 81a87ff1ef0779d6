#include "sim_host/chip/core.hpp"

#include <algorithm>
#include <stdexcept>

namespace stillspin::chip {
namespace {

// A watchdog reset holds the chip for this long; the pins are low meanwhile.
constexpr Tick kResetPulse = 512 * kOscillatorPeriod;

class CurrentScope {
 public:
  explicit CurrentScope(Core* core) : previous_(Core::set_current(core)) {}
  ~CurrentScope() { Core::set_current(previous_); }
  CurrentScope(const CurrentScope&) = delete;
  CurrentScope& operator=(const CurrentScope&) = delete;

 private:
  Core* previous_;
};

}  // namespace

Core::Core(World& world, Chip::Firmware firmware)
    : world_(world),
      firmware_(firmware),
      system_(*this),
      watchdog_(*this),
      timers_(*this),
      gpio_(world),
      epwm_(*this),
      adc_(*this),
      eqep1_(*this, 1),
      sci_(*this),
      i2c_(*this),
      ecan_(*this, world.can_line()) {
  due_.fill(kNever);
  reset(0, false);
}

// ---- life cycle -------------------------------------------------------------------------------------

void Core::reset(Tick t, bool by_watchdog) {
  release_ = by_watchdog ? t + kResetPulse : t;
  interrupts_.reset();
  eallow_ = idle_ = stop_ = reset_requested_ = false;
  depth_ = 0;
  failure_ = Failure::kNone;
  flash_.reset();
  memory_.reset();
  system_.reset();
  period_ = system_.sysclk_period();
  gpio_.reset(t);
  reset_peripherals(t);
  watchdog_.reset(release_, by_watchdog);
  due_[kSystem] = system_.next_event();
  due_[kEPwm] = epwm_.next_event();
  due_[kAdc] = adc_.next_event();
  due_[kEQep1] = eqep1_.next_event();
  due_[kSci] = sci_.next_event();
  due_[kI2c] = i2c_.next_event();
  due_[kECanA] = ecan_.next_event();
  due_[kTimers] = timers_.next_event();
  due_[kWatchdog] = watchdog_.next_event();
  find_rest();
  find_next();
  coroutine_.prepare(&Core::firmware_entry, this);
}

void Core::reset_peripherals(Tick t) {
  epwm_.reset(t);
  epwm_.set_time_base_clock(false, t);
  epwm_.set_trip_pins(trips_ = 0, t);
  adc_.reset(t);
  eqep1_.reset(t);
  sci_.reset(t);
  i2c_.reset(t);
  ecan_.reset(t);
  ecan_.set_routed(false, t);
  timers_.reset(release_);
}

void Core::firmware_entry(void* core) {
  auto& self = *static_cast<Core*>(core);
  if (self.release_ > self.now_) self.advance(self.release_);
  self.firmware_();
  self.model_error("the firmware returned from its entry function, at tick", self.now_);
  self.leave_firmware();
}

void Core::run_until(Tick t) {
  if (t < now_) throw std::invalid_argument("run_until: the chip is already past that tick");
  check_outcome();
  limit_ = t;
  due_[kWorldCall] = world_.next_call();
  due_[kECanA] = ecan_.next_event();
  find_rest();
  find_next();
  const CurrentScope scope(this);
  look_at_pins();  // the host may have written on the serial line
  resume_firmware();
}

void Core::resume_firmware() {
  for (;;) {
    coroutine_.resume();
    check_outcome();
    if (!reset_requested_) return;
    ++statistics_.resets;
    reset(now_, true);
    if (world_touched_) after_world();
    check_outcome();
  }
}

Statistics Core::statistics() const {
  Statistics statistics = statistics_;
  statistics.conversions = adc_.statistics().sequences;
  statistics.conversions_delayed = adc_.statistics().delayed_triggers;
  statistics.conversions_lost = adc_.statistics().lost_triggers;
  statistics.conversions_aborted = adc_.statistics().aborted;
  statistics.narrow_can_accesses = ecan_.narrow_accesses();
  return statistics;
}

void Core::check_outcome() {
  if (exception_) std::rethrow_exception(exception_);
  if (!error_.empty()) throw std::runtime_error(error_);
}

void Core::leave_firmware() {
  for (;;) coroutine_.suspend();  // never resumed: discarded by a reset, or dead after an error
}

void Core::request_reset() { stop_ = reset_requested_ = true; }

void Core::model_error(const char* text, std::int64_t value) {
  stop_ = true;
  if (!error_.empty()) return;  // the first one is the cause
  error_ = "virtual F2808, tick " + std::to_string(now_) + ": " + text + " (" + std::to_string(value) + ")";
}

void Core::fail_with_current_exception() {
  stop_ = true;
  exception_ = std::current_exception();
  error_ = "virtual F2808, tick " + std::to_string(now_) +
           ": what stands for the world outside of the chip threw an exception";
}

// ---- time and events ----------------------------------------------------------------------------------

void Core::find_rest() {
  rest_source_ = kWorldCall;
  for (const Source source : {kSystem, kEQep1, kSci, kI2c, kECanA, kTimers, kWatchdog}) {
    if (due_[source] < due_[rest_source_]) rest_source_ = source;
  }
}

// Lets time pass to `target` with everything that is due at or before it; stops for the host at the end of the run.
void Core::advance(Tick target) {
  for (;;) {
    const Tick stop = std::min(target, limit_);
    run_events(stop, [] { return false; });
    if (stop_) leave_firmware();
    now_ = stop;
    if (stop == target) return;
    coroutine_.suspend();
  }
}

// Lets time pass to `target`, or to the tick after which an enabled interrupt is requested (`taken`: can be taken). May
// return earlier, after a stop: the host may have changed the world, so the caller looks again.
void Core::wait_for_interrupt(Tick target, bool taken) {
  const Tick goal = std::min(target, limit_);
  const bool awake = run_events(goal, [&] { return taken ? interrupts_.deliverable() : interrupts_.requested(); });
  if (stop_) leave_firmware();
  if (awake) return;
  now_ = goal;
  if (goal < target) coroutine_.suspend();
}

// Everything that is due up to `last`; true when `wake` said between two ticks that something else comes first.
template <typename Wake>
bool Core::run_events(Tick last, Wake wake) {
  try {
    while (!stop_) {
      if (next_event_ > now_) {
        if (wake()) return true;
        if (next_event_ > last) return false;
        now_ = next_event_;
      }
      ++statistics_.events;
      run_event(next_source_);
      if (world_touched_) after_world();
    }
  } catch (...) {
    fail_with_current_exception();
  }
  return false;
}

void Core::run_event(Source source) {
  switch (source) {
    case kWorldCall:
      run_world();
      break;
    case kSystem:
      apply(system_.run_event());
      break;
    case kEPwm:
      epwm_.run_event(now_);
      set_due(kEPwm, epwm_.next_event());
      break;
    case kAdc:
      adc_.run_event(now_);
      set_due(kAdc, adc_.next_event());
      break;
    case kEQep1:
      eqep1_.run_event(now_);
      set_due(kEQep1, eqep1_.next_event());
      break;
    case kSci:
      sci_.run_event(now_);
      set_due(kSci, sci_.next_event());
      break;
    case kI2c:
      i2c_.run_event(now_);
      set_due(kI2c, i2c_.next_event());
      break;
    case kECanA:
      ecan_.run_event(now_);
      world_touched_ = true;
      break;
    case kTimers:
      timers_.run_event(now_);
      set_due(kTimers, timers_.next_event());
      break;
    case kWatchdog:
      run_watchdog();
      break;
    case kSources:
      break;
  }
}

void Core::run_world() {
  world_.call(now_);
  world_touched_ = true;
  pins_dirty_ = true;
}

void Core::run_watchdog() {
  if (watchdog_.run_event(now_) == Watchdog::Outcome::kReset) request_reset();
  set_due(kWatchdog, watchdog_.next_event());
}

void Core::after_world() {
  world_touched_ = false;
  set_due(kWorldCall, world_.next_call());
  set_due(kECanA, ecan_.next_event());  // the bus is part of the world
  if (pins_dirty_) look_at_pins();
}

void Core::look_at_pins() {
  update_trips();
  sci_.line_changed(now_);
  set_due(kSci, sci_.next_event());
}

void Core::update_trips() {
  pins_dirty_ = false;
  unsigned active = gpio_.trips_routed() ? gpio_.active_trips(now_) : 0;
  if (recording_ != nullptr) active = static_cast<unsigned>(recording_->look(Recording::kTrips, active));
  if (active == trips_) return;
  trips_ = active;
  epwm_.set_trip_pins(active, now_);
  set_due(kEPwm, epwm_.next_event());
}

// Clocks or the time-base gate changed: every counter goes on with its new clock.
void Core::apply(unsigned effects) {
  if ((effects & SystemControl::kClocks) != 0) {
    period_ = system_.sysclk_period();
    epwm_.clocks_changed(now_);
    adc_.clocks_changed(now_);
    eqep1_.clocks_changed(now_);
    sci_.clocks_changed(now_);
    i2c_.clocks_changed(now_);
    ecan_.clocks_changed(now_);
    timers_.clocks_changed(now_);
    check_flash_waits();
  }
  if ((effects & SystemControl::kTimeBase) != 0) epwm_.set_time_base_clock(system_.time_base_clock(), now_);
  due_[kEPwm] = epwm_.next_event();
  due_[kAdc] = adc_.next_event();
  due_[kEQep1] = eqep1_.next_event();
  due_[kSci] = sci_.next_event();
  due_[kI2c] = i2c_.next_event();
  due_[kECanA] = ecan_.next_event();
  due_[kTimers] = timers_.next_event();
  due_[kSystem] = system_.next_event();
  find_rest();
  find_next();
}

void Core::stop_can_transmission() {
  ecan_.stop_transmission(now_);
  set_due(kECanA, ecan_.next_event());
}

void Core::check_flash_waits() {
  if (!flash_.waits_suffice(period_)) {
    model_error("flash wait states too few for this SYSCLKOUT: FBANKWAIT", flash_.bank_wait());
  }
}

// ---- services -----------------------------------------------------------------------------------------

void Core::raise_interrupt(unsigned vector, Tick) {
  if (!interrupts_.raise(vector)) model_error("a peripheral raised a vector that has no line", vector);
}

void Core::start_of_conversion(bool soca, Tick t) {
  if (!system_.adc_clock() || adc_blocked_) return;
  adc_.start_of_conversion(soca, t);
  set_due(kAdc, adc_.next_event());
}

void Core::pwm_outputs(int module, bool a, bool b, Tick t) {
  gpio_.pwm_outputs(module, a, b, t);
  world_touched_ = true;
}

std::uint16_t Core::sample(int channel, Tick t) {
  world_touched_ = true;
  const std::uint16_t seen = world_.adc_sample(t, channel);
  return recording_ != nullptr ? recording_->sample(seen) : seen;
}

Tick Core::serial_reaches(Tick t, bool level) {
  if (!gpio_.serial_in_routed()) return level ? t : kNever;
  return world_.serial_reaches(t, level);
}

void Core::serial_frame(const SerialFrame& frame, Tick t) {
  if (!gpio_.serial_out_routed()) return;
  world_.on_serial_frame(t, frame);
  world_touched_ = true;
}

void Core::i2c_pins(bool sda, bool scl, Tick t) {
  gpio_.i2c_outputs(sda, scl, t);
  world_touched_ = true;
}

std::int64_t Core::encoder_edges(Tick t) {
  if (gpio_.encoder_routed()) encoder_held_ = world_.encoder_edges(t);
  if (recording_ != nullptr) encoder_held_ = recording_->look(Recording::kEncoder, encoder_held_);
  return encoder_held_;
}

}  // namespace stillspin::chip
