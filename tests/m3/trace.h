// What the drive's firmware saw and did at the boundary of hal/f2808/target.h, as a file: eight bytes a record, two
// 32-bit words, little endian. Recorded natively (record.cpp), replayed on another machine (replay.c).
//
// Interrupts are taken, and the host's calls come, inside an access; their records stand before the access's own.

#ifndef STILLSPIN_TESTS_M3_TRACE_H
#define STILLSPIN_TESTS_M3_TRACE_H

#include <stdint.h>

typedef enum {
  TRACE_READ16 = 1,  // address, value
  TRACE_READ32,
  TRACE_WRITE16,
  TRACE_WRITE32,
  TRACE_READ_IER,  // value
  TRACE_WRITE_IER,
  TRACE_CPU,                // EALLOW, EDIS, CLRC INTM, SETC INTM, clearing of IFR: nothing but an instant
  TRACE_SET_VECTOR,         // vector
  TRACE_IDLE,               // nothing
  TRACE_ELAPSE,             // cycles
  TRACE_INTERRUPT,          // vector
  TRACE_RETURN,             // vector, hash of the drive's signals
  TRACE_PARAMETER,          // id, raw value
  TRACE_COMMAND_START,      // nothing
  TRACE_COMMAND_STOP,       // nothing
  TRACE_COMMAND_SPEED,      // raw value
  TRACE_END,                // nothing
  TRACE_SCOPE,              // nothing: scope_run_begin
  TRACE_COMMAND_COMMISSION  // nothing
} trace_kind_t;

typedef struct {
  uint32_t kind_address;  // kind << 24 | address, id or vector
  uint32_t value;
} trace_record_t;

// FNV-1a over 32-bit words.
static inline uint32_t trace_hash(const int32_t* words, uint32_t count) {
  uint32_t hash = 2166136261u;
  for (uint32_t k = 0; k < count; k++) hash = (hash ^ (uint32_t)words[k]) * 16777619u;
  return hash;
}

#endif
