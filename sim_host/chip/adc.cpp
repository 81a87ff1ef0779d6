#include "sim_host/chip/adc.hpp"

#include <algorithm>
#include <iterator>

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

namespace {

constexpr int kSeq1 = 0;
constexpr int kSeq2 = 1;
constexpr int kNone = -1;
constexpr int kFullScaleCode = 4095;
constexpr int kCrosstalkDivisor = 256;

constexpr unsigned kFlag[2] = {ADCST_INT_SEQ1_MASK, ADCST_INT_SEQ2_MASK};
constexpr unsigned kInterruptEnable[2] = {ADCTRL2_INT_ENA_SEQ1_MASK, ADCTRL2_INT_ENA_SEQ2_MASK};
constexpr unsigned kInterruptMode[2] = {ADCTRL2_INT_MOD_SEQ1_MASK, ADCTRL2_INT_MOD_SEQ2_MASK};
constexpr unsigned kVector[2] = {VECTOR_SEQ1INT, VECTOR_SEQ2INT};
constexpr unsigned kPowerBits = ADCTRL3_ADCPWDN_MASK | ADCTRL3_ADCBGRFDN_MASK;

}  // namespace

bool Adc::cascaded() const { return bit_set(control1_, ADCTRL1_SEQ_CASC_MASK); }

bool Adc::powered(Tick t) const { return powered_since_ != kNever && t - powered_since_ >= kPowerUpTicks; }

Adc::Timing Adc::timing() const {
  const unsigned prescale = field(control3_, ADCTRL3_ADCCLKPS_MASK, ADCTRL3_ADCCLKPS_LSB);
  const unsigned divider = services_.hspclk_divider() * (prescale == 0 ? 1u : 2u * prescale) *
                           (bit_set(control1_, ADCTRL1_CPS_MASK) ? 2u : 1u);
  const Tick clock = services_.sysclk_period() * static_cast<Tick>(divider);
  const Tick acquisition = field(control1_, ADCTRL1_ACQ_PS_MASK, ADCTRL1_ACQ_PS_LSB);
  Timing out;
  out.simultaneous = bit_set(control3_, ADCTRL3_SMODE_SEL_MASK);
  out.trigger_to_hold = (5 * clock + 1) / 2 + (1 + acquisition) * clock;
  out.hold_to_hold = ((out.simultaneous ? 3 : 2) + acquisition) * clock;
  out.hold_to_a = 4 * clock;
  out.hold_to_b = 5 * clock;
  return out;
}

void Adc::reset(Tick) {
  for (int n = 0; n < 2; ++n) {
    sequencers_[n] = AdcSequencer{};
    sequencers_[n].first = 8 * n;
  }
  active_ = kNone;
  remaining_ = 0;
  all_held_ = false;
  next_event_ = kNever;
  drop_results();
  control1_ = control2_ = control3_ = 0;
  max_conversions_ = 0;
  std::fill(std::begin(channel_select_), std::end(channel_select_), std::uint16_t{0});
  std::fill(std::begin(results_), std::end(results_), std::uint16_t{0});
  interrupt_flags_ = 0;
  reference_ = 0;
  offset_trim_ = 0;
  powered_since_ = kNever;
}

// ---- triggers and arbitration ------------------------------------------------------------------------

void Adc::start_of_conversion(bool soca, Tick t) {
  if (soca) {
    if (bit_set(control2_, ADCTRL2_EPWM_SOCA_SEQ1_MASK)) {
      trigger(kSeq1, t);
    }
  } else if (cascaded()) {
    if (bit_set(control2_, ADCTRL2_EPWM_SOCB_SEQ_MASK)) {
      trigger(kSeq1, t);
    }
  } else if (bit_set(control2_, ADCTRL2_EPWM_SOCB_SEQ2_MASK)) {
    trigger(kSeq2, t);
  }
}

void Adc::trigger(int n, Tick t) {
  if (active_ == kNone) {
    start(n, t);
  } else if (sequencers_[n].waiting) {
    ++statistics_.lost_triggers;
  } else {
    sequencers_[n].waiting = true;
    ++statistics_.delayed_triggers;
  }
}

void Adc::start(int n, Tick t) {
  const unsigned max1 = field(max_conversions_, ADCMAXCONV_MAX_CONV1_MASK, ADCMAXCONV_MAX_CONV1_LSB);
  const unsigned max2 = field(max_conversions_, ADCMAXCONV_MAX_CONV2_MASK, ADCMAXCONV_MAX_CONV2_LSB);
  sequencers_[n].waiting = false;
  active_ = n;
  all_held_ = false;
  remaining_ = static_cast<int>(n == kSeq2 ? max2 : (cascaded() ? max1 : max1 & 7u));
  timing_ = timing();
  next_event_ = t + timing_.trigger_to_hold;
}

void Adc::start_waiting(Tick t) {
  if (sequencers_[kSeq1].waiting) {
    start(kSeq1, t);
  } else if (sequencers_[kSeq2].waiting && !cascaded()) {
    start(kSeq2, t);
  }
}

// ---- conversion --------------------------------------------------------------------------------------

std::uint16_t Adc::convert(int channel, Tick t) {
  const int code = services_.sample(channel, t);
  return static_cast<std::uint16_t>(powered(t) ? code : 0);
}

void Adc::queue_result(int index, int code, Tick ready) {
  // 9-bit two's complement offset, added before the result is stored.
  const int trim = (offset_trim_ & 0x0FF) - (offset_trim_ & 0x100);
  const int trimmed = std::min(std::max(code + trim, 0), kFullScaleCode);
  in_flight_[in_flight_end_++] =
      Conversion{ready, static_cast<std::uint16_t>(trimmed), static_cast<std::uint8_t>(index)};
}

/// Results that are ready at t become visible.
void Adc::store_results(Tick t) {
  for (; first_in_flight_ < in_flight_end_ && in_flight_[first_in_flight_].ready <= t; ++first_in_flight_) {
    results_[in_flight_[first_in_flight_].index] = in_flight_[first_in_flight_].code;
  }
  if (first_in_flight_ == in_flight_end_) {
    drop_results();
  } else {
    first_ready_ = in_flight_[first_in_flight_].ready;
  }
}

void Adc::drop_results() {
  first_in_flight_ = 0;
  in_flight_end_ = 0;
  first_ready_ = kNever;
}

void Adc::hold(Tick t) {
  AdcSequencer& seq = sequencers_[active_];
  const bool pair = timing_.simultaneous;
  if (in_flight_end_ + 2 > kMaxInFlight) {
    services_.model_error("more ADC conversions in one sequence than the sequencer has", in_flight_end_);
    return;
  }
  const auto conv = static_cast<unsigned>(seq.conv());
  const int channel = channel_select_[conv / 4] >> (4 * (conv % 4)) & (pair ? 0x7 : 0xF);
  const int result = seq.result(pair);
  if (in_flight_end_ == 0) first_ready_ = t + timing_.hold_to_a;
  const int a = convert(channel, t);
  queue_result(result, a, t + timing_.hold_to_a);
  if (pair) {
    const int b = convert(channel + 8, t);
    queue_result(result + 1, crosstalk_ ? std::min(b + a / kCrosstalkDivisor, kFullScaleCode) : b,
                 t + timing_.hold_to_b);
  }
  seq.advance(pair);
  if (remaining_ > 0) {
    --remaining_;
    next_event_ = t + timing_.hold_to_hold;
  } else {
    all_held_ = true;
    next_event_ = t + (pair ? timing_.hold_to_b : timing_.hold_to_a);
  }
}

void Adc::run_event(Tick t) {
  if (all_held_) {
    store_results(t);
    end_of_sequence(t);
  } else {
    hold(t);
  }
}

void Adc::end_of_sequence(Tick t) {
  const int n = active_;
  AdcSequencer& seq = sequencers_[n];
  ++statistics_.sequences;
  active_ = kNone;
  next_event_ = kNever;
  bool flag = true;
  if (bit_set(control2_, kInterruptMode[n])) {  // every other end of sequence
    flag = seq.end_toggle;
    seq.end_toggle = !seq.end_toggle;
  }
  if (flag) {
    set_interrupt_flag(n, t);
  }
  if (bit_set(control1_, ADCTRL1_CONT_RUN_MASK)) {
    if (!bit_set(control1_, ADCTRL1_SEQ_OVRD_MASK)) {
      seq.pointer = 0;
    }
    seq.waiting = true;
  }
  start_waiting(t);
}

/// A flag that is still set sends no second pulse.
void Adc::set_interrupt_flag(int n, Tick t) {
  const bool was_set = bit_set(interrupt_flags_, kFlag[n]);
  interrupt_flags_ = static_cast<std::uint16_t>(interrupt_flags_ | kFlag[n]);
  if (!was_set && bit_set(control2_, kInterruptEnable[n])) {
    services_.raise_interrupt(kVector[n], t);
    services_.raise_interrupt(VECTOR_ADCINT, t);
  }
}

void Adc::abort(int n, Tick t) {
  if (active_ != n) {
    return;
  }
  store_results(t);
  drop_results();
  active_ = kNone;
  next_event_ = kNever;
  ++statistics_.aborted;
}

void Adc::reset_sequencer(int n, Tick t) {
  sequencers_[n].pointer = 0;
  abort(n, t);
}

void Adc::clocks_changed(Tick t) {
  if (!services_.adc_clock()) {
    abort(kSeq1, t);
    abort(kSeq2, t);
  }
}

// ---- registers ---------------------------------------------------------------------------------------

void Adc::write_control1(std::uint16_t value, Tick t) {
  if (bit_set(value, ADCTRL1_RESET_MASK)) {
    abort(kSeq1, t);
    abort(kSeq2, t);
    reset(t);
    return;
  }
  const bool was_cascaded = cascaded();
  control1_ = static_cast<std::uint16_t>(value & 0x3FF0u);
  if (cascaded() != was_cascaded) {
    sequencers_[kSeq1].states = cascaded() ? 16 : 8;
    sequencers_[kSeq1].pointer = 0;
    sequencers_[kSeq2].pointer = 0;
  }
}

/// A 1 in SOC_SEQn triggers, a 0 withdraws a waiting trigger; RST_SEQn comes first.
void Adc::write_control2(std::uint16_t value, Tick t) {
  constexpr unsigned kSoc[2] = {ADCTRL2_SOC_SEQ1_MASK, ADCTRL2_SOC_SEQ2_MASK};
  constexpr unsigned kReset[2] = {ADCTRL2_RST_SEQ1_MASK, ADCTRL2_RST_SEQ2_MASK};
  control2_ = static_cast<std::uint16_t>(value & ~(kSoc[0] | kSoc[1] | kReset[0] | kReset[1]));
  for (int n = 0; n < 2; ++n) {
    if (bit_set(value, kReset[n])) {
      reset_sequencer(n, t);
    }
    if (!bit_set(value, kSoc[n])) {
      sequencers_[n].waiting = false;
    }
  }
  for (int n = 0; n < 2; ++n) {
    if (bit_set(value, kSoc[n]) && !sequencers_[n].waiting && !(n == kSeq2 && cascaded())) {
      trigger(n, t);
    }
  }
  if (active_ == kNone) {
    start_waiting(t);
  }
}

void Adc::write_control3(std::uint16_t value, Tick t) {
  const bool was_powered = (control3_ & kPowerBits) == kPowerBits;
  control3_ = static_cast<std::uint16_t>(value & 0x00FFu);
  const bool is_powered = (control3_ & kPowerBits) == kPowerBits;
  if (!is_powered) {
    powered_since_ = kNever;
  } else if (!was_powered) {
    powered_since_ = t;
  }
}

void Adc::write_status(std::uint16_t value) {
  for (int n = 0; n < 2; ++n) {
    const unsigned clear = n == kSeq1 ? ADCST_INT_SEQ1_CLR_MASK : ADCST_INT_SEQ2_CLR_MASK;
    if (bit_set(value, clear)) {
      interrupt_flags_ = static_cast<std::uint16_t>(interrupt_flags_ & ~kFlag[n]);
    }
  }
}

void Adc::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  const std::uint32_t address = REG_ADCTRL1 + offset;
  switch (address) {
    case REG_ADCTRL1:
      write_control1(value, t);
      break;
    case REG_ADCTRL2:
      write_control2(value, t);
      break;
    case REG_ADCMAXCONV:
      max_conversions_ = static_cast<std::uint16_t>(value & (ADCMAXCONV_MAX_CONV1_MASK | ADCMAXCONV_MAX_CONV2_MASK));
      break;
    case REG_ADCCHSELSEQ1:
    case REG_ADCCHSELSEQ2:
    case REG_ADCCHSELSEQ3:
    case REG_ADCCHSELSEQ4:
      channel_select_[address - REG_ADCCHSELSEQ1] = value;
      break;
    case REG_ADCTRL3:
      write_control3(value, t);
      break;
    case REG_ADCST:
      write_status(value);
      break;
    case REG_ADCREFSEL:
      reference_ = value;
      break;
    case REG_ADCOFFTRIM:
      offset_trim_ = static_cast<std::uint16_t>(value & ADCOFFTRIM_OFFSET_TRIM_MASK);
      break;
    default:
      break;
  }
}

std::uint16_t Adc::read_control2() const {
  return static_cast<std::uint16_t>(control2_ | (sequencers_[kSeq1].waiting ? ADCTRL2_SOC_SEQ1_MASK : 0u) |
                                    (sequencers_[kSeq2].waiting ? ADCTRL2_SOC_SEQ2_MASK : 0u));
}

std::uint16_t Adc::read_status() const {
  return static_cast<std::uint16_t>(interrupt_flags_ | (active_ == kSeq1 ? ADCST_SEQ1_BSY_MASK : 0u) |
                                    (active_ == kSeq2 ? ADCST_SEQ2_BSY_MASK : 0u) |
                                    (sequencers_[kSeq1].end_toggle ? ADCST_EOS_BUF1_MASK : 0u) |
                                    (sequencers_[kSeq2].end_toggle ? ADCST_EOS_BUF2_MASK : 0u));
}

std::uint16_t Adc::read_sequence_status() const {
  return static_cast<std::uint16_t>(sequencers_[kSeq1].pointer |
                                    (sequencers_[kSeq2].pointer << ADCASEQSR_SEQ2_STATE_LSB) |
                                    (remaining_ << ADCASEQSR_SEQ_CNTR_LSB));
}

std::uint16_t Adc::read(std::uint16_t offset, Tick t) {
  constexpr std::uint16_t kResult0 = static_cast<std::uint16_t>(REG_ADCRESULT0 - REG_ADCTRL1);
  constexpr int kLeftShift = 4;
  if (offset >= kAdcMirrorOffset && offset < kAdcMirrorOffset + 16) {
    return result(offset - kAdcMirrorOffset, t);
  }
  if (offset >= kResult0 && offset < kResult0 + 16) {
    return static_cast<std::uint16_t>(result(offset - kResult0, t) << kLeftShift);
  }
  const std::uint32_t address = REG_ADCTRL1 + offset;
  switch (address) {
    case REG_ADCTRL1:
      return control1_;
    case REG_ADCTRL2:
      return read_control2();
    case REG_ADCMAXCONV:
      return max_conversions_;
    case REG_ADCCHSELSEQ1:
    case REG_ADCCHSELSEQ2:
    case REG_ADCCHSELSEQ3:
    case REG_ADCCHSELSEQ4:
      return channel_select_[address - REG_ADCCHSELSEQ1];
    case REG_ADCASEQSR:
      return read_sequence_status();
    case REG_ADCTRL3:
      return control3_;
    case REG_ADCST:
      return read_status();
    case REG_ADCREFSEL:
      return reference_;
    case REG_ADCOFFTRIM:
      return offset_trim_;
    default:
      return 0;
  }
}

}  // namespace stillspin::chip
