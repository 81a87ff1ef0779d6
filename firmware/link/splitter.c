#include "firmware/link/splitter.h"

#include "firmware/link/cobs.h"

static void count_one(uint16_t* counter) {
  if (*counter < UINT16_MAX) (*counter)++;
}

void splitter_reset(splitter_t* s) {
  s->count = 0;
  s->in_record = false;
  s->skipping = false;
  s->last_ms = 0;
  s->errors.damaged = 0;
  s->errors.too_long = 0;
  s->errors.broken_off = 0;
}

static bool is_text(const splitter_t* s) {
  for (uint16_t k = 0; k < s->count; k++) {
    const uint16_t octet = s->octets[k];
    const bool line_end = octet == 0x0Du || octet == 0x0Au;
    if (!line_end && (octet < 0x20u || octet > 0x7Eu)) return false;
  }
  return true;
}

// Back to text; what was taken for a record may be some.
static int16_t give_up(splitter_t* s, uint16_t* counter) {
  s->in_record = false;
  if (s->skipping || s->count == 0u) return SPLITTER_NOTHING;
  if (is_text(s)) return (int16_t)s->count;
  count_one(counter);
  return SPLITTER_NOTHING;
}

static void begin(splitter_t* s) {
  s->in_record = true;
  s->skipping = false;
  s->count = 0;
}

static int16_t end(splitter_t* s) {
  const uint16_t decoded = cobs_decode(s->octets, s->count);
  const uint16_t inside = (decoded == COBS_MALFORMED) ? 0u : record_open(s->octets, decoded);
  if (inside == 0u) {
    count_one(&s->errors.damaged);
    begin(s);
    return SPLITTER_NOTHING;
  }
  s->count = inside;
  s->in_record = false;
  return SPLITTER_RECORD;
}

static int16_t collect(splitter_t* s, uint16_t octet) {
  if (s->skipping) return SPLITTER_NOTHING;
  s->octets[s->count++] = octet;
  if (s->count <= RECORD_ENCODED_MAX) return SPLITTER_NOTHING;
  const int16_t text = give_up(s, &s->errors.too_long);
  if (text == SPLITTER_NOTHING) {
    s->in_record = true;
    s->skipping = true;
  }
  return text;
}

int16_t splitter_octet(splitter_t* s, uint16_t octet, uint32_t now_ms) {
  octet &= 0xFFu;
  s->last_ms = now_ms;
  if (octet == 0u) {
    if (s->in_record && !s->skipping && s->count > 0u) return end(s);
    begin(s);
    return SPLITTER_NOTHING;
  }
  if (s->in_record) return collect(s, octet);
  s->octets[0] = octet;
  return 1;
}

int16_t splitter_rest(splitter_t* s, uint32_t now_ms) {
  if (!s->in_record || now_ms - s->last_ms < SPLITTER_REST_MS) return SPLITTER_NOTHING;
  return give_up(s, &s->errors.broken_off);
}
