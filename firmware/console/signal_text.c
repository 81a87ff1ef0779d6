#include "firmware/console/signal_text.h"

#include "firmware/dictionary/units.h"
#include "firmware/drive/signals.h"
#include "firmware/text/text.h"

uint16_t signal_find(const word_t* name) {
  const uint16_t k = signal_named(name->text, name->count);
  return (k < signal_count() && !signal_is_left_out(k)) ? k : SIGNAL_NONE;
}

uint16_t signal_decimals(const signal_info_t* s) {
  const uint16_t q = signal_q(s);
  if (s->q == 0u) return 0;
  if (q <= 8u) return 1;
  if (q <= 16u) return 2;
  return (q <= 20u) ? 3u : 4u;
}

void put_signal(octet_writer_t* w, uint16_t place) {
  const signal_info_t* const s = signal_info(place);
  int32_t raw;
  const signals_seen_t seen = drive_signals_copy(&place, 1, &raw);
  if ((s->needs & ~seen.known) != 0) {
    put_packed(w, SAY_unknown);
    return;
  }
  put_signal_value(w, s, raw);
}

void put_signal_number(octet_writer_t* w, const signal_info_t* s, int32_t raw) {
  put_fixed(w, raw, signal_q(s), signal_decimals(s));
}

void put_signal_value(octet_writer_t* w, const signal_info_t* s, int32_t raw) {
  put_signal_number(w, s, raw);
  put_unit(w, signal_unit(s));
}

void put_signal_row(octet_writer_t* w, uint16_t place) {
  put_packed(w, signal_info(place)->name);
  put_spaces_to(w, 22);
  put_signal(w, place);
  put_spaces_to(w, 40);
  put_packed(w, signal_meaning(signal_info(place)));
}
