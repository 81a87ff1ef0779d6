#include "firmware/link/stream.h"

#include "firmware/drive_api.h"
#include "firmware/link/octets.h"
#include "firmware/link/record.h"

static uint16_t period;  // ms; 0: no stream
static uint16_t count;
static uint16_t signals[STREAM_SIGNALS];
static uint16_t counter;
static uint16_t lost;
static uint32_t last_ms;

void stream_reset(void) { period = 0; }

void stream_setup(uint16_t period_ms, const uint16_t* places, uint16_t number) {
  period = period_ms;
  count = number;
  for (uint16_t k = 0; k < number; k++) signals[k] = places[k];
  counter = 0;
  lost = 0;
  last_ms = drive_time_ms();
}

void stream_dropped(void) {
  if (lost < UINT16_MAX) lost++;
}

uint16_t stream_lost(void) { return lost; }

// Those that nobody came for.
static void skip_missed(uint32_t now) {
  const uint32_t missed = (now - last_ms) / period;
  last_ms += missed * period;
  counter = (uint16_t)(counter + missed);
  const uint32_t sum = missed + lost;
  lost = (sum < UINT16_MAX) ? (uint16_t)sum : UINT16_MAX;
}

uint16_t stream_event(uint16_t* record) {
  if (period == 0u || drive_time_ms() - last_ms < period) return 0;
  int32_t values[STREAM_SIGNALS];
  last_ms += period;
  const uint32_t time_ms = drive_signals_copy(signals, count, values);
  skip_missed(time_ms);
  octet_writer_t w = octet_writer(record, RECORD_MAX);
  put_u8(&w, EVENT_STREAM);
  put_u8(&w, counter++);
  put_u32(&w, time_ms);
  for (uint16_t k = 0; k < count; k++) put_i32(&w, values[k]);
  return w.count;
}
