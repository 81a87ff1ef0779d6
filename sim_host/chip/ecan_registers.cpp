// eCAN: what reading and writing its registers does.

#include "sim_host/chip/ecan.hpp"

namespace stillspin::chip {
namespace {

constexpr std::uint16_t kMasks = REG_CANLAM(0) - REG_CANME;
constexpr std::uint16_t kStamps = REG_CANMOTS(0) - REG_CANME;
constexpr std::uint16_t kTimeOuts = REG_CANMOTO(0) - REG_CANME;
constexpr std::uint16_t kMessages = REG_CANMSGID(0) - REG_CANME;
constexpr std::uint16_t kEnd = kMessages + 8 * ECAN_MAILBOXES;
constexpr std::uint16_t kMessageWords = 8;

constexpr std::uint32_t kMasterKept =
    CANMC_ABO_MASK | CANMC_DBO_MASK | CANMC_CCR_MASK | CANMC_SCB_MASK | CANMC_MBCC_MASK | CANMC_SUSP_MASK;
constexpr std::uint32_t kTimingKept =
    CANBTC_TSEG2REG_MASK | CANBTC_TSEG1REG_MASK | CANBTC_SAM_MASK | CANBTC_SJWREG_MASK | CANBTC_BRPREG_MASK;
constexpr std::uint32_t kErrorFlags =
    CANES_ACKE_MASK | CANES_SE_MASK | CANES_CRCE_MASK | CANES_SA1_MASK | CANES_BE_MASK | CANES_FE_MASK;
constexpr std::uint32_t kOwnGlobalFlags = CANGIF_WLIF_MASK | CANGIF_EPIF_MASK | CANGIF_BOIF_MASK | CANGIF_WDIF_MASK;

constexpr std::uint32_t field(std::uint32_t word, std::uint32_t mask, unsigned lsb) { return (word & mask) >> lsb; }

}  // namespace

bool ECan::is_protected(std::uint16_t offset) {
  switch (offset & ~1u) {
    case offset_of(REG_CANMC):
    case offset_of(REG_CANBTC):
    case offset_of(REG_CANGIM):
    case offset_of(REG_CANMIM):
    case offset_of(REG_CANTIOC):
    case offset_of(REG_CANRIOC):
    case offset_of(REG_CANTSC):
      return true;
    default:
      return false;
  }
}

// The word pair behind a memory offset, nullptr for a control register.
std::uint32_t* ECan::memory(std::uint16_t offset) {
  if (offset < kMasks || offset >= kEnd) return nullptr;
  if (offset < kStamps) return &mask_[(offset - kMasks) / 2u];
  if (offset < kTimeOuts) return &stamp_[(offset - kStamps) / 2u];
  if (offset < kMessages) return &time_out_[(offset - kTimeOuts) / 2u];
  Mailbox& box = mailbox_[(offset - kMessages) / kMessageWords];
  std::uint32_t* const words[] = {&box.id, &box.control, &box.low, &box.high};
  return words[(offset - kMessages) % kMessageWords / 2u];
}

// ---- reads ---------------------------------------------------------------------------------------------

std::uint32_t ECan::error_status() const {
  std::uint32_t status = control(REG_CANES) & kErrorFlags;
  if (sending_ >= 0) status |= CANES_TM_MASK;
  if (in_frame_ && active_ && sending_ < 0) status |= CANES_RM_MASK;
  if (mode_ == Mode::kConfigured) status |= CANES_CCE_MASK;
  if (errors_.warning()) status |= CANES_EW_MASK;
  if (errors_.passive()) status |= CANES_EP_MASK;
  if (bus_off_) status |= CANES_BO_MASK;
  return status;
}

std::uint32_t ECan::time_stamp(Tick t) const {
  if (mode_ == Mode::kConfigured || bit_time_ == 0) return stamp_base_;
  return stamp_base_ + static_cast<std::uint32_t>((t - stamp_anchor_) / bit_time_);
}

std::uint32_t ECan::interrupt_flags(unsigned line) const {
  std::uint32_t flags = flags_[line];
  const std::uint32_t on_line = line == 0 ? ~control(REG_CANMIL) : control(REG_CANMIL);
  const std::uint32_t pending = (control(REG_CANTA) | control(REG_CANRMP)) & control(REG_CANMIM) & on_line;
  if (pending != 0) flags |= CANGIF_GMIF_MASK | (31u - static_cast<unsigned>(__builtin_clz(pending)));
  if (((control(REG_CANGIM) & CANGIM_GIL_MASK) != 0 ? 1u : 0u) == line) {
    if (control(REG_CANRML) != 0) flags |= CANGIF_RMLIF_MASK;
    if (control(REG_CANAA) != 0) flags |= CANGIF_AAIF_MASK;
  }
  return flags;
}

std::uint32_t ECan::read32(std::uint16_t offset, Tick t) {
  if (const std::uint32_t* word = memory(offset)) return *word;
  switch (offset) {
    case offset_of(REG_CANES):
      return error_status();
    case offset_of(REG_CANTEC):
      return errors_.transmit() & CAN_COUNTER_MASK;
    case offset_of(REG_CANREC):
      count_quiet(t);
      return bus_off_ ? 128u - sequences_ : errors_.receive() & CAN_COUNTER_MASK;
    case offset_of(REG_CANTSC):
      return time_stamp(t);
    case offset_of(REG_CANGIF0):
      return interrupt_flags(0);
    case offset_of(REG_CANGIF1):
      return interrupt_flags(1);
    default:
      return offset < kMasks ? control_[offset / 2u] : 0;
  }
}

std::uint16_t ECan::read16(std::uint16_t offset, Tick) {
  if (const std::uint32_t* word = memory(static_cast<std::uint16_t>(offset & ~1u))) {
    return static_cast<std::uint16_t>(*word >> 16 * (offset & 1u));
  }
  ++narrow_accesses_;
  return 0;
}

// ---- writes --------------------------------------------------------------------------------------------

void ECan::write32(std::uint16_t offset, std::uint32_t value, Tick t) {
  if (memory(offset) != nullptr) {
    write_memory(offset, value, 0xFFFFFFFFu, t);
  } else if (offset < kMasks) {
    write_control(offset, value, t);
  }
}

void ECan::write16(std::uint16_t offset, std::uint16_t value, Tick t) {
  const unsigned shift = 16 * (offset & 1u);
  const auto even = static_cast<std::uint16_t>(offset & ~1u);
  if (memory(even) != nullptr) {
    write_memory(even, std::uint32_t{value} << shift, 0xFFFFu << shift, t);
  } else if (offset < kMasks) {
    ++narrow_accesses_;
    write_control(even, value * 0x00010001u, t);
  }
}

void ECan::write_memory(std::uint16_t offset, std::uint32_t value, std::uint32_t mask, Tick t) {
  if (offset >= kMessages && (offset - kMessages) % kMessageWords == 0) {
    const unsigned n = (offset - kMessages) / kMessageWords;
    if ((control(REG_CANME) >> n & 1u) != 0) {
      raise_global(CANGIF_WDIF_MASK, t);  // the identifier of an enabled mailbox cannot be written
      return;
    }
  }
  std::uint32_t& word = *memory(offset);
  word = (word & ~mask) | (value & mask);
}

void ECan::write_control(std::uint16_t offset, std::uint32_t value, Tick t) {
  switch (offset) {
    case offset_of(REG_CANTRS):
      control(REG_CANTRS) |= value & ~control(REG_CANMD);
      break;
    case offset_of(REG_CANTRR):
      take_back(value & control(REG_CANTRS), t);
      break;
    case offset_of(REG_CANTA):
    case offset_of(REG_CANAA):
    case offset_of(REG_CANRMP):
    case offset_of(REG_CANRFP):
      clear_mailbox_flags(REG_CANME + offset, value);
      return;
    case offset_of(REG_CANES):
      control(REG_CANES) &= ~(value & kErrorFlags);
      return;
    case offset_of(REG_CANMC):
      write_master(value, t);
      return;
    case offset_of(REG_CANBTC):
      if (mode_ == Mode::kConfigured) write_timing(value & kTimingKept, t);
      return;
    case offset_of(REG_CANGIF0):
    case offset_of(REG_CANGIF1):
      flags_[offset == offset_of(REG_CANGIF1) ? 1 : 0] &= ~(value & kOwnGlobalFlags);
      return;
    case offset_of(REG_CANTSC):
      stamp_base_ = value;
      stamp_anchor_ = t;
      return;
    case offset_of(REG_CANRML):
    case offset_of(REG_CANTEC):
    case offset_of(REG_CANREC):
      return;
    default:
      control_[offset / 2u] = value;
      break;
  }
  announce(t);
  schedule(t);
}

void ECan::take_back(std::uint32_t mailboxes, Tick t) {
  const std::uint32_t in_work = sending_ >= 0 ? 1u << sending_ : 0u;
  const std::uint32_t at_once = mailboxes & ~in_work;
  control(REG_CANTRR) |= mailboxes & in_work;
  control(REG_CANTRS) &= ~at_once;
  control(REG_CANAA) |= at_once;
  if (at_once != 0) raise_global(CANGIF_AAIF_MASK, t);
}

void ECan::clear_mailbox_flags(std::uint32_t address, std::uint32_t value) {
  control(address) &= ~value;
  if (address != REG_CANRMP) return;
  control(REG_CANRML) &= ~value;
  control(REG_CANRFP) &= ~value;
}

void ECan::write_master(std::uint32_t value, Tick t) {
  if ((value & CANMC_SRES_MASK) != 0) {
    soft_reset(t);
    return;
  }
  if ((value & (CANMC_STM_MASK | CANMC_PDR_MASK)) != 0) {
    services_.model_error("eCAN self test or power-down: not modelled, CANMC", value);
    return;
  }
  if ((value & CANMC_TCC_MASK) != 0) {
    stamp_base_ = 0;
    stamp_anchor_ = t;
  }
  control(REG_CANMC) = value & kMasterKept;
  steer(t);
}

void ECan::write_timing(std::uint32_t value, Tick t) {
  control(REG_CANBTC) = value;
  const std::uint32_t quanta = 3 + field(value, CANBTC_TSEG1REG_MASK, CANBTC_TSEG1REG_LSB) +
                               field(value, CANBTC_TSEG2REG_MASK, CANBTC_TSEG2REG_LSB);
  const std::uint32_t prescaler = 1 + field(value, CANBTC_BRPREG_MASK, CANBTC_BRPREG_LSB);
  bit_time_ = Tick{prescaler} * quanta * services_.sysclk_period();
  steer(t);
}

// ---- interrupts ----------------------------------------------------------------------------------------

void ECan::raise_global(std::uint32_t flag, Tick t) {
  const std::uint32_t enabled = control(REG_CANGIM);
  const unsigned line = (enabled & CANGIM_GIL_MASK) != 0 ? 1 : 0;
  flags_[line] |= flag & kOwnGlobalFlags;
  const std::uint32_t line_enabled = line == 0 ? CANGIM_I0EN_MASK : CANGIM_I1EN_MASK;
  if ((enabled & flag) == 0 || (enabled & line_enabled) == 0) return;
  services_.raise_interrupt(line == 0 ? VECTOR_ECAN0INTA : VECTOR_ECAN1INTA, t);
}

void ECan::raise_mailbox(unsigned n, Tick t) {
  if ((control(REG_CANMIM) >> n & 1u) == 0) return;
  const unsigned line = control(REG_CANMIL) >> n & 1u;
  const std::uint32_t line_enabled = line == 0 ? CANGIM_I0EN_MASK : CANGIM_I1EN_MASK;
  if ((control(REG_CANGIM) & line_enabled) == 0) return;
  services_.raise_interrupt(line == 0 ? VECTOR_ECAN0INTA : VECTOR_ECAN1INTA, t);
}

}  // namespace stillspin::chip
