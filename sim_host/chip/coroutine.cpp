#include "sim_host/chip/coroutine.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define STILLSPIN_ASAN 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define STILLSPIN_ASAN 1
#endif
#if defined(STILLSPIN_ASAN)
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif

// STILLSPIN_PORTABLE_SWITCH forces the portable switch, to try it on a processor that has the fast one.
#if (defined(__x86_64__) || defined(__aarch64__)) && defined(__ELF__) && !defined(STILLSPIN_PORTABLE_SWITCH)
#define STILLSPIN_FAST_SWITCH 1
#else
#include <ucontext.h>
#endif

namespace stillspin::chip {
namespace {

// The world's callbacks run on this stack too (an integrator, a trace writer), hence more than the firmware needs.
// Pages that are never touched cost nothing.
constexpr std::size_t kStackBytes = std::size_t{1} << 20;

// prepare() cannot pass an argument to a fresh stack portably; the trampoline takes it from here, at once.
thread_local Coroutine* starting = nullptr;

}  // namespace

#if defined(STILLSPIN_FAST_SWITCH)

// void stillspin_switch_stack(void** save, void* load): pushes the callee-saved registers, stores the stack pointer at
// *save, takes `load` as stack pointer and pops the registers there.
extern "C" void stillspin_switch_stack(void** save, void* load);

#if defined(__x86_64__)
constexpr std::size_t kSavedWords = 6;  // rbp rbx r12 r13 r14 r15
__asm__(R"(
  .text
  .p2align 4
  .hidden stillspin_switch_stack
  .globl stillspin_switch_stack
  .type stillspin_switch_stack, @function
stillspin_switch_stack:
  pushq %rbp
  pushq %rbx
  pushq %r12
  pushq %r13
  pushq %r14
  pushq %r15
  movq %rsp, (%rdi)
  movq %rsi, %rsp
  popq %r15
  popq %r14
  popq %r13
  popq %r12
  popq %rbx
  popq %rbp
  ret
  .size stillspin_switch_stack, .-stillspin_switch_stack
)");
#else
constexpr std::size_t kSavedWords = 20;  // x19..x28, x29, x30, d8..d15
__asm__(R"(
  .text
  .p2align 4
  .hidden stillspin_switch_stack
  .globl stillspin_switch_stack
  .type stillspin_switch_stack, %function
stillspin_switch_stack:
  sub sp, sp, #160
  stp x19, x20, [sp, #0]
  stp x21, x22, [sp, #16]
  stp x23, x24, [sp, #32]
  stp x25, x26, [sp, #48]
  stp x27, x28, [sp, #64]
  stp x29, x30, [sp, #80]
  stp d8, d9, [sp, #96]
  stp d10, d11, [sp, #112]
  stp d12, d13, [sp, #128]
  stp d14, d15, [sp, #144]
  mov x9, sp
  str x9, [x0]
  mov sp, x1
  ldp x19, x20, [sp, #0]
  ldp x21, x22, [sp, #16]
  ldp x23, x24, [sp, #32]
  ldp x25, x26, [sp, #48]
  ldp x27, x28, [sp, #64]
  ldp x29, x30, [sp, #80]
  ldp d8, d9, [sp, #96]
  ldp d10, d11, [sp, #112]
  ldp d12, d13, [sp, #128]
  ldp d14, d15, [sp, #144]
  add sp, sp, #160
  ret
  .size stillspin_switch_stack, .-stillspin_switch_stack
)");
#endif

struct Coroutine::Context {
  void* owner_sp = nullptr;
  void* own_sp = nullptr;

  // Lays out the frame that the first switch pops: registers of no meaning and the trampoline as return address.
  void make(std::byte* stack, std::size_t size, void (*start)()) {
    auto* top = reinterpret_cast<std::uintptr_t*>(stack + size);
#if defined(__x86_64__)
    top -= 2;    // an aligned slot above: at a function's entry rsp is 8 below a multiple of 16
    *--top = 0;  // "return address" of the trampoline: ends a debugger's backtrace
    *--top = reinterpret_cast<std::uintptr_t>(start);
    for (std::size_t i = 0; i < kSavedWords; ++i) *--top = 0;
#else
    top -= kSavedWords;
    for (std::size_t i = 0; i < kSavedWords; ++i) top[i] = 0;
    top[11] = reinterpret_cast<std::uintptr_t>(start);  // x30
#endif
    own_sp = top;
  }
  void enter() { stillspin_switch_stack(&owner_sp, own_sp); }
  void leave() { stillspin_switch_stack(&own_sp, owner_sp); }
};

#else

struct Coroutine::Context {
  ucontext_t owner;
  ucontext_t own;

  void make(std::byte* stack, std::size_t size, void (*start)()) {
    getcontext(&own);
    own.uc_stack.ss_sp = stack;
    own.uc_stack.ss_size = size;
    own.uc_link = nullptr;
    makecontext(&own, start, 0);
  }
  void enter() { swapcontext(&owner, &own); }
  void leave() { swapcontext(&own, &owner); }
};

#endif

Coroutine::Coroutine() : context_(std::make_unique<Context>()) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  stack_size_ = kStackBytes + page;
  void* memory = mmap(nullptr, stack_size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  stack_ = static_cast<std::byte*>(memory);
  mprotect(memory, page, PROT_NONE);
}

Coroutine::~Coroutine() { munmap(stack_, stack_size_); }

void Coroutine::prepare(Entry entry, void* argument) {
  entry_ = entry;
  argument_ = argument;
#if defined(STILLSPIN_ASAN)
  __asan_unpoison_memory_region(stack_ + (stack_size_ - kStackBytes), kStackBytes);  // frames that were discarded
#endif
  context_->make(stack_, stack_size_, &Coroutine::trampoline);
}

#if defined(STILLSPIN_ASAN)

// The sanitizer must know which stack is in use; the owner's bounds are learnt at each entry.
namespace {
thread_local const void* owner_bottom = nullptr;
thread_local std::size_t owner_size = 0;
}  // namespace

void Coroutine::resume() {
  void* fake = nullptr;
  starting = this;
  __sanitizer_start_switch_fiber(&fake, stack_, stack_size_);
  context_->enter();
  __sanitizer_finish_switch_fiber(fake, nullptr, nullptr);
}

void Coroutine::suspend() {
  void* fake = nullptr;
  __sanitizer_start_switch_fiber(&fake, owner_bottom, owner_size);
  context_->leave();
  __sanitizer_finish_switch_fiber(fake, &owner_bottom, &owner_size);
}

void Coroutine::trampoline() {
  __sanitizer_finish_switch_fiber(nullptr, &owner_bottom, &owner_size);
  starting->entry_(starting->argument_);
  std::abort();  // entry functions never return
}

#else

void Coroutine::resume() {
  starting = this;
  context_->enter();
}

void Coroutine::suspend() { context_->leave(); }

void Coroutine::trampoline() {
  starting->entry_(starting->argument_);
  std::abort();  // entry functions never return
}

#endif

}  // namespace stillspin::chip
