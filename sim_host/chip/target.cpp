// The native side of hal/f2808/target.h: hands the firmware's instructions to the core that runs on this thread.

#include "hal/f2808/target.h"

#include <cstdio>
#include <cstdlib>

#include "sim_host/chip/core.hpp"

namespace stillspin::chip {
namespace {

// The core that runs on this thread. In a module loaded at run time the general TLS model costs a call at each register
// access; glibc keeps room for a pointer like this one.
#if defined(__GLIBC__)
__attribute__((tls_model("initial-exec")))
#endif
thread_local Core* current_core = nullptr;

Core& current() {
  if (current_core == nullptr) {
    std::fputs("stillspin: a target_ function was called outside a running chip (see Chip::run_until)\n", stderr);
    std::abort();
  }
  return *current_core;
}

}  // namespace

Core& Core::running() { return current(); }

Core* Core::set_current(Core* core) {
  Core* previous = current_core;
  current_core = core;
  return previous;
}

}  // namespace stillspin::chip

using stillspin::chip::current;

extern "C" {

uint16_t target_read16(uint32_t address) { return current().read16(address); }
void target_write16(uint32_t address, uint16_t value) { current().write16(address, value); }
uint32_t target_read32(uint32_t address) { return current().read32(address); }
void target_write32(uint32_t address, uint32_t value) { current().write32(address, value); }
void target_eallow(void) { current().set_eallow(true); }
void target_edis(void) { current().set_eallow(false); }
void target_enable_interrupts(void) { current().set_interrupts_masked(false); }
void target_disable_interrupts(void) { current().set_interrupts_masked(true); }
uint16_t target_read_ier(void) { return current().read_ier(); }
void target_write_ier(uint16_t mask) { current().write_ier(mask); }
void target_clear_ifr(void) { current().clear_ifr(); }
void target_set_vector(uint16_t vector, target_isr_t isr) { current().set_vector(vector, isr); }
void target_idle(void) { current().idle(); }
void target_elapse(uint16_t cycles) { current().elapse(cycles); }

}  // extern "C"
