// A second stack for the firmware, so that it can be stopped in the middle of a function and continued later.
//
// The firmware is plain C that never returns; the simulation has to stop it at an exact tick. A switch saves the
// callee-saved registers and swaps the stack pointer: a few nanoseconds on x86-64 and aarch64. Other processors use
// swapcontext, which costs a system call for the signal mask. The floating-point control words are not switched.
//
// discard() forgets a suspended coroutine without unwinding: no object with a destructor that matters may live on its
// stack while it is suspended. Exceptions may be thrown and caught on the stack, but must not leave the entry function.

#ifndef STILLSPIN_SIM_HOST_CHIP_COROUTINE_HPP
#define STILLSPIN_SIM_HOST_CHIP_COROUTINE_HPP

#include <cstddef>
#include <memory>

namespace stillspin::chip {

class Coroutine {
 public:
  using Entry = void (*)(void* argument);

  Coroutine();
  ~Coroutine();
  Coroutine(const Coroutine&) = delete;
  Coroutine& operator=(const Coroutine&) = delete;

  /// Prepares a start of `entry(argument)` at the next resume(); whatever ran before is discarded. `entry` never
  /// returns.
  void prepare(Entry entry, void* argument);

  /// From the owner's stack: run the coroutine until it suspends.
  void resume();

  /// From the coroutine's stack: go back to resume(). Returns at the next resume(), never if prepare() comes first.
  void suspend();

 private:
  struct Context;
  [[noreturn]] static void trampoline();

  std::unique_ptr<Context> context_;
  Entry entry_ = nullptr;
  void* argument_ = nullptr;
  std::byte* stack_ = nullptr;  // lowest address; the first page is a guard
  std::size_t stack_size_ = 0;
};

}  // namespace stillspin::chip

#endif
