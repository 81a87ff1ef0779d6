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

#include "firmware/boot/main.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "hal/f2808/target.h"
#include "tests/m3/scope_run.h"
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
#define CALIBRATED 16u
#define APART __attribute__((noinline, noipa))  // called alike from everywhere

static FILE* file;
static trace_record_t buffer[BUFFER];
static size_t filled, next;
static unsigned long passed;  // records
static target_isr_t vectors[VECTORS];

// ---- counting ------------------------------------------------------------------------------------------------------

// What an access is done with. Each takes instructions of its own to enter this file and to leave it.
typedef enum { WRITES_16, WRITES_32, READS_16, READS_32, PASSES, ELAPSES, WAYS } way_t;

typedef struct {
  uint32_t ticks;      // of the code outside of this file, and of entering and leaving it
  uint32_t own_ticks;  // of entering and leaving, times CALIBRATED
  uint32_t accesses;   // since the ticks were last cleared
} span_t;

typedef struct {
  uint32_t count, worst, worst_at;
  uint64_t sum;
} statistic_t;

static span_t running;
static uint32_t mark;
static uint32_t own_ticks[WAYS];  // of CALIBRATED accesses
static bool calibrating;
static bool controlling;  // the control interrupt is running, and not preempted
static uint32_t step;
static uint32_t step_cost[STEPS];
static uint32_t periods;
static statistic_t windows, starting[STEPS + 1], turning[STEPS + 1];  // the last one is the whole

static inline __attribute__((always_inline)) void enter(way_t way) {
  running.ticks += (mark - SYSTICK_VALUE) & SYSTICK_MASK;
  running.own_ticks += own_ticks[way];
  running.accesses++;
}

static inline __attribute__((always_inline)) void leave(void) { mark = SYSTICK_VALUE; }

// Instructions of a span: 6.4 ticks each, and one for every access.
static uint32_t instructions(const span_t* s) {
  const uint32_t own = (s->own_ticks + CALIBRATED / 2u) / CALIBRATED;
  const uint32_t ticks = (s->ticks > own) ? s->ticks - own : 0u;
  return (ticks * 5u + 16u) / 32u + s->accesses;
}

static void add(statistic_t* s, uint32_t cost) {
  s->count++;
  s->sum += cost;
  if (cost > s->worst) {
    s->worst = cost;
    s->worst_at = periods;
  }
}

static void begin_span(void) {
  static const span_t none = {0, 0, 0};
  running = none;
}

static void end_step(void) {
  if (step < STEPS) step_cost[step] = instructions(&running);
  step++;
  begin_span();
}

// Where the emulator's log of what was executed says which periods are which (toolchain/isr/paths/watch.py).
APART static void turning_period(void) { __asm volatile(""); }
APART static void starting_period(void) { __asm volatile(""); }

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
  begin_span();
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
      case TRACE_SCOPE:
        scope_run_begin();
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

APART uint16_t target_read16(uint32_t address) {
  enter(READS_16);
  const uint32_t value = give(TRACE_READ16, address);
  leave();
  return (uint16_t)value;
}

APART uint32_t target_read32(uint32_t address) {
  enter(READS_32);
  const uint32_t value = give(TRACE_READ32, address);
  leave();
  return value;
}

APART void target_write16(uint32_t address, uint16_t value) {
  enter(WRITES_16);
  act(TRACE_WRITE16, address, value);
  leave();
}

APART void target_write32(uint32_t address, uint32_t value) {
  enter(WRITES_32);
  act(TRACE_WRITE32, address, value);
  leave();
}

static void pass(void) {
  enter(PASSES);
  act(TRACE_CPU, 0, 0);
  leave();
}

APART void target_eallow(void) { pass(); }
APART void target_edis(void) { pass(); }
APART void target_enable_interrupts(void) { pass(); }
APART void target_disable_interrupts(void) { pass(); }
APART void target_clear_ifr(void) { pass(); }

APART uint16_t target_read_ier(void) {
  enter(READS_16);
  const uint32_t value = give(TRACE_READ_IER, 0);
  leave();
  return (uint16_t)value;
}

APART void target_write_ier(uint16_t mask) {
  enter(WRITES_16);
  act(TRACE_WRITE_IER, 0, mask);
  leave();
}

void target_set_vector(uint16_t vector, target_isr_t isr) {
  enter(WRITES_16);
  vectors[vector % VECTORS] = isr;
  act(TRACE_SET_VECTOR, vector, 0);
  leave();
}

void target_idle(void) {
  enter(PASSES);
  act(TRACE_IDLE, 0, 0);
  leave();
}

// On the chip it is nothing.
APART void target_elapse(uint16_t cycles) {
  enter(ELAPSES);
  running.accesses--;
  act(TRACE_ELAPSE, 0, cycles);
  if (controlling) end_step();
  leave();
}

#define FOUR(done) done, done, done, done

// What 16 accesses take, by 32 less 16; their operands are the caller's, an instruction each.
#define CALIBRATE(way, operands, access)                                  \
  do {                                                                    \
    begin_span();                                                         \
    leave();                                                              \
    FOUR(FOUR(access));                                                   \
    enter(ELAPSES);                                                       \
    const uint32_t once = running.ticks;                                  \
    begin_span();                                                         \
    leave();                                                              \
    FOUR(FOUR(access)), FOUR(FOUR(access));                               \
    enter(ELAPSES);                                                       \
    own[way] = running.ticks - once - CALIBRATED * (operands) * 32u / 5u; \
  } while (0)

// With accesses that do nothing.
static void calibrate(void) {
  uint32_t own[WAYS];
  calibrating = true;
  CALIBRATE(WRITES_16, 2u, target_write16(1, 2));
  CALIBRATE(WRITES_32, 2u, target_write32(1, 2));
  CALIBRATE(READS_16, 1u, (void)target_read16(1));
  CALIBRATE(READS_32, 1u, (void)target_read32(1));
  CALIBRATE(PASSES, 0u, target_eallow());
  CALIBRATE(ELAPSES, 0u, target_elapse(1));  // on the chip it is nothing
  for (unsigned way = 0; way < WAYS; way++) own_ticks[way] = own[way];
  begin_span();
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
