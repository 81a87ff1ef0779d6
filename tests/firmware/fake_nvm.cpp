#include "tests/firmware/fake_nvm.hpp"

namespace stillspin::test {

FakeNvm nvm;

bool FakeNvm::begin(std::uint16_t where, std::uint16_t* in, const std::uint16_t* out, std::uint16_t n) {
  if (state == NVM_BUSY || n == 0 || where + std::size_t{n} > memory.size()) return false;
  const long job = jobs++;
  if (job == refused_job) return false;
  deaf = deaf_job >= 0 && job >= deaf_job && job < deaf_job + deaf_jobs;
  state = NVM_BUSY;
  address = where;
  read = in;
  write = out;
  count = n;
  left = latency;
  return true;
}

/// False when the power goes on the way.
bool FakeNvm::pass_octets() {
  const long end = octets + count;
  if (cut_at_octet >= octets && cut_at_octet < end) powered = false;
  octets = end;
  return powered;
}

void FakeNvm::write_page() {
  const bool cut = pages == cut_at_page;
  const unsigned first = address / HAL_NVM_PAGE * HAL_NVM_PAGE;
  ++pages;
  ++wear[address / HAL_NVM_PAGE];
  for (unsigned k = 0; k < HAL_NVM_PAGE; ++k) {
    const unsigned at = first + k;
    const bool sent = at >= address && at < unsigned{address} + count;
    const std::uint8_t before = memory[at];
    const std::uint8_t after = sent && !write_protected ? static_cast<std::uint8_t>(write[at - address]) : before;
    memory[at] = cut ? torn(k, before, after) : after;
  }
  for (const unsigned at : dead) memory[at] = 0x00;
  if (cut) powered = false;
}

hal_nvm_state_t FakeNvm::step() {
  if (state != NVM_BUSY || left-- > 0) return state;
  state = NVM_FAILED;
  const long first = octets;
  if (absent || deaf || !powered || !pass_octets()) return state;
  if (write != nullptr) write_page();
  if (!powered) return state;
  for (unsigned k = 0; read != nullptr && k < count; ++k) read[k] = memory[address + k];
  const long wrong = wrong_at_octet - first;
  if (read != nullptr && wrong >= 0 && wrong < count) read[wrong] ^= 0x10u;
  state = NVM_DONE;
  return state;
}

}  // namespace stillspin::test

using stillspin::test::nvm;

extern "C" {
bool hal_nvm_init(void) { return true; }
bool hal_nvm_read(std::uint16_t address, std::uint16_t* octets, std::uint16_t count) {
  return nvm.begin(address, octets, nullptr, count);
}
bool hal_nvm_write(std::uint16_t address, const std::uint16_t* octets, std::uint16_t count) {
  if (address % HAL_NVM_PAGE + count > HAL_NVM_PAGE) return false;
  return nvm.begin(address, nullptr, octets, count);
}
hal_nvm_state_t hal_nvm_step(void) { return nvm.step(); }
hal_nvm_fault_t hal_nvm_fault(void) { return nvm.state == NVM_FAILED ? NVM_NO_ANSWER : NVM_NO_FAULT; }
}
