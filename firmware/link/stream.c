#include "firmware/link/stream.h"

#include "firmware/base/octets.h"
#include "firmware/drive/signals.h"
#include "firmware/link/record.h"
#include "firmware/mode/commands.h"

typedef struct {
  uint16_t period;  // ms; 0: no stream
  uint16_t count;
  uint16_t signals[STREAM_SIGNALS];
  uint16_t counter;
  uint16_t lost;
  uint32_t last_ms;
} stream_t;

static struct {
  stream_t serial, bus;
} self;

static stream_t* of(comm_watchdog_t port) { return (port == COMM_WATCHDOG_BUS) ? &self.bus : &self.serial; }

void stream_reset(void) {
  static const stream_t none = {0};
  self.serial = none;
  self.bus = none;
}

void stream_setup(comm_watchdog_t port, uint16_t period_ms, const uint16_t* places, uint16_t number) {
  stream_t* const s = of(port);
  s->period = period_ms;
  s->count = number;
  for (uint16_t k = 0; k < number; k++) s->signals[k] = places[k];
  s->counter = 0;
  s->lost = 0;
  s->last_ms = drive_time_ms();
}

void stream_dropped(comm_watchdog_t port) {
  stream_t* const s = of(port);
  if (s->lost < UINT16_MAX) s->lost++;
}

uint16_t stream_lost(comm_watchdog_t port) { return of(port)->lost; }

// Those that nobody came for.
static void skip_missed(stream_t* s, uint32_t now) {
  const uint32_t missed = (now - s->last_ms) / s->period;
  s->last_ms += missed * s->period;
  s->counter = (uint16_t)(s->counter + missed);
  const uint32_t sum = missed + s->lost;
  s->lost = (sum < UINT16_MAX) ? (uint16_t)sum : UINT16_MAX;
}

uint16_t stream_event(comm_watchdog_t port, uint16_t* record) {
  stream_t* const s = of(port);
  if (s->period == 0u || drive_time_ms() - s->last_ms < s->period) return 0;
  int32_t values[STREAM_SIGNALS] = {0};
  s->last_ms += s->period;
  const signals_seen_t seen = drive_signals_copy(s->signals, s->count, values);
  skip_missed(s, seen.time_ms);
  octet_writer_t w = octet_writer(record, RECORD_MAX - 2u);
  put_u8(&w, EVENT_STREAM);
  put_u8(&w, s->counter++);
  put_u32(&w, seen.time_ms);
  for (uint16_t k = 0; k < s->count; k++) put_i32(&w, values[k]);
  put_u8(&w, seen.known);
  return w.count;
}
