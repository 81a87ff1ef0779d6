#include "sim_host/chip/eqep.hpp"

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

namespace {

enum PositionReset : unsigned { kOnIndex = 0, kOnMaximum = 1, kOnFirstIndex = 2, kOnUnitTimer = 3 };

constexpr std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
constexpr std::int64_t floor_modulo(std::int64_t a, std::int64_t b) { return a - floor_divide(a, b) * b; }

unsigned position_reset(std::uint16_t control) { return field(control, EQEP_QEPCTL_PCRM_MASK, EQEP_QEPCTL_PCRM_LSB); }

}  // namespace

void EQep::reset(Tick t) {
  position_ = position_init_ = position_max_ = position_compare_ = 0;
  index_latch_ = strobe_latch_ = position_latch_ = unit_period_ = 0;
  decoder_ = control_ = capture_ = compare_control_ = interrupt_enable_ = flags_ = status_ = 0;
  forward_ = true;
  index_seen_ = false;
  last_edges_ = 0;
  unit_count_ = 0;
  unit_anchor_ = t;
  next_event_ = kNever;
  clocks_changed(t);
}

// ---- position ----------------------------------------------------------------------------------------

std::int64_t EQep::edges(Tick t) const {
  if (instance_ != 1) {
    return 0;
  }
  const std::int64_t edge_count = services_.encoder_edges(t);
  return bit_set(decoder_, EQEP_QDECCTL_SWAP_MASK) ? -edge_count : edge_count;
}

bool EQep::enabled() const { return bit_set(control_, EQEP_QEPCTL_QPEN_MASK); }

void EQep::set_flag(unsigned mask, Tick t) {
  flags_ = static_cast<std::uint16_t>(flags_ | mask);
  send_interrupt(t);
}

/// QFLG.INT holds further pulses back until it is cleared.
void EQep::send_interrupt(Tick t) {
  if (bit_set(flags_, interrupt_enable_) && !bit_set(flags_, EQEP_QFLG_INT_MASK)) {
    flags_ = static_cast<std::uint16_t>(flags_ | EQEP_QFLG_INT_MASK);
    services_.raise_interrupt(instance_ == 1 ? VECTOR_EQEP1_INT : VECTOR_EQEP2_INT, t);
  }
}

/// Count on by this many edges, wrapping at QPOSMAX.
void EQep::move(std::int64_t by) {
  const std::int64_t place = static_cast<std::int64_t>(position_) + by;
  if (place >= counts()) {
    flags_ = static_cast<std::uint16_t>(flags_ | EQEP_QFLG_PCO_MASK);
  } else if (place < 0) {
    flags_ = static_cast<std::uint16_t>(flags_ | EQEP_QFLG_PCU_MASK);
  }
  position_ = static_cast<std::uint32_t>(floor_modulo(place, counts()));
}

/// The last index pulse between two edge counts, if there is one, latches the position and sets it right.
void EQep::pass_index(std::int64_t from, std::int64_t to) {
  const std::int64_t turn_before = floor_divide(from, counts());
  const std::int64_t turn_after = floor_divide(to, counts());
  if (turn_before == turn_after) {
    move(to - from);
    return;
  }
  const std::int64_t index = (to > from ? turn_after : turn_after + 1) * counts();
  const std::int64_t read_at_index = static_cast<std::int64_t>(position_) + index - from;
  index_latch_ = static_cast<std::uint32_t>(floor_modulo(read_at_index, counts()));
  flags_ = static_cast<std::uint16_t>(flags_ | EQEP_QFLG_IEL_MASK);
  const unsigned mode = position_reset(control_);
  const bool resets = mode == kOnIndex || (mode == kOnFirstIndex && !index_seen_);
  if (!index_seen_) {
    index_seen_ = true;
    status_ = static_cast<std::uint16_t>(status_ | EQEP_QEPSTS_FIMF_MASK | (to > from ? EQEP_QEPSTS_FIDF_MASK : 0u));
  }
  if (resets) {
    position_ = static_cast<std::uint32_t>(floor_modulo(to, counts()));
  } else {
    move(to - from);
  }
}

/// Bring the position up to date.
void EQep::look(Tick t) {
  if (!enabled() || !clocked_) {
    return;
  }
  const std::int64_t now = edges(t);
  const std::int64_t before = last_edges_;
  if (now == before) {
    return;
  }
  last_edges_ = now;
  const bool forward = now > before;
  if (forward != forward_) {
    forward_ = forward;
    flags_ = static_cast<std::uint16_t>(flags_ | EQEP_QFLG_QDC_MASK);
  }
  pass_index(before, now);
  send_interrupt(t);
}

// ---- unit timer --------------------------------------------------------------------------------------

std::uint32_t EQep::unit_timer(Tick t) const {
  if (!bit_set(control_, EQEP_QEPCTL_UTE_MASK) || !clocked_) {
    return unit_count_;
  }
  return unit_count_ + static_cast<std::uint32_t>((t - unit_anchor_) / sysclk_period_);
}

void EQep::settle_unit_timer(Tick t) {
  unit_count_ = unit_timer(t);
  unit_anchor_ = t;
}

void EQep::schedule_unit_timer() {
  const bool runs = bit_set(control_, EQEP_QEPCTL_UTE_MASK) && clocked_ && unit_period_ > 0;
  const std::int64_t left = static_cast<std::int64_t>(unit_period_) - unit_count_;
  // A timer beyond its period has to run through 2^32 first.
  next_event_ = runs ? unit_anchor_ + (left > 0 ? left : left + (std::int64_t{1} << 32)) * sysclk_period_ : kNever;
}

void EQep::run_event(Tick t) {
  look(t);
  if (bit_set(control_, EQEP_QEPCTL_QCLM_MASK)) {
    position_latch_ = position_;
  }
  if (position_reset(control_) == kOnUnitTimer) {
    position_ = 0;
  }
  unit_count_ = 0;
  unit_anchor_ = t;
  schedule_unit_timer();
  status_ = static_cast<std::uint16_t>(status_ | EQEP_QEPSTS_UPEVNT_MASK);
  set_flag(EQEP_QFLG_UTO_MASK, t);
}

void EQep::clocks_changed(Tick t) {
  look(t);
  settle_unit_timer(t);
  sysclk_period_ = services_.sysclk_period();
  const bool was_clocked = clocked_;
  clocked_ = services_.eqep_clock(instance_);
  if (clocked_ && !was_clocked) {
    last_edges_ = edges(t);  // edges that came without a clock are lost
  }
  schedule_unit_timer();
}

// ---- registers ---------------------------------------------------------------------------------------

std::uint32_t* EQep::wide_register(std::uint16_t offset) {
  switch (offset & ~1u) {
    case EQEP_QPOSCNT:
      return &position_;
    case EQEP_QPOSINIT:
      return &position_init_;
    case EQEP_QPOSMAX:
      return &position_max_;
    case EQEP_QPOSCMP:
      return &position_compare_;
    case EQEP_QPOSILAT:
      return &index_latch_;
    case EQEP_QPOSSLAT:
      return &strobe_latch_;
    case EQEP_QPOSLAT:
      return &position_latch_;
    case EQEP_QUTMR:
      return &unit_count_;
    case EQEP_QUPRD:
      return &unit_period_;
    default:
      return nullptr;
  }
}

void EQep::write_control(std::uint16_t value, Tick t) {
  look(t);
  settle_unit_timer(t);
  const bool was_enabled = enabled();
  control_ = static_cast<std::uint16_t>(value & ~EQEP_QEPCTL_SWI_MASK);
  if (enabled() && !was_enabled) {
    last_edges_ = edges(t);
    index_seen_ = false;
  } else if (!enabled()) {
    flags_ = 0;
    status_ = 0;
  }
  if (bit_set(value, EQEP_QEPCTL_SWI_MASK)) {
    position_ = position_init_;
  }
  schedule_unit_timer();
}

/// Half of a 32-bit register; the latches are read-only.
void EQep::write_wide(std::uint16_t offset, std::uint16_t value, Tick t) {
  look(t);
  settle_unit_timer(t);
  const bool read_only = offset >= EQEP_QPOSILAT && offset < EQEP_QUTMR;
  std::uint32_t* wide = wide_register(offset);
  if (wide != nullptr && !read_only) {
    *wide = (offset & 1u) != 0 ? (*wide & 0xFFFFu) | (static_cast<std::uint32_t>(value) << 16)
                               : (*wide & 0xFFFF0000u) | value;
  }
  schedule_unit_timer();
}

void EQep::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  constexpr unsigned kClearable =
      EQEP_QEPSTS_FIMF_MASK | EQEP_QEPSTS_CDEF_MASK | EQEP_QEPSTS_COEF_MASK | EQEP_QEPSTS_UPEVNT_MASK;
  if (offset < EQEP_QWDTMR) {
    write_wide(offset, value, t);
    return;
  }
  switch (offset) {
    case EQEP_QDECCTL:
      look(t);
      decoder_ = value;
      last_edges_ = edges(t);
      break;
    case EQEP_QEPCTL:
      write_control(value, t);
      break;
    case EQEP_QCAPCTL:
      capture_ = value;
      break;
    case EQEP_QPOSCTL:
      compare_control_ = value;
      break;
    case EQEP_QEINT:
      interrupt_enable_ = static_cast<std::uint16_t>(value & 0x0FFEu);
      send_interrupt(t);
      break;
    case EQEP_QCLR:
      flags_ = static_cast<std::uint16_t>(flags_ & ~value);
      send_interrupt(t);
      break;
    case EQEP_QFRC:
      set_flag(value & 0x0FFEu, t);
      break;
    case EQEP_QEPSTS:
      status_ = static_cast<std::uint16_t>(status_ & ~(value & kClearable));
      break;
    default:
      break;
  }
}

std::uint16_t EQep::read(std::uint16_t offset, Tick t) {
  if (offset < EQEP_QWDTMR) {
    if ((offset & ~1u) == EQEP_QPOSCNT) {
      look(t);
      if (!bit_set(control_, EQEP_QEPCTL_QCLM_MASK)) {
        position_latch_ = position_;
      }
    }
    const bool is_timer = (offset & ~1u) == EQEP_QUTMR;
    const std::uint32_t* wide = wide_register(offset);
    const std::uint32_t value = is_timer ? unit_timer(t) : (wide != nullptr ? *wide : 0u);
    return static_cast<std::uint16_t>((offset & 1u) != 0 ? value >> 16 : value);
  }
  switch (offset) {
    case EQEP_QDECCTL:
      return decoder_;
    case EQEP_QEPCTL:
      return control_;
    case EQEP_QCAPCTL:
      return capture_;
    case EQEP_QPOSCTL:
      return compare_control_;
    case EQEP_QEINT:
      return interrupt_enable_;
    case EQEP_QFLG:
      look(t);
      return flags_;
    case EQEP_QEPSTS:
      look(t);
      return static_cast<std::uint16_t>(status_ | (forward_ ? EQEP_QEPSTS_QDF_MASK | EQEP_QEPSTS_QDLF_MASK : 0u));
    default:
      return 0;
  }
}

}  // namespace stillspin::chip
