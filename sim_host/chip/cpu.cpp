// What the firmware's instructions do besides register accesses: interrupts, IDLE, the passing of time.

#include "hal/f2808/registers.h"
#include "sim_host/chip/core.hpp"

namespace stillspin::chip {
namespace {

constexpr Tick kInstructionCycles = 1;  // EALLOW, CLRC INTM, IER access

// Interrupts. 14 cycles from the flag to the first instruction of the ISR (SPRU430); a C function then pushes what the
// hardware does not save, up to eight pairs of registers, pops them at its end and returns with IRET.
constexpr Tick kEntryCycles = 14;
constexpr Tick kContextSaveCycles = 8;
constexpr Tick kContextRestoreCycles = 8;
constexpr Tick kReturnCycles = 8;
constexpr unsigned kMaxDepth = 32;  // nesting deeper than this is a runaway, the DSP's stack would be gone

}  // namespace

void Core::spend_instruction() { spend(kInstructionCycles); }

void Core::set_eallow(bool on) {
  spend_instruction();
  eallow_ = on;
  finish_access();
}

void Core::set_interrupts_masked(bool masked) {
  spend_instruction();
  interrupts_.set_masked(masked);
  finish_access();
}

std::uint16_t Core::read_ier() {
  spend_instruction();
  const std::uint16_t mask = interrupts_.ier();
  finish_access();
  return mask;
}

void Core::write_ier(std::uint16_t mask) {
  spend_instruction();
  interrupts_.set_ier(mask);
  finish_access();
}

void Core::clear_ifr() {
  spend_instruction();
  interrupts_.clear_ifr();
  finish_access();
}

void Core::set_vector(std::uint16_t vector, Isr isr) {
  constexpr std::uint32_t kTable = 0x0D00;
  spend_instruction();
  ++statistics_.writes;
  if (vector >= VECTOR_COUNT) {
    model_error("vector number out of range, 0..127", vector);
  } else if (!protection_stops(kTable + 2u * vector)) {
    interrupts_.set_vector(vector, isr);
  }
  finish_access();
}

// IDLE ends when an enabled interrupt is requested; with INTM set the CPU goes on without taking it.
void Core::idle() {
  if (system_.low_power_mode_selected())
    model_error("IDLE with a low-power mode selected in LPMCR0 is not modelled", 0);
  if (is_failing()) go_on_failing();
  spend_instruction();
  finish_access();
  const std::uint64_t taken = statistics_.interrupts;
  const Tick begin = now_;
  idle_ = true;
  while (!interrupts_.requested()) wait_for_interrupt(kNever, false);
  idle_ = false;
  statistics_.idle_ticks += now_ - begin;
  if (taken == statistics_.interrupts) finish_access();
}

void Core::elapse(std::uint16_t cycles) {
  if (is_failing()) go_on_failing();
  Tick remaining = cycles * period_;
  while (remaining > 0) {
    const Tick begin = now_;
    if (begin + remaining <= horizon_) {
      now_ += remaining;
      break;
    }
    wait_for_interrupt(begin + remaining, true);
    remaining -= now_ - begin;
    if (interrupts_.deliverable()) take_interrupts();
  }
}

// ---- interrupts -----------------------------------------------------------------------------------------

void Core::take_interrupts() {
  while (interrupts_.deliverable()) take_interrupt();
}

void Core::take_interrupt() {
  const Interrupts::Frame frame = interrupts_.enter();
  ++statistics_.interrupts;
  if (frame.spurious) ++statistics_.spurious_interrupts;
  run_isr(frame.vector);
  interrupts_.leave(frame);
}

void Core::run_isr(unsigned vector) {
  const bool eallow = eallow_;
  eallow_ = false;  // part of ST1: saved and cleared
  const Isr isr = interrupts_.vector(vector);
  if (!interrupts_.table_enabled()) model_error("interrupt taken with PIECTRL.ENPIE = 0: vector", vector);
  if (isr == nullptr) model_error("interrupt without a function in its vector (illegal ISR): vector", vector);
  if (++depth_ > kMaxDepth) model_error("interrupts nested too deeply: vector", vector);
  if (stop_) leave_firmware();
  spend(kEntryCycles + kContextSaveCycles);
  isr();
  spend(kContextRestoreCycles + kReturnCycles);
  --depth_;
  eallow_ = eallow;
}

// What no mask holds off. Nothing of what waits is taken by it.
void Core::trap(unsigned vector) {
  Interrupts::Frame frame;
  frame.ier = interrupts_.ier();
  interrupts_.set_masked(true);
  run_isr(vector);
  interrupts_.leave(frame);
}

void Core::fail(Failure failure) {
  failure_ = failure;
  if (failure != Failure::kHalted) return;
  interrupts_.set_held(true);
  epwm_.set_time_base_clock(false, now_);
  set_due(kEPwm, epwm_.next_event());
  set_due(kWatchdog, kNever);
}

// What is left of a program that has failed.
void Core::go_on_failing() {
  for (;;) {
    if (failure_ == Failure::kIllegalInstruction) {
      trap(VECTOR_ILLEGAL);
    } else {
      wait_for_interrupt(kNever, true);
    }
    if (interrupts_.deliverable()) take_interrupts();
  }
}

}  // namespace stillspin::chip
