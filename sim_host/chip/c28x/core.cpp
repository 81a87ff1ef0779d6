#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x {
namespace {

constexpr std::uint32_t kTableHigh = 0x3FFFC0;  // the CPU's vector table with VMAP set; otherwise it is at 0
constexpr unsigned kMaskable = 16;              // INT1..INT14, DLOGINT, RTOSINT
constexpr std::uint16_t kMovSpConstant = 0x28AD;

}  // namespace

Core::Core(Bus& bus) : MappedMemory(bus), executed(kFormCount), decoded_(kDecoded) {}

void Core::reset() {
  r = Registers{};
  idle_ = nmi_ = false;
  stop_ = Stop::kNone;
  if (profile_ != nullptr) profile_->abandon();
  jump(bus().vector(0, read32(kTableHigh)));
}

Stop Core::run(std::uint64_t until) {
  stop_ = Stop::kNone;
  until_ = until;
  while (cycles < until_) {
    if (((r.ifr & r.ier) != 0 || nmi_) && serve_interrupts()) continue;
    if (idle_) return Stop::kIdle;
    if (watch_ != nullptr && watch_->stops(r, cycles)) return Stop::kBreakpoint;
    ++instructions;
    execute(fetch(r.pc));
    if (stop_ != Stop::kNone) return stop_;
  }
  return Stop::kNone;
}

const Instruction& Core::fetch(std::uint32_t address) {
  Instruction& kept = decoded_[address % kDecoded];
  const std::uint16_t word0 = MappedMemory::read16(address);
  if (kept.address == address && kept.word0 == word0 &&
      (kept.words == 1 || kept.word1 == MappedMemory::read16(address + 1))) {
    return kept;
  }
  return kept = decode(address, word0, MappedMemory::read16(address + 1));
}

std::uint32_t Core::executing() const {
  for (const unsigned words : {1U, 2U}) {
    const Instruction& before = decoded_[(r.pc - words) % kDecoded];
    if (before.address == r.pc - words && before.words == words) return before.address;
  }
  return r.pc;
}

void Core::execute(const Instruction& i) {
  if (profile_ == nullptr) return carry_out(i);
  const Spent before = spent();
  carry_out(i);
  if (i.word0 == kMovSpConstant) profile_->begin_stack();
  profile_->spend(i.address, spent() - before - repeated_, r.sp);
  repeated_ = {};
}

void Core::carry_out(const Instruction& i) {
  if (i.form != kNoForm) ++executed[i.form];
  wait_for(i, r.arp);
  const std::uint64_t begin = cycles;
  r.pc = (i.address + i.words) & kProgramMask;
  i.run(*this, i);
  cycles += i.cycles;
  note_results(i, begin);
}

void Core::repeat(std::uint32_t count) {
  if (is_repeated_) return;  // RPT behind RPT is carried out once, and repeats nothing
  // A copy: the repeated instruction may overwrite the memory that it is in.
  const Instruction repeated = fetch(r.pc);
  const Spent before = spent();
  ++instructions;
  is_repeated_ = true;
  carry_out(repeated);
  is_repeated_ = false;
  const std::uint32_t repeats = repeated.repeatable ? count : 0;
  for (repeats_done = 1; repeats_done <= repeats; ++repeats_done, ++cycles) repeated.run(*this, repeated);
  repeats_done = 0;
  if (profile_ == nullptr) return;
  repeated_ = spent() - before;
  profile_->spend(repeated.address, repeated_, r.sp);
}

// True when an interrupt was entered. With INTM set an enabled request ends IDLE and does nothing else.
bool Core::serve_interrupts() {
  const unsigned requested = r.ifr & r.ier;
  const bool was_idle = idle_;
  idle_ = false;
  if (!nmi_ && r.intm) {
    if (was_idle) r.idlestat = false;
    return false;
  }
  if (nmi_) {
    nmi_ = false;
    enter_interrupt(kVectorNmi);
    return true;
  }
  // RTOSINT comes before INT1 and so on; DLOGINT, the next to it in the registers, is the last.
  unsigned number = kMaskable;
  if ((requested >> (kMaskable - 1)) == 0) {
    for (number = 1; (requested >> (number - 1) & 1U) == 0;) ++number;
  }
  enter_interrupt(number);
  return true;
}

void Core::enter_interrupt(unsigned vector) {
  take_interrupt(vector);
  cycles += interrupt_cycles_;
}

// The registers that are saved by themselves, in pairs at even addresses: SP first steps past the word in use. IER is
// saved before its bit is cleared, so that the return enables the interrupt again.
void Core::take_interrupt(unsigned vector) {
  ++r.sp;
  push32(joined(r.t(), r.st0()));
  push32(r.acc);
  push32(r.p);
  push32(joined(r.ar(1), r.ar(0)));
  push32(joined(r.dp, r.st1()));
  push32(joined(0, r.ier));  // the upper half is the debug state, of which there is none
  push32(r.pc);
  r.intm = r.dbgm = true;
  r.loop = r.eallow = r.idlestat = false;
  if (vector >= 1 && vector <= kMaskable) {
    const unsigned others = ~(1U << (vector - 1));
    r.ifr = static_cast<std::uint16_t>(r.ifr & others);
    r.ier = static_cast<std::uint16_t>(r.ier & others);
  }
  jump(bus().vector(vector, read32((r.vmap ? kTableHigh : 0) + 2 * vector)));
}

void Core::note_trap(const Instruction& i) {
  Registers before = r;
  before.pc = i.address;
  watch().note_trap(before, cycles);
}

void Core::return_from_interrupt() {
  constexpr unsigned kOwnCycles = 8;
  if (profile_ != nullptr) profile_->leave(cycles + kOwnCycles);
  jump(pop32());
  r.ier = low_half(pop32());
  const std::uint32_t status = pop32();
  r.set_st1(low_half(status));
  r.dp = high_half(status);
  const std::uint32_t pointers = pop32();
  r.set_ar(0, low_half(pointers));
  r.set_ar(1, high_half(pointers));
  r.p = pop32();
  r.acc = pop32();
  const std::uint32_t last = pop32();
  r.set_st0(low_half(last));
  r.set_t(high_half(last));
  --r.sp;
  if (r.amode) stop_unmodelled();
}

void Core::note_access(std::uint32_t address, std::uint32_t words, std::uint8_t kind) {
  for (std::uint32_t at = address; at < address + words; ++at) {
    watch_->note_access(at & kProgramMask, readable_word(at), kind);
  }
}

void Core::push32(std::uint32_t value) {
  write32(r.sp, value);
  r.sp = static_cast<std::uint16_t>(r.sp + 2);
}

std::uint32_t Core::pop32() {
  r.sp = static_cast<std::uint16_t>(r.sp - 2);
  return read32(r.sp);
}

bool Core::breakpoint(const Instruction& i) {
  if (!stop_at_breakpoint_) return false;
  jump(i.address);
  stop_ = Stop::kBreakpoint;
  return true;
}

// A test of V clears it, whatever it was.
bool Core::holds(unsigned condition) {
  switch (condition) {
    case 0:
      return !r.z;
    case 1:
      return r.z;
    case 2:
      return !r.z && !r.n;
    case 3:
      return !r.n;
    case 4:
      return r.n;
    case 5:
      return r.z || r.n;
    case 6:
      return r.c && !r.z;
    case 7:
      return r.c;
    case 8:
      return !r.c;
    case 9:
      return !r.c || r.z;
    case 10:
    case 11: {
      const bool was = r.v;
      r.v = false;
      return was == (condition == 11);
    }
    case 12:
      return !r.tc;
    case 13:
      return r.tc;
    case 14:
      return false;  // BIO: the F2808 has no such pin
    default:
      return true;
  }
}

}  // namespace stillspin::c28x
