#include "sim_host/bench/board.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "hal/f2808/registers.h"
#include "hal/hal_board.h"

namespace stillspin::bench {
namespace {

// ADC channels: 0..7 are ADCINA0..7, 8..15 are ADCINB0..7.
constexpr int kChannelsB = 8;
constexpr int kChannelCurrentA = BOARD_ADC_CURRENTS;
constexpr int kChannelLink = BOARD_ADC_SLOW;
constexpr int kChannelCurrentB = kChannelsB + BOARD_ADC_CURRENTS;
constexpr int kChannelAuxiliary = kChannelsB + BOARD_ADC_SLOW;

constexpr double kComparatorShare = BOARD_COMPARATOR_PERCENT / 100.0;
constexpr int kFirstLeg = BOARD_FIRST_LEG_MODULE - 1;  // counted from 0
constexpr bool kOn = BOARD_GATE_ON_LEVEL != 0;

std::uint16_t code_of(double code) { return static_cast<std::uint16_t>(std::clamp(code + 0.5, 0.0, 4095.0)); }

constexpr std::uint64_t kTimedEvery = 64;

std::int64_t now_ns() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace

const Tick kEnableTimeout = 100 * Tick{BOARD_ENABLE_TIME_US};
const int kPinEnable = BOARD_PIN_GATE_ENABLE;

// Books the time of a plant call, in the periods that are timed.
class Board::PlantTimer {
 public:
  explicit PlantTimer(Board& board) : board_(board), begin_(board.timing_ ? now_ns() : 0) {}
  ~PlantTimer() {
    if (board_.timing_) board_.plant_ns_ += now_ns() - begin_;
  }
  PlantTimer(const PlantTimer&) = delete;
  PlantTimer& operator=(const PlantTimer&) = delete;

 private:
  Board& board_;
  std::int64_t begin_;
};

void Board::time_periods() {
  if (timing_) period_ns_ += now_ns() - period_begin_ns_;
  timing_ = ++periods_ % kTimedEvery == 0;
  if (timing_) period_begin_ns_ = now_ns();
}

Board::Board(const plant::PlantConfig& config, PeriodListener& listener, devices::CanBus* can)
    : comparator_amps_(kComparatorShare * config.adc.current_range),
      revision_(static_cast<std::uint16_t>(config.adc.revision)),
      plant_(config),
      listener_(listener),
      can_(can),
      last_toggle_(-kEnableTimeout) {}

void Board::attach(chip::Chip& chip) {
  chip.set_revision(revision_);
  chip_ = &chip;
}

void Board::equip(const BoardOptions& options) {
  options_ = options;
  enabled_ = options.enable_stuck;
  if (options.precharge_resistance > 0.0) plant_.set_precharge(options.precharge_resistance);
}

void Board::set_inputs(const BoardInputs& inputs) {
  inputs_ = inputs;
  chip_->pins_changed();
}

std::uint64_t Board::lockouts() const {
  std::uint64_t sum = 0;
  for (const devices::Bootstrap& supply : bootstrap_) sum += supply.lockouts();
  return sum;
}

// The NTC's divider, by the law from which the firmware's table is made.
std::uint16_t Board::auxiliary_code(Tick t) {
  constexpr double kKelvin = 273.15;
  if (inputs_.heat_sink < -kKelvin) return plant_.adc_code(t, plant::AdcInput::kTemperature);
  const double inverse = 1.0 / (inputs_.heat_sink + kKelvin) - 1.0 / (25.0 + kKelvin);
  const double ohms = BOARD_NTC_R25 * std::exp(BOARD_NTC_BETA * inverse);
  return code_of(4096.0 * ohms / (ohms + BOARD_NTC_PULL_UP));
}

// The motor's phase that hangs on a leg.
int Board::wire_of(int leg) const {
  const int straight = options_.crossed - 1;
  return options_.crossed == 0 || leg == straight ? leg : 3 - straight - leg;
}

std::uint16_t Board::current_code(Tick t, std::size_t input) {
  constexpr plant::AdcInput kPhases[] = {plant::AdcInput::kCurrentA, plant::AdcInput::kCurrentB,
                                         plant::AdcInput::kCurrentC};
  return plant_.adc_code(t, kPhases[wire_of(options_.input[input])]);
}

void Board::drive_leg(Tick t, int leg) {
  const PlantTimer timer(*this);
  const bool lower = enabled_ && lower_[leg];
  bool upper = enabled_ && upper_[leg];
  if (options_.bootstrap) upper = bootstrap_[static_cast<std::size_t>(leg)].switch_leg(t, upper, lower);
  plant_.set_gate(t, wire_of(leg), upper, lower);
  compare(t, plant_.peak_current());
  watch_devices(t);
}

void Board::watch_devices(Tick t) {
  bool on = false;
  for (int leg = 0; leg < 3; leg++) on = on || (enabled_ && (upper_[leg] || lower_[leg]));
  if (device_on_ && !on) devices_off_since_ = t;
  device_on_ = on;
}

void Board::on_pwm_pins(Tick t, int module, bool a, bool b) {
  const int leg = module - kFirstLeg;
  if (leg < 0 || leg > 2) return;
  const bool upper = a == kOn, lower = b == kOn;
  upper_[leg] = upper;
  lower_[leg] = lower;
  const std::uint64_t edge =
      static_cast<std::uint64_t>(t) << 4 | unsigned(leg) << 2 | unsigned(upper) << 1 | unsigned(lower);
  gate_edges_ = (gate_edges_ ^ edge) * 0x100000001B3u;
  probe_.edge(t, leg, upper, lower);
  drive_leg(t, leg);
}

bool Board::pwm_pins_pulled_up() const { return !kOn; }

std::uint16_t Board::adc_sample(Tick t, int channel) {
  const PlantTimer timer(*this);
  compare(t, plant_.peak_current());
  switch (channel) {
    case kChannelCurrentA:
      probe_.sample(t);
      return current_code(t, 0);
    case kChannelCurrentB:
      return current_code(t, 1);
    case kChannelLink:
      return plant_.adc_code(t, plant::AdcInput::kLinkVoltage);
    case kChannelAuxiliary:
      return auxiliary_code(t);
    case BOARD_ADC_SPEED:
      return plant_.adc_code(t, plant::AdcInput::kLinkVoltage);
    case kChannelsB + BOARD_ADC_SPEED:
      return code_of(4096.0 / 3.0 * inputs_.speed_volts);
    case kChannelsB + BOARD_ADC_REFERENCE:
      return code_of(BOARD_REFERENCE_CODE + inputs_.reference_codes);
    default:
      return 0;
  }
}

// The comparator sees the true current at the end of every step of the plant: edges, zero crossings, and four times a
// period at least.
void Board::trip(Tick t) {
  (void)plant_.take_peak_current(t);
  if (t >= tripped_until_) trips_++;
  tripped_until_ = t + kComparatorHold;
  chip_->pins_changed();
}

bool Board::pin_level(Tick t, int pin) {
  switch (pin) {
    case BOARD_PIN_OVER_CURRENT:
      return t >= tripped_until_;
    case BOARD_PIN_EMERGENCY:
      return !inputs_.emergency;
    case BOARD_PIN_RUN:
      return !inputs_.run;
    case BOARD_PIN_GATE_FEEDBACK:
      return enabled_;
    case BOARD_PIN_SERIAL_IN:
      return serial_.level(t);
    case BOARD_PIN_SDA:
      return sda_ && (eeprom_ == nullptr || eeprom_->lets_sda_go());
    case BOARD_PIN_SCL:
      return scl_;
    default:
      return true;
  }
}

void Board::on_i2c_pins(Tick t, bool sda, bool scl) {
  sda_ = sda;
  scl_ = scl;
  if (eeprom_ != nullptr) eeprom_->drive(t, sda, scl);
}

void Board::on_output_pin(Tick t, int pin, bool level) {
  if (pin == BOARD_PIN_RELAY && options_.precharge_resistance > 0.0) {
    relay_ = level == (BOARD_RELAY_ON_LEVEL != 0);
    plant_.advance(t);
    plant_.set_precharge(relay_ ? 0.0 : options_.precharge_resistance);
  } else if (pin == BOARD_PIN_BRAKE && options_.brake) {
    brake_ = level == (BOARD_BRAKE_ON_LEVEL != 0);
    plant_.advance(t);
    plant_.set_brake(brake_);
  }
  if (pin != kPinEnable) return;
  last_toggle_ = t;
  if (aligned_) {
    const Tick phase = t - (next_period_ - kPeriod);
    enable_earliest_ = std::min(enable_earliest_, phase);
    enable_latest_ = std::max(enable_latest_, phase);
  }
  watch_enable(t);
}

void Board::watch_enable(Tick t) {
  const bool alive = options_.enable_stuck || t - last_toggle_ < kEnableTimeout;
  if (alive == enabled_) return;
  enabled_ = alive;
  for (int leg = 0; leg < 3; leg++) drive_leg(t, leg);
}

std::int64_t Board::encoder_edges(Tick t) { return plant_.encoder_count(t); }

// Puts the calls on the starts of ePWM1's periods, as soon as its counter runs.
void Board::align(Tick t) {
  const bool running = (chip_->inspect(REG_PCLKCR0) & PCLKCR0_TBCLKSYNC_MASK) != 0;
  const Tick counter = chip_->inspect(EPWM_BASE(1) + EPWM_TBCTR);
  next_period_ = next_call_ = t + kPeriod - (running ? counter : 0);
  aligned_ = running;
}

void Board::call(Tick t) {
  if (can_ != nullptr && t >= can_->next_event()) can_->run_event(t);  // nothing of the plant's concern
  if (t >= next_call_) look(t);
  // Behind the listener, which may arm the probe for this very tick.
  if (t >= probe_.next()) probe_.look(t, plant_, upper_, lower_);
}

void Board::look(Tick t) {
  compare(t, plant_.take_peak_current(t));
  if (t < next_period_) {
    call_between(t);
  } else {
    watch_enable(t);
    begin_period(t);
  }
}

void Board::begin_period(Tick t) {
  if (!aligned_) {
    align(t);
    return;
  }
  next_period_ = t + kPeriod;
  if (interrupt_delay_ > 0) chip_->hold_interrupts(true);
  release_ = t + interrupt_delay_;
  call_between(t);
  time_periods();
  listener_.on_period(t);
}

// Looks at the current when nothing else does, and lets a held interrupt go.
void Board::call_between(Tick t) {
  if (release_ <= t) chip_->hold_interrupts(false);
  next_call_ = std::min(t + kWatch, next_period_);
  if (release_ > t) next_call_ = std::min(next_call_, release_);
}

}  // namespace stillspin::bench
