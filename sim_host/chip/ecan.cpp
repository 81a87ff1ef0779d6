// eCAN: configuration, error states, and the way between mailboxes and bus. Registers are in ecan_registers.cpp.

#include "sim_host/chip/ecan.hpp"

#include <algorithm>

namespace stillspin::chip {
namespace {

constexpr unsigned kMailboxes = ECAN_MAILBOXES;
constexpr unsigned kRecoverySequences = 128;
constexpr Tick kSequenceBits = 11;
// With nothing at the pins the first dominant bit reads back recessive: an error flag of a few bits, then again.
constexpr Tick kDeadLineBits = 20;

bool has(std::uint32_t word, unsigned n) { return (word >> n & 1u) != 0; }

}  // namespace

ECan::~ECan() {
  if (attached_) line_->detach(*this);
}

void ECan::reset(Tick t) {
  if (line_ != nullptr && !attached_) {
    line_->attach(*this, t);
    attached_ = true;
  }
  // What the manual calls undefined after reset shall look undefined.
  mailbox_.fill({0x5A5A5A5A, 0x5A5A5A5A, 0x5A5A5A5A, 0x5A5A5A5A});
  mask_.fill(0x5A5A5A5A);
  stopped_ = false;
  soft_reset(t);
}

void ECan::soft_reset(Tick t) {
  const bool was_active = active_;
  control_.fill(0);
  control(REG_CANMC) = CANMC_CCR_MASK;
  flags_[0] = flags_[1] = 0;
  errors_.clear();
  mode_ = Mode::kConfigured;
  active_ = bus_off_ = false;
  sequences_ = 0;
  sending_ = -1;
  bit_time_ = 0;
  stamp_base_ = 0;
  stamp_anchor_ = t;
  schedule(t);
  if (was_active) announce(t);
}

void ECan::announce(Tick t) {
  if (attached_) line_->changed(*this, t);
}

void ECan::set_routed(bool routed, Tick t) {
  if (routed == routed_) return;
  routed_ = routed;
  if (active_) {
    set_active(false, t);
    mode_ = Mode::kEntering;
    start_waiting(1, t);
  }
  steer(t);
}

void ECan::clocks_changed(Tick t) {
  if (bit_time_ == 0) return;
  stamp_base_ = time_stamp(t);
  stamp_anchor_ = t;
  write_timing(control(REG_CANBTC), t);
}

void ECan::stop_transmission(Tick t) {
  stopped_ = true;
  announce(t);
  schedule(t);
}

// ---- configuration, bus-on, bus-off --------------------------------------------------------------------

void ECan::steer(Tick t) {
  const bool wanted = (control(REG_CANMC) & CANMC_CCR_MASK) != 0;
  const bool recessive = !connected() || quiet_;
  if (wanted && mode_ != Mode::kConfigured && recessive && sending_ < 0) enter_configuration(t);
  if (!wanted && mode_ == Mode::kConfigured && control(REG_CANBTC) != 0) leave_configuration(t);
  schedule(t);
}

void ECan::enter_configuration(Tick t) {
  stamp_base_ = time_stamp(t);
  stamp_anchor_ = t;
  mode_ = Mode::kConfigured;
  stopped_ = false;
  if (!bus_off_) {
    sequences_ = 0;
    errors_.clear();
  }
  set_active(false, t);
}

void ECan::leave_configuration(Tick t) {
  if ((control(REG_CANMC) & CANMC_SCB_MASK) == 0) {
    services_.model_error("eCAN started with CANMC.SCB = 0: the 16-mailbox mode is not modelled", 0);
    return;
  }
  stamp_anchor_ = t;
  mode_ = Mode::kEntering;
  if (!bus_off_ || sequences_ == 0) start_waiting(1, t);
}

void ECan::start_waiting(unsigned sequences, Tick t) {
  sequences_ = sequences;
  if (!connected() || quiet_) {
    quiet_since_ = t;
    counted_ = 0;
  }
  schedule(t);
}

// Recessive sequences of the present quiet time that have not been counted yet.
void ECan::count_quiet(Tick t) {
  if (sequences_ == 0 || bit_time_ == 0 || (connected() && !quiet_)) return;
  const auto seen = static_cast<unsigned>((t - quiet_since_) / (kSequenceBits * bit_time_));
  const unsigned fresh = std::min(seen - std::min(seen, counted_), sequences_);
  counted_ = seen;
  sequences_ -= fresh;
}

void ECan::schedule(Tick t) {
  next_event_ = kNever;
  if (bit_time_ == 0) return;
  if (sequences_ > 0 && (!connected() || quiet_)) {
    count_quiet(t);
    next_event_ = std::max(t, quiet_since_ + (counted_ + sequences_) * kSequenceBits * bit_time_);
  } else if (sequences_ == 0 && mode_ == Mode::kEntering) {
    next_event_ = t;
  } else if (active_ && !connected() && next_to_send() >= 0) {
    if (dead_attempt_ <= t) dead_attempt_ = t + kDeadLineBits * bit_time_;
    next_event_ = dead_attempt_;
  }
}

void ECan::run_event(Tick t) {
  count_quiet(t);
  if (sequences_ == 0 && mode_ == Mode::kEntering) {
    become_active(t);
  } else if (active_ && !connected() && next_to_send() >= 0 && t >= dead_attempt_) {
    can_busy(t, true);
    can_failed(CanError::kBit, true, t);
    can_quiet(t, t);
  }
  schedule(t);
}

void ECan::become_active(Tick t) {
  mode_ = Mode::kRunning;
  if (bus_off_) errors_.clear();
  bus_off_ = false;
  set_active(true, t);
}

void ECan::set_active(bool active, Tick t) {
  if (active == active_) return;
  active_ = active;
  if (!active) sending_ = -1;
  announce(t);
}

void ECan::go_bus_off(Tick t) {
  bus_off_ = true;
  raise_global(CANGIF_BOIF_MASK, t);
  mode_ = Mode::kEntering;
  set_active(false, t);
  start_waiting(kRecoverySequences, t);
  if ((control(REG_CANMC) & CANMC_ABO_MASK) == 0) control(REG_CANMC) |= CANMC_CCR_MASK;
  steer(t);
}

// ---- the bus calls -------------------------------------------------------------------------------------

void ECan::can_busy(std::int64_t t, bool mine) {
  count_quiet(t);
  quiet_ = false;
  in_frame_ = true;
  if (mine) sending_ = next_to_send();
  schedule(t);
}

void ECan::can_quiet(std::int64_t since, std::int64_t t) {
  quiet_ = true;
  in_frame_ = false;
  quiet_since_ = since;
  counted_ = 0;
  steer(t);
}

const CanFrame* ECan::can_offer() {
  const int n = active_ && connected() ? next_to_send() : -1;
  if (n < 0) return nullptr;
  load_offer(mailbox_[static_cast<unsigned>(n)]);
  return &offer_;
}

void ECan::end_own_frame(bool sent, Tick t) {
  if (sending_ < 0) return;
  const auto n = static_cast<unsigned>(sending_);
  const std::uint32_t bit = 1u << n;
  sending_ = -1;
  const bool withdrawn = (control(REG_CANTRR) & bit) != 0;
  if (!sent && !withdrawn) return;
  control(REG_CANTRS) &= ~bit;
  control(REG_CANTRR) &= ~bit;
  control(sent ? REG_CANTA : REG_CANAA) |= bit;
  if (sent) {
    stamp_[n] = time_stamp(t);
    raise_mailbox(n, t);
  } else {
    raise_global(CANGIF_AAIF_MASK, t);
  }
}

void ECan::can_sent(std::int64_t t) {
  errors_.sent();
  end_own_frame(true, t);
}

void ECan::can_received(const CanFrame& frame, std::int64_t t) {
  errors_.received();
  bool overwrites = false;
  const int n = place_for(frame, overwrites);
  if (n < 0) return;
  if (overwrites) {
    control(REG_CANRML) |= 1u << n;
    raise_global(CANGIF_RMLIF_MASK, t);
  }
  store(static_cast<unsigned>(n), frame, t);
}

void ECan::can_failed(CanError error, bool mine, std::int64_t t) {
  const bool was_warning = errors_.warning();
  const bool was_passive = errors_.passive();
  note_error(error);
  if (mine) {
    errors_.transmit_failed(error);
    end_own_frame(false, t);
  } else {
    errors_.receive_failed(error);
  }
  watch_levels(was_warning, was_passive, t);
}

void ECan::watch_levels(bool was_warning, bool was_passive, Tick t) {
  if (errors_.warning() && !was_warning) raise_global(CANGIF_WLIF_MASK, t);
  if (errors_.passive() && !was_passive) raise_global(CANGIF_EPIF_MASK, t);
  if (errors_.bus_off() && !bus_off_) go_bus_off(t);
}

void ECan::note_error(CanError error) {
  constexpr std::uint32_t flags[] = {CANES_ACKE_MASK, CANES_BE_MASK, CANES_SE_MASK, CANES_FE_MASK};
  control(REG_CANES) |= flags[static_cast<unsigned>(error)];
}

// ---- mailboxes -----------------------------------------------------------------------------------------

// By TPL, then by number: the highest first.
int ECan::next_to_send() const {
  if (stopped_) return -1;
  const std::uint32_t waiting = control(REG_CANTRS) & control(REG_CANME) & ~control(REG_CANMD);
  int best = -1;
  std::uint32_t best_level = 0;
  for (unsigned n = 0; n < kMailboxes; ++n) {
    if (!has(waiting, n)) continue;
    const std::uint32_t level = mailbox_[n].control & CANMSGCTRL_TPL_MASK;
    if (best < 0 || level >= best_level) {
      best = static_cast<int>(n);
      best_level = level;
    }
  }
  return best;
}

void ECan::load_offer(const Mailbox& box) {
  offer_ = CanFrame{};
  offer_.extended = (box.id & CANMSGID_IDE_MASK) != 0;
  offer_.id =
      offer_.extended ? box.id & CANMSGID_EXTENDED_MASK : (box.id & CANMSGID_STANDARD_MASK) >> CANMSGID_STANDARD_LSB;
  offer_.remote = (box.control & CANMSGCTRL_RTR_MASK) != 0;
  offer_.length = static_cast<std::uint8_t>(std::min<std::uint32_t>(box.control & CANMSGCTRL_DLC_MASK, 8));
  const bool low_first = (control(REG_CANMC) & CANMC_DBO_MASK) != 0;
  for (unsigned i = 0; i < 8 && i < offer_.length && !offer_.remote; ++i) {
    const unsigned shift = 8 * (low_first ? i % 4 : 3 - i % 4);
    offer_.data[i] = static_cast<std::uint8_t>((i < 4 ? box.low : box.high) >> shift);
  }
}

bool ECan::accepts(unsigned n, const CanFrame& frame) const {
  const std::uint32_t id = mailbox_[n].id;
  const bool masked = (id & CANMSGID_AME_MASK) != 0;
  const std::uint32_t mask = masked ? mask_[n] : 0;
  const bool own_format = frame.extended == ((id & CANMSGID_IDE_MASK) != 0);
  if (!own_format && (mask & CANLAM_LAMI_MASK) == 0) return false;
  const std::uint32_t compared = frame.extended ? CANMSGID_EXTENDED_MASK : CANMSGID_STANDARD_MASK;
  const std::uint32_t seen = frame.extended ? frame.id : frame.id << CANMSGID_STANDARD_LSB;
  return ((id ^ seen) & ~mask & compared) == 0;
}

int ECan::place_for(const CanFrame& frame, bool& overwrites) const {
  const std::uint32_t receiving = control(REG_CANME) & control(REG_CANMD);
  for (int n = kMailboxes - 1; n >= 0; --n) {
    const auto box = static_cast<unsigned>(n);
    if (!has(receiving, box) || !accepts(box, frame)) continue;
    overwrites = has(control(REG_CANRMP), box);
    if (!overwrites || !has(control(REG_CANOPC), box)) return n;
  }
  return -1;
}

void ECan::store(unsigned n, const CanFrame& frame, Tick t) {
  Mailbox& box = mailbox_[n];
  const std::uint32_t kept = box.id & (CANMSGID_AME_MASK | CANMSGID_AAM_MASK);
  box.id = kept | (frame.extended ? CANMSGID_IDE_MASK | frame.id : frame.id << CANMSGID_STANDARD_LSB);
  box.control = (box.control & CANMSGCTRL_TPL_MASK) | frame.length | (frame.remote ? CANMSGCTRL_RTR_MASK : 0);
  if (!frame.remote) {
    box.low = box.high = 0;
    const bool low_first = (control(REG_CANMC) & CANMC_DBO_MASK) != 0;
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned shift = 8 * (low_first ? i % 4 : 3 - i % 4);
      (i < 4 ? box.low : box.high) |= static_cast<std::uint32_t>(frame.data[i]) << shift;
    }
  }
  stamp_[n] = time_stamp(t);
  control(REG_CANRMP) |= 1u << n;
  if (frame.remote) control(REG_CANRFP) |= 1u << n;
  raise_mailbox(n, t);
}

}  // namespace stillspin::chip
