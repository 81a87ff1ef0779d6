// Replays a recorded run (trace.h) on a Cortex-M3 in QEMU, with the drive's whole firmware from power-on.
//
// Every access must come as it came natively: kind, address and value written; every read gives what it gave, and
// interrupts come at the same accesses. The drive's signals are compared by their hash after every interrupt. A
// difference ends the replay.
//
// Who counts (count.c, in the emulator) sees by calls of the marks where interrupts begin and end, and what in between
// is not the drive's: what an access does here.

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "firmware/boot/main.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "hal/f2808/target.h"
#include "tests/m3/scope_run.h"
#include "tests/m3/trace.h"

#define VECTORS 128
#define CONTROL_VECTOR 48  // EPWM1_INT
#define BUFFER 1024

static FILE* file;
static trace_record_t buffer[BUFFER];
static size_t filled, next;
static unsigned long passed;  // records
static unsigned long periods;
static target_isr_t vectors[VECTORS];

// ---- marks ---------------------------------------------------------------------------------------------------------

#define MARK(name) \
  __attribute__((noinline)) static void name(void) { __asm__ volatile("" ::"r"(#name)); }

MARK(mark_resting)     // a control interrupt begins, the gates are off
MARK(mark_starting)    // the same, the drive starts
MARK(mark_turning)     // the shaft is in hand
MARK(mark_commission)  // the drive commissions itself
MARK(mark_window)      // another interrupt begins
MARK(mark_return)      // an interrupt has ended
MARK(mark_pause)       // what follows is not the drive's
MARK(mark_resume)

// A period belongs to the state in which it began.
static void mark_period(int32_t state) {
  switch (state) {
    case DRIVE_START:
      mark_starting();
      break;
    case DRIVE_RUN:
    case DRIVE_STOP:
      mark_turning();
      break;
    case DRIVE_COMMISSION:
      mark_commission();
      break;
    default:
      mark_resting();
  }
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
  printf("differs: record %lu, period %lu: %d %" PRIx32 " = %" PRIx32 ", natively %d %" PRIx32 " = %" PRIx32 "\n",
         passed, periods, (int)kind, address, value, (int)kind_of(r), r->kind_address & 0xFFFFFFu, r->value);
  exit(1);
}

static void take_interrupt(uint32_t vector) {
  const int32_t state = drive_signals().state;
  consume();
  if (vector == CONTROL_VECTOR) {
    mark_period(state);
    periods++;
  } else {
    mark_window();
  }
  vectors[vector]();
  mark_return();
  const drive_signals_t signals = drive_signals();
  expect(TRACE_RETURN, vector, trace_hash((const int32_t*)&signals, sizeof signals / sizeof(int32_t)));
}

// What came before an access was done: interrupts and calls of the host, which may access registers themselves.
static void catch_up(void) {
  for (;;) {
    const trace_record_t r = *current();
    const trace_kind_t kind = kind_of(&r);
    if (kind == TRACE_INTERRUPT) {
      take_interrupt(r.kind_address & 0xFFFFFFu);
      continue;
    }
    if (kind == TRACE_END) {
      printf("records %lu\n", passed);
      exit(0);
    }
    if (kind < TRACE_PARAMETER) return;
    consume();
    switch (kind) {
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
      case TRACE_COMMAND_COMMISSION:
        drive_command_commission();
        break;
      default:
        scope_run_begin();
        break;
    }
  }
}

// ---- target.h ------------------------------------------------------------------------------------------------------

static void act(trace_kind_t kind, uint32_t address, uint32_t value) {
  mark_pause();
  catch_up();
  expect(kind, address, value);
  mark_resume();
}

static uint32_t give(trace_kind_t kind, uint32_t address) {
  mark_pause();
  catch_up();
  const uint32_t value = current()->value;
  expect(kind, address, value);
  mark_resume();
  return value;
}

uint16_t target_read16(uint32_t address) { return (uint16_t)give(TRACE_READ16, address); }
uint32_t target_read32(uint32_t address) { return give(TRACE_READ32, address); }
void target_write16(uint32_t address, uint16_t value) { act(TRACE_WRITE16, address, value); }
void target_write32(uint32_t address, uint32_t value) { act(TRACE_WRITE32, address, value); }
void target_eallow(void) { act(TRACE_CPU, 0, 0); }
void target_edis(void) { act(TRACE_CPU, 0, 0); }
void target_enable_interrupts(void) { act(TRACE_CPU, 0, 0); }
void target_disable_interrupts(void) { act(TRACE_CPU, 0, 0); }
void target_clear_ifr(void) { act(TRACE_CPU, 0, 0); }
uint16_t target_read_ier(void) { return (uint16_t)give(TRACE_READ_IER, 0); }
void target_write_ier(uint16_t mask) { act(TRACE_WRITE_IER, 0, mask); }
void target_idle(void) { act(TRACE_IDLE, 0, 0); }
void target_elapse(uint16_t cycles) { act(TRACE_ELAPSE, 0, cycles); }

void target_set_vector(uint16_t vector, target_isr_t isr) {
  vectors[vector % VECTORS] = isr;
  act(TRACE_SET_VECTOR, vector, 0);
}

int main(int argc, char** argv) {
  file = (argc > 1) ? fopen(argv[1], "rb") : NULL;
  if (file == NULL) {
    printf("differs: no trace %s\n", argc > 1 ? argv[1] : "given");
    return 1;
  }
  firmware_main();
  return 1;
}
