#include "sim_host/devices/can_bus.hpp"

#include <algorithm>

#include "sim_host/devices/can_frame.hpp"

namespace stillspin::devices {
namespace {

constexpr int kHeaderBits = 20;       // where a destroyed frame ends: behind the identifier
constexpr int kMismatchBits = 14;     // where a node of another bit rate has seen a stuff error
constexpr int kQuietTail = 8;         // recessive bits at the end of a frame or of an error delimiter
constexpr Tick kSlowestBit = 10'000;  // 10 kbit/s: for wires on which nobody has a bit rate

// A bus in the middle of telling its nodes takes their changes into account afterwards.
class Telling {
 public:
  explicit Telling(bool& flag) : flag_(flag) { flag_ = true; }
  ~Telling() { flag_ = false; }
  Telling(const Telling&) = delete;
  Telling& operator=(const Telling&) = delete;

 private:
  bool& flag_;
};

}  // namespace

// ---- members -------------------------------------------------------------------------------------------

bool CanSegment::has(const CanNode& node) const {
  return std::any_of(members_.begin(), members_.end(), [&](const Member& m) { return m.node == &node; });
}

void CanSegment::add(CanNode& node, Tick t) {
  members_.push_back(Member{&node});
  const Telling telling(in_delivery_);
  if (state_ == State::kFree) {
    node.can_quiet(t, t);
  } else {
    node.can_busy(t, false);
  }
}

void CanSegment::forget(const CanNode& node) {
  members_.erase(std::remove_if(members_.begin(), members_.end(), [&](const Member& m) { return m.node == &node; }),
                 members_.end());
}

void CanSegment::remove(CanNode& node, Tick t) {
  const auto member = std::find_if(members_.begin(), members_.end(), [&](const Member& m) { return m.node == &node; });
  if (member == members_.end()) return;
  const Member gone = *member;
  forget(node);
  if (state_ != State::kFrame) return;
  const Telling telling(in_delivery_);
  if (gone.sends) failed_ = true;
  if (gone.sends || gone.hears) node.can_failed(gone.sends ? CanError::kBit : CanError::kStuff, gone.sends, t);
}

// ---- who sends next ------------------------------------------------------------------------------------

void CanSegment::changed(Tick t) {
  if (state_ == State::kFree && !in_delivery_) look(t);
}

void CanSegment::look(Tick t) { next_event_ = earliest_start(t); }

Tick CanSegment::earliest_start(Tick t) const {
  Tick earliest = chip::kNever;
  for (const Member& m : members_) {
    if (m.node->can_bit_time() > 0 && m.node->can_offer() != nullptr) {
      earliest = std::min(earliest, std::max({t, free_at_, m.not_before}));
    }
  }
  return earliest;
}

bool CanSegment::choose_sender(Tick t) {
  std::uint32_t best = 0xFFFFFFFFu;
  bool found = false;
  collision_ = false;
  for (Member& m : members_) {
    m.sends = false;
    m.hears = m.node->can_bit_time() > 0;
    const CanFrame* offer = m.hears && m.not_before <= t ? m.node->can_offer() : nullptr;
    if (offer == nullptr) continue;
    const std::uint32_t key = can_arbitration_key(*offer);
    if (found && key > best) continue;
    if (found && key < best) {
      for (Member& other : members_) other.sends = false;
      collision_ = false;
    } else if (found && !(*offer == frame_)) {
      collision_ = true;
    }
    m.sends = found = true;
    best = key;
    frame_ = *offer;
    bit_ = m.node->can_bit_time();
  }
  return found;
}

void CanSegment::begin_frame(Tick t) {
  if (!choose_sender(t)) {
    look(t);
    return;
  }
  state_ = State::kFrame;
  begun_ = t;
  next_event_ = t + judge() * bit_;
  const Telling telling(in_delivery_);
  for (const Member& m : members_) m.node->can_busy(t, m.sends);
}

// ---- what becomes of a frame ---------------------------------------------------------------------------

bool CanSegment::heard_by_others() const {
  return std::any_of(members_.begin(), members_.end(), [this](const Member& m) {
    return !m.sends && m.hears && m.node->can_bit_time() == bit_ && m.node->can_acknowledges();
  });
}

bool CanSegment::disturbed() const {
  return std::any_of(members_.begin(), members_.end(), [this](const Member& m) {
    const Tick bit = m.node->can_bit_time();
    return !m.sends && bit > 0 && bit != bit_ && m.node->can_acknowledges() && !m.node->can_error_passive();
  });
}

int CanSegment::break_at(int bits, CanError error) {
  failed_ = true;
  sender_error_ = error;
  const int answer = error == CanError::kAcknowledge ? 0 : kCanErrorFlagBits;
  return bits + kCanErrorFlagBits + answer + kCanErrorDelimiterBits;
}

// Bits until the line is recessive for good.
int CanSegment::judge() {
  failed_ = false;
  const int bits = can_frame_bits(frame_);
  if (to_destroy_ > 0) {
    --to_destroy_;
    return break_at(kHeaderBits, CanError::kBit);
  }
  if (collision_) return break_at(kHeaderBits, CanError::kBit);
  if (disturbed()) return break_at(kMismatchBits, CanError::kBit);
  if (!heard_by_others()) return break_at(bits - kQuietTail, CanError::kAcknowledge);
  return bits;
}

void CanSegment::end_frame(Tick t) {
  busy_ticks_ += t - begun_ + kCanIntermissionBits * bit_;
  const bool sender_left = std::any_of(members_.begin(), members_.end(),
                                       [](const Member& m) { return m.sends && m.node->can_bit_time() == 0; });
  if (sender_left) {
    failed_ = true;
  } else if (!failed_ && !heard_by_others()) {
    failed_ = true;
    sender_error_ = CanError::kAcknowledge;
  }
  ++(failed_ ? broken_frames_ : frames_);
  deliver(t);
  release_line(t - kQuietTail * bit_, t);
}

void CanSegment::deliver(Tick t) {
  const Telling telling(in_delivery_);
  for (Member& m : members_) {
    if (m.sends && failed_) {
      m.node->can_failed(sender_error_, true, t);
    } else if (m.sends) {
      m.node->can_sent(t);
    } else if (m.hears && m.node->can_bit_time() > 0) {
      const bool foreign = m.node->can_bit_time() != bit_;
      if (failed_ || foreign) {
        m.node->can_failed(foreign ? CanError::kForm : CanError::kStuff, false, t);
      } else {
        m.node->can_received(frame_, t);
      }
    }
    if (m.sends && m.node->can_error_passive()) {
      m.not_before = t + (kCanIntermissionBits + kCanSuspendBits) * bit_;
    }
    m.sends = m.hears = false;
  }
}

void CanSegment::release_line(Tick recessive_since, Tick t) {
  state_ = State::kFree;
  free_at_ = t + kCanIntermissionBits * bit_;
  {
    const Telling telling(in_delivery_);
    for (const Member& m : members_) m.node->can_quiet(recessive_since, t);
  }
  look(t);
}

// ---- a short circuit -----------------------------------------------------------------------------------

void CanSegment::short_wires(bool on, Tick t) {
  if (on == (state_ == State::kShorted)) return;
  if (!on) {
    release_line(t, t);
    return;
  }
  if (state_ == State::kFrame) {
    failed_ = true;
    sender_error_ = CanError::kBit;
    deliver(t);
  }
  state_ = State::kShorted;
  const Telling telling(in_delivery_);
  for (const Member& m : members_) m.node->can_busy(t, false);
  next_event_ = t + kCanErrorDelimiterBits * kSlowestBit;
}

// A dominant line that does not end is one more error every eight bits, for whoever wants to send and whoever hears.
void CanSegment::suffer_short(Tick t) {
  Tick bit = kSlowestBit;
  const Telling telling(in_delivery_);
  for (const Member& m : members_) {
    if (m.node->can_bit_time() == 0) continue;
    bit = std::min(bit, m.node->can_bit_time());
    m.node->can_failed(CanError::kBit, m.node->can_offer() != nullptr, t);
  }
  next_event_ = t + kCanErrorDelimiterBits * bit;
}

void CanSegment::run_event(Tick t) {
  switch (state_) {
    case State::kFree:
      begin_frame(t);
      break;
    case State::kFrame:
      end_frame(t);
      break;
    case State::kShorted:
      suffer_short(t);
      break;
  }
}

// ---- the bus -------------------------------------------------------------------------------------------

std::list<CanBus::Alone>::iterator CanBus::find_alone(const CanNode& node) {
  return std::find_if(alone_.begin(), alone_.end(), [&](const Alone& a) { return a.node == &node; });
}

void CanBus::attach(CanNode& node, std::int64_t t) { common_.add(node, t); }

void CanBus::detach(CanNode& node) {
  common_.forget(node);
  const auto alone = find_alone(node);
  if (alone != alone_.end()) alone_.erase(alone);
}

void CanBus::changed(CanNode& node, std::int64_t t) {
  const auto alone = find_alone(node);
  if (alone != alone_.end()) {
    alone->wire.changed(t);
  } else if (common_.has(node)) {
    common_.changed(t);
  }
}

void CanBus::set_plugged(CanNode& node, bool plugged, Tick t) {
  const auto alone = find_alone(node);
  if (plugged == (alone == alone_.end())) return;
  if (plugged) {
    alone->wire.remove(node, t);
    alone_.erase(alone);
    common_.add(node, t);
    common_.changed(t);
  } else {
    common_.remove(node, t);
    alone_.push_back(Alone{&node, {}});
    alone_.back().wire.add(node, t);
    alone_.back().wire.changed(t);
  }
}

Tick CanBus::next_event() const {
  Tick next = common_.next_event();
  for (const Alone& a : alone_) next = std::min(next, a.wire.next_event());
  return next;
}

void CanBus::run_event(Tick t) {
  if (common_.next_event() <= t) common_.run_event(t);
  for (Alone& a : alone_) {
    if (a.wire.next_event() <= t) a.wire.run_event(t);
  }
}

}  // namespace stillspin::devices
