// scope channels, trigger, every, before, mode: the set-up.

#include <stddef.h>

#include "firmware/console/names.h"
#include "firmware/console/output.h"
#include "firmware/console/signal_text.h"
#include "firmware/drive/signals.h"
#include "firmware/scope/scope.h"
#include "firmware/scope/sub_commands.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"
#include "hal/qmath/qcall.h"
#include "hal/qmath/qmath.h"

#define EDGES 6u

#define REACH(unit, bits) (uint16_t)(UNIT_##unit | (bits) << 8)

// Bits of a signal that a record drops, by what the quantities of a drive reach: 32 A, 512 V, 8192 rpm.
static uint16_t shift_of(const signal_info_t* s) {
  static const uint16_t reach[] = {REACH(NONE, 7), REACH(A, 5),  REACH(V, 9),       REACH(RPM, 13),
                                   REACH(TURN, 0), REACH(NM, 5), REACH(A_PER_S, 18)};
  uint16_t whole = 15;
  for (uint16_t k = 0; k < sizeof reach / sizeof reach[0]; k++) {
    if (s->unit == (reach[k] & 0xFFu)) whole = reach[k] >> 8;
  }
  return (uint16_t)(q_max16((int16_t)(s->q + whole), 15) - 15);
}

// The signal's place; false, and said, when there is none.
static bool read_signal(const word_t* typed, uint16_t* place) {
  *place = signal_find(typed);
  if (*place == SIGNAL_NONE) refuse_name(NAME_SIGNAL, typed);
  return *place != SIGNAL_NONE;
}

bool scope_set_channels(const words_of_line_t* a, scope_setup_t* s) {
  if (a->count < 2u || a->count > 1u + SCOPE_CHANNELS) {
    line_refused(SAY_scope_channels_takes_one_to_four_signals);
    return false;
  }
  s->count = (uint16_t)(a->count - 1u);
  for (uint16_t k = 0; k < s->count; k++) {
    scope_channel_t* const c = &s->channel[k];
    if (!read_signal(&a->word[k + 1u], &c->signal)) return false;
    c->shift = shift_of(signal_info(c->signal));
  }
  return true;
}

// The last words: the trigger's level or, without its sign, its hysteresis; no larger than what a record of it holds.
// False, and said, when they are none.
static bool read_level(const words_of_line_t* a, bool is_width, scope_setup_t* s) {
  const signal_info_t* const signal = signal_info(s->trigger);
  const int32_t most = qc_shl_sat(INT16_MAX, shift_of(signal));
  const int32_t least = is_width ? 0 : -most;
  const uint16_t k = is_width ? 1 : 3;
  int32_t* const raw = is_width ? &s->hysteresis : &s->level;
  decimal_t number;
  word_t typed = words_from(a, k);
  packed_text_t why = SAY_is_not_a_number_in;
  const uint16_t length = number_with_unit(a, k, signal_unit(signal), &number);
  if (length > 0u) {
    typed.count = length;
    why = SAY_is_outside_of;
    if (signal_q(signal) == 0u && !decimal_is_whole(&number)) {
      why = SAY_is_not_a_whole_number_in;
    } else if (decimal_raw(&number, signal_q(signal), raw) && *raw >= least && *raw <= most) {
      return true;
    }
  }
  octet_writer_t* const w = line_begin();
  put_word(w, &typed);
  put_packed(w, why);
  put_signal_number(w, signal, least);
  put_packed(w, SAY_to);
  put_signal_value(w, signal, most);
  put_packed(w, SAY_nothing_changed);
  line_end_refused();
  return false;
}

bool scope_set_trigger(const words_of_line_t* a, scope_setup_t* s) {
  if (a->count == 2u && word_is(a, 1, SAY_edge_now)) {
    s->edge = SCOPE_AT_ONCE;
    return true;
  }
  uint16_t edge = 0;
  while (edge < EDGES && !word_is(a, 2, scope_edge_text(edge))) edge++;
  if (a->count < 4u || edge == EDGES || edge == SCOPE_AT_ONCE) {
    line_refused(SAY_scope_trigger_signal_rising_falling_either_a);
    return false;
  }
  if (!read_signal(&a->word[1], &s->trigger)) return false;
  s->edge = (scope_edge_t)edge;
  s->hysteresis = SCOPE_BY_SPAN;
  return read_level(a, false, s);
}

bool scope_set_hysteresis(const words_of_line_t* a, scope_setup_t* s) {
  if (a->count < 2u || s->edge >= SCOPE_AT_ONCE) {
    line_refused(SAY_scope_hysteresis_width_of_an_edge);
    return false;
  }
  return read_level(a, true, s);
}

static bool read_whole(const word_t* typed, uint16_t least, uint16_t most, uint16_t* value) {
  decimal_t n;
  int32_t number;
  if (text_number(typed->text, typed->count, &n) != typed->count || !decimal_is_whole(&n)) return false;
  if (!decimal_raw(&n, 0, &number) || number < (int32_t)least || number > (int32_t)most) return false;
  *value = (uint16_t)number;
  return true;
}

bool scope_whole(const words_of_line_t* a, uint16_t least, uint16_t most, uint16_t* value) {
  if (a->count == 2u && read_whole(&a->word[1], least, most, value)) return true;
  const word_t typed = words_from(a, 0);
  octet_writer_t* const w = line_begin();
  put_word(w, &typed);
  put_packed(w, SAY_is_not_a_whole_number_in);
  put_count(w, least, SAY_to);
  put_count(w, most, SAY_nothing_changed);
  line_end_refused();
  return false;
}

bool scope_set_every(const words_of_line_t* a, scope_setup_t* s) {
  return scope_whole(a, 1, UINT16_MAX, &s->decimation);
}

bool scope_set_before(const words_of_line_t* a, scope_setup_t* s) {
  return scope_whole(a, 0, SCOPE_DEPTH - 1u, &s->pretrigger);
}

bool scope_set_mode(const words_of_line_t* a, scope_setup_t* s) {
  s->mode = word_is(a, 1, SAY_auto) ? SCOPE_AUTO : SCOPE_SINGLE;
  const bool is_mode = a->count == 2u && (s->mode == SCOPE_AUTO || word_is(a, 1, SAY_single));
  if (!is_mode) line_refused(SAY_scope_mode_single_or_scope_mode_auto);
  return is_mode;
}
