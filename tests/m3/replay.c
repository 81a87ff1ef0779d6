// Replays a recorded run (trace.h) on a Cortex-M3 in QEMU, with the drive's whole firmware from power-on, and counts
// the instructions of its interrupts.
//
// Every access must come as it came natively: kind, address and value written; every read gives what it gave, and
// interrupts come at the same accesses. The drive's signals are compared by their hash after every interrupt. A
// difference ends the replay.
//
// Instructions come from SysTick: with `-icount shift=8` an instruction lasts 256 ns, that is 6.4 ticks. What happens
// inside the functions below is not counted; an access counts as one instruction, its operands being the caller's.
// Steps of the control interrupt end where the firmware calls hal_profile_step.

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "firmware/drive_api.h"
#include "hal/f2808/target.h"
#include "tests/m3/trace.h"

void firmware_main(void);

#define SYSTICK_CONTROL (*(volatile uint32_t*)0xE000E010u)
#define SYSTICK_RELOAD (*(volatile uint32_t*)0xE000E014u)
#define SYSTICK_VALUE (*(volatile uint32_t*)0xE000E018u)
#define SYSTICK_MASK 0xFFFFFFu

#define VECTORS 128
#define CONTROL_VECTOR 48  // EPWM1_INT
#define STEPS 7
#define BUFFER 1024

static FILE* file;
static trace_record_t buffer[BUFFER];
static size_t filled, next;
static unsigned long passed;  // records
static target_isr_t vectors[VECTORS];

// ---- counting ------------------------------------------------------------------------------------------------------

typedef struct {
  uint32_t ticks;     // of the code outside of this file
  uint32_t accesses;  // since the ticks were last cleared
} span_t;

typedef struct {
  uint32_t count, worst, worst_at;
  uint64_t sum;
} statistic_t;

static span_t running;
static uint32_t mark;
static uint32_t overhead_ticks;  // per access, of entering and leaving this file
static bool calibrating;
static bool controlling;  // the control interrupt is running, and not preempted
static uint32_t step;
static uint32_t step_cost[STEPS];
static uint32_t periods;
static statistic_t windows, starting[STEPS + 1], turning[STEPS + 1];  // the last one is the whole

static inline __attribute__((always_inline)) void enter(void) {
  running.ticks += (mark - SYSTICK_VALUE) & SYSTICK_MASK;
  running.accesses++;
}

static inline __attribute__((always_inline)) void leave(void) { mark = SYSTICK_VALUE; }

// Instructions of a span: 6.4 ticks each, and one for every access.
static uint32_t instructions(const span_t* s) {
  const uint32_t own = s->accesses * overhead_ticks;
  return ((s->ticks > own ? s->ticks - own : 0u) * 5u + 16u) / 32u + s->accesses;
}

static void add(statistic_t* s, uint32_t cost) {
  s->count++;
  s->sum += cost;
  if (cost > s->worst) {
    s->worst = cost;
    s->worst_at = periods;
  }
}

static void end_step(void) {
  if (step < STEPS) step_cost[step] = instructions(&running);
  step++;
  running.ticks = 0;
  running.accesses = 0;
}

// Where the emulator's log of what was executed says which periods are which (toolchain/paths/watch.py).
__attribute__((noinline, noipa)) static void turning_period(void) { __asm volatile(""); }
__attribute__((noinline, noipa)) static void starting_period(void) { __asm volatile(""); }

// A period belongs to the state in which it began.
static void end_period(int32_t state) {
  const bool turns = state == DRIVE_RUN || state == DRIVE_STOP;
  statistic_t* const table = turns ? turning : starting;
  uint32_t total = 0;
  end_step();
  for (uint32_t k = 0; k < step && k < STEPS; k++) total += step_cost[k];
  periods++;
  if (state < DRIVE_START) return;
  if (turns) {
    turning_period();
  } else {
    starting_period();
  }
  for (uint32_t k = 0; k < step && k < STEPS; k++) add(&table[k], step_cost[k]);
  add(&table[STEPS], total);
}

static void print(const char* name, const statistic_t* s) {
  if (s->count == 0u) return;
  printf("%s %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 "\n", name, s->count, (uint32_t)(s->sum / s->count),
         s->worst, s->worst_at);
}

static void report(void) {
  static const char* const names[STEPS + 1] = {"samples",  "estimate",  "supervise", "control",
                                               "modulate", "hand_over", "link",      "all"};
  for (uint32_t k = 0; k <= STEPS; k++) {
    printf("turning ");
    print(names[k], &turning[k]);
    printf("starting ");
    print(names[k], &starting[k]);
    printf("\n");
  }
  printf("turning ");
  print("window", &windows);
  printf("records %lu\n", passed);
}

// ---- the trace -----------------------------------------------------------------------------------------------------

static const trace_record_t* current(void) {
  if (next == filled) {
    filled = fread(buffer, sizeof buffer[0], BUFFER, file);
    next = 0;
    if (filled == 0u) {
      printf("differs: the trace ends early, after %lu records\n", passed);
      exit(1);
    }
  }
  return &buffer[next];
}

static void consume(void) {
  next++;
  passed++;
}

static trace_kind_t kind_of(const trace_record_t* r) { return (trace_kind_t)(r->kind_address >> 24); }

static void expect(trace_kind_t kind, uint32_t address, uint32_t value) {
  const trace_record_t* const r = current();
  if (r->kind_address == ((uint32_t)kind << 24 | address) && r->value == value) {
    consume();
    return;
  }
  printf("differs: record %lu, period %" PRIu32 ": %d %" PRIx32 " = %" PRIx32 ", natively %d %" PRIx32 " = %" PRIx32
         "\n",
         passed, periods, (int)kind, address, value, (int)kind_of(r), r->kind_address & 0xFFFFFFu, r->value);
  exit(1);
}

static void take_interrupt(uint32_t vector) {
  const span_t interrupted = running;
  const bool preempted = controlling;
  const int32_t state = drive_signals().state;
  consume();
  running.ticks = 0;
  running.accesses = 0;
  controlling = vector == CONTROL_VECTOR;
  if (controlling) step = 0;
  leave();
  vectors[vector]();
  running.ticks += (mark - SYSTICK_VALUE) & SYSTICK_MASK;
  if (controlling) {
    end_period(state);
  } else if (drive_signals().state == DRIVE_RUN) {
    add(&windows, instructions(&running));
  }
  const drive_signals_t signals = drive_signals();
  expect(TRACE_RETURN, vector, trace_hash((const int32_t*)&signals, sizeof signals / sizeof(int32_t)));
  running = interrupted;
  controlling = preempted;
}

// What came before an access was done: interrupts and calls of the host.
static void catch_up(void) {
  for (;;) {
    const trace_record_t r = *current();
    switch (kind_of(&r)) {
      case TRACE_INTERRUPT:
        take_interrupt(r.kind_address & 0xFFFFFFu);
        continue;
      case TRACE_PARAMETER:
        (void)parameter_set((uint16_t)r.kind_address, (int32_t)r.value);
        break;
      case TRACE_COMMAND_START:
        drive_command_start();
        break;
      case TRACE_COMMAND_STOP:
        drive_command_stop();
        break;
      case TRACE_COMMAND_SPEED:
        drive_command_speed((int32_t)r.value);
        break;
      case TRACE_END:
        report();
        exit(0);
      default:
        return;
    }
    consume();
  }
}

// ---- target.h ------------------------------------------------------------------------------------------------------

static void act(trace_kind_t kind, uint32_t address, uint32_t value) {
  if (calibrating) return;
  catch_up();
  expect(kind, address, value);
}

static uint32_t give(trace_kind_t kind, uint32_t address) {
  if (calibrating) return 0;
  catch_up();
  const uint32_t value = current()->value;
  expect(kind, address, value);
  return value;
}

uint16_t target_read16(uint32_t address) {
  enter();
  const uint32_t value = give(TRACE_READ16, address);
  leave();
  return (uint16_t)value;
}

uint32_t target_read32(uint32_t address) {
  enter();
  const uint32_t value = give(TRACE_READ32, address);
  leave();
  return value;
}

void target_write16(uint32_t address, uint16_t value) {
  enter();
  act(TRACE_WRITE16, address, value);
  leave();
}

void target_write32(uint32_t address, uint32_t value) {
  enter();
  act(TRACE_WRITE32, address, value);
  leave();
}

static void pass(void) {
  enter();
  act(TRACE_CPU, 0, 0);
  leave();
}

void target_eallow(void) { pass(); }
void target_edis(void) { pass(); }
void target_enable_interrupts(void) { pass(); }
void target_disable_interrupts(void) { pass(); }
void target_clear_ifr(void) { pass(); }

uint16_t target_read_ier(void) {
  enter();
  const uint32_t value = give(TRACE_READ_IER, 0);
  leave();
  return (uint16_t)value;
}

void target_write_ier(uint16_t mask) {
  enter();
  act(TRACE_WRITE_IER, 0, mask);
  leave();
}

void target_set_vector(uint16_t vector, target_isr_t isr) {
  enter();
  vectors[vector % VECTORS] = isr;
  act(TRACE_SET_VECTOR, vector, 0);
  leave();
}

void target_idle(void) {
  enter();
  act(TRACE_IDLE, 0, 0);
  leave();
}

// On the chip it is nothing.
void target_elapse(uint16_t cycles) {
  enter();
  running.accesses--;
  running.ticks -= (overhead_ticks < running.ticks) ? overhead_ticks : running.ticks;
  act(TRACE_ELAPSE, 0, cycles);
  if (controlling) end_step();
  leave();
}

// What an access costs that does nothing, two operands counted as the caller's.
static void calibrate(void) {
  calibrating = true;
  leave();
  for (unsigned k = 0; k < 4u; k++) {
    target_write16(1, 2);
    target_write16(3, 4);
    target_write16(5, 6);
    target_write16(7, 8);
  }
  running.ticks += (mark - SYSTICK_VALUE) & SYSTICK_MASK;
  const uint32_t operands_and_loop = (2u * 16u + 2u * 4u) * 32u / 5u;
  overhead_ticks = (running.ticks - operands_and_loop) / 16u;
  running.ticks = 0;
  running.accesses = 0;
  calibrating = false;
}

int main(int argc, char** argv) {
  file = (argc > 1) ? fopen(argv[1], "rb") : NULL;
  if (file == NULL) {
    printf("differs: no trace %s\n", argc > 1 ? argv[1] : "given");
    return 1;
  }
  SYSTICK_RELOAD = SYSTICK_MASK;
  SYSTICK_VALUE = 0;
  SYSTICK_CONTROL = 5;
  calibrate();
  leave();
  firmware_main();
  return 1;
}
