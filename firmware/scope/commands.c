// scope: set-up, state and a coarse print. Whole captures go over the link's records.

#include "firmware/scope/commands.h"

#include <stddef.h>

#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/console/signal_text.h"
#include "firmware/console/suggest.h"
#include "firmware/drive/signals.h"
#include "firmware/scope/scope.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"
#include "hal/qmath/qcall.h"
#include "hal/qmath/qmath.h"

#define EDGES 6u

static packed_text_t edge_text(uint16_t edge) { return (packed_text_t)(SAY_edge_rising + edge); }

// Bits of a record's word before its point, by what the quantities of a drive reach: 32 A, 512 V, 8192 rpm.
static uint16_t shift_of(const signal_info_t* s) {
  static const struct {
    const char* unit;
    uint16_t whole;
  } reach[] = {{"", 7}, {"A", 5}, {"V", 9}, {"rpm", 13}, {"turn", 0}, {"Nm", 5}, {"A/s", 18}};
  uint16_t whole = 15;
  for (uint16_t k = 0; k < sizeof reach / sizeof reach[0]; k++) {
    if (packed_is(signal_unit(s), reach[k].unit)) whole = reach[k].whole;
  }
  return (uint16_t)(q_max16((int16_t)(s->q + whole), 15) - 15);
}

static scope_setup_t draft(void) {
  scope_setup_t s = *scope_setup_in_force();
  if (s.count > 0u) return s;
  s.decimation = 1;
  s.pretrigger = SCOPE_DEPTH / 4u;
  s.mode = SCOPE_SINGLE;
  s.edge = SCOPE_AT_ONCE;
  s.hysteresis = SCOPE_BY_SPAN;
  return s;
}

// Everything but the channels has been looked at where it was read.
static void apply(const scope_setup_t* s) {
  if (scope_setup(s)) {
    line_of(SAY_set_scope_arm_starts_it);
  } else {
    line_refused(SAY_first_scope_channels_signal);
  }
}

static void set_channels(const words_of_line_t* a) {
  scope_setup_t s = draft();
  if (a->count < 2u || a->count > 1u + SCOPE_CHANNELS) {
    line_refused(SAY_scope_channels_takes_one_to_four_signals);
    return;
  }
  s.count = (uint16_t)(a->count - 1u);
  for (uint16_t k = 0; k < s.count; k++) {
    const uint16_t place = signal_find(&a->word[k + 1u]);
    if (place == SIGNAL_NONE) {
      suggest(SUGGEST_SIGNAL, &a->word[k + 1u]);
      return;
    }
    s.channel[k].signal = place;
    s.channel[k].shift = shift_of(signal_info(place));
  }
  apply(&s);
}

static void refuse_level(const word_t* typed, const signal_info_t* signal) {
  octet_writer_t* const w = line_begin();
  put_word(w, typed);
  put_packed(w, SAY_is_not_between);
  put_signal_value(w, signal, -INT32_MAX);
  put_packed(w, SAY_and);
  put_signal_value(w, signal, INT32_MAX);
  put_packed(w, SAY_nothing_changed);
  line_end_refused();
}

// A number in the signal's unit, and the unit when it is there; moves `k` behind them. False, and said, when it is
// none.
static bool read_level(const words_of_line_t* a, uint16_t* k, const signal_info_t* signal, int32_t* raw) {
  decimal_t number;
  const word_t* const typed = &a->word[*k];
  if (text_number(typed->text, typed->count, &number) != typed->count) {
    line_refused(SAY_scope_trigger_signal_rising_falling_either_a);
    return false;
  }
  if (!decimal_raw(&number, signal->q, raw)) {
    refuse_level(typed, signal);
    return false;
  }
  (*k)++;
  if (word_is(a, *k, signal_unit(signal))) (*k)++;
  return true;
}

static void set_trigger(const words_of_line_t* a) {
  scope_setup_t s = draft();
  if (a->count == 2u && word_is(a, 1, SAY_edge_now)) {
    s.edge = SCOPE_AT_ONCE;
    apply(&s);
    return;
  }
  uint16_t edge = 0;
  while (edge < EDGES && !word_is(a, 2, edge_text(edge))) edge++;
  if (a->count < 4u || edge == EDGES || edge == SCOPE_AT_ONCE) {
    line_refused(SAY_scope_trigger_signal_rising_falling_either_a);
    return;
  }
  s.trigger = signal_find(&a->word[1]);
  if (s.trigger == SIGNAL_NONE) {
    suggest(SUGGEST_SIGNAL, &a->word[1]);
    return;
  }
  s.edge = (scope_edge_t)edge;
  s.hysteresis = SCOPE_BY_SPAN;
  const signal_info_t* const signal = signal_info(s.trigger);
  uint16_t k = 3;
  if (!read_level(a, &k, signal, &s.level)) return;
  if (k < a->count && edge < SCOPE_AT_ONCE) {
    if (!read_level(a, &k, signal, &s.hysteresis)) return;
    s.hysteresis = q_max(s.hysteresis, 0);
  }
  if (k < a->count) {
    line_refused(SAY_the_level_is_in_the_signal_s);
  } else {
    apply(&s);
  }
}

static bool read_whole(const word_t* typed, uint16_t least, uint16_t most, uint16_t* value) {
  decimal_t n;
  int32_t number;
  if (text_number(typed->text, typed->count, &n) != typed->count || !decimal_is_whole(&n)) return false;
  if (!decimal_raw(&n, 0, &number) || number < (int32_t)least || number > (int32_t)most) return false;
  *value = (uint16_t)number;
  return true;
}

// The whole number behind the sub-command. False, and said, when it is none of least .. most.
static bool whole(const words_of_line_t* a, uint16_t least, uint16_t most, uint16_t* value) {
  if (a->count == 2u && read_whole(&a->word[1], least, most, value)) return true;
  octet_writer_t* const w = line_begin();
  for (uint16_t k = 0; k < a->count; k++) {
    put_word(w, &a->word[k]);
    if (k + 1u < a->count) put_u8(w, ' ');
  }
  put_packed(w, SAY_is_not_a_whole_number_in);
  put_unsigned(w, least);
  put_packed(w, SAY_to);
  put_unsigned(w, most);
  put_packed(w, SAY_nothing_changed);
  line_end_refused();
  return false;
}

static void set_every(const words_of_line_t* a) {
  scope_setup_t s = draft();
  if (whole(a, 1, UINT16_MAX, &s.decimation)) apply(&s);
}

static void set_before(const words_of_line_t* a) {
  scope_setup_t s = draft();
  if (whole(a, 0, SCOPE_DEPTH - 1u, &s.pretrigger)) apply(&s);
}

static void set_mode(const words_of_line_t* a) {
  scope_setup_t s = draft();
  s.mode = word_is(a, 1, SAY_auto) ? SCOPE_AUTO : SCOPE_SINGLE;
  if (a->count != 2u || (s.mode == SCOPE_SINGLE && !word_is(a, 1, SAY_single))) {
    line_refused(SAY_scope_mode_single_or_scope_mode_auto);
    return;
  }
  apply(&s);
}

static void put_state(octet_writer_t* w) {
  const scope_status_t status = scope_status();
  put_packed(w, SAY_scope);
  put_message(w, CATALOGUE_SCOPE, (uint16_t)status.state);
  put_packed(w, SAY_comma);
  put_unsigned(w, status.recorded);
  put_packed(w, SAY_records);
  if (status.trigger_at == SCOPE_NOWHERE) return;
  put_packed(w, SAY_trigger_in_record);
  put_unsigned(w, status.trigger_at);
  put_packed(w, SAY_at);
  put_unsigned(w, status.trigger_time_ms);
  put_packed(w, SAY_ms);
}

static void put_trigger(octet_writer_t* w, const scope_setup_t* s) {
  put_packed(w, SAY_trigger);
  if (s->edge != SCOPE_AT_ONCE) {
    const signal_info_t* const signal = signal_info(s->trigger);
    put_packed(w, signal->name);
    put_u8(w, ' ');
    put_packed(w, edge_text((uint16_t)s->edge));
    put_u8(w, ' ');
    put_signal_value(w, signal, s->level);
    if (s->hysteresis >= 0) {
      put_packed(w, SAY_hysteresis);
      put_fixed(w, s->hysteresis, signal->q, signal_decimals(signal));
    }
  } else {
    put_packed(w, SAY_edge_now);
  }
  put_packed(w, SAY_every);
  put_unsigned(w, s->decimation);
  put_packed(w, SAY_before);
  put_unsigned(w, s->pretrigger);
  put_packed(w, (s->mode == SCOPE_AUTO) ? SAY_mode_auto : SAY_mode_single);
}

static void put_channels(octet_writer_t* w, const scope_setup_t* s) {
  put_packed(w, SAY_channels);
  for (uint16_t k = 0; k < s->count; k++) {
    put_u8(w, ' ');
    put_packed(w, signal_info(s->channel[k].signal)->name);
  }
}

static bool show(uint16_t step) {
  const scope_setup_t* const s = scope_setup_in_force();
  octet_writer_t* const w = line_begin();
  if (step == 0u) {
    put_state(w);
  } else if (step == 1u) {
    put_channels(w, s);
  } else {
    put_trigger(w, s);
  }
  line_end();
  return s->count > 0u && step < 2u;
}

static uint16_t stride;

// False when there is no such record, or none any more: the scope was armed again.
static bool put_record(octet_writer_t* w, const scope_setup_t* s, uint16_t at) {
  put_unsigned(w, at);
  put_spaces_to(w, 6);
  for (uint16_t k = 0; k < s->count; k++) {
    const signal_info_t* const signal = signal_info(s->channel[k].signal);
    int16_t value;
    if (scope_read(k, at, &value, 1) == 0u) return false;
    const int32_t q = (int32_t)signal->q - (int32_t)s->channel[k].shift;  // -31 has only a sign left
    if (value == SCOPE_UNKNOWN) {
      put_u8(w, '-');
    } else {
      put_fixed(w, qc_shl_sat(value, (unsigned)q_clamp(-q, 0, 30)), (uint16_t)q_max(q, 0), signal_decimals(signal));
    }
    put_spaces_to(w, (uint16_t)(6u + 12u * (k + 1u)));
  }
  return true;
}

static bool print(uint16_t step) {
  if (!put_record(line_begin(), scope_setup_in_force(), (uint16_t)((uint32_t)step * stride))) return false;
  line_end();
  return true;
}

static void begin_print(const words_of_line_t* a) {
  const scope_state_t state = scope_status().state;
  stride = 16;
  if (a->count > 1u && !whole(a, 1, UINT16_MAX, &stride)) return;
  if (state != SCOPE_DONE && state != SCOPE_IDLE) {
    line_refused(SAY_the_scope_is_recording_scope_stop_ends);
  } else if (scope_status().recorded == 0u) {
    line_refused(SAY_nothing_has_been_recorded);
  } else {
    console_run(print, false);
  }
}

static void arm(const words_of_line_t* a) {
  (void)a;
  if (scope_arm()) {
    line_of(SAY_armed);
  } else {
    line_refused(SAY_first_scope_channels_signal);
  }
}

static void stop(const words_of_line_t* a) {
  (void)a;
  scope_stop();
  line_of(SAY_stopped);
}

static const struct {
  packed_text_t word;
  void (*obey)(const words_of_line_t* a);
} sub_commands[] = {{SAY_channels, set_channels},   {SAY_sub_trigger, set_trigger}, {SAY_sub_every, set_every},
                    {SAY_sub_before, set_before},   {SAY_sub_mode, set_mode},       {SAY_sub_arm, arm},
                    {TEXT_COMMAND_NAME_stop, stop}, {SAY_sub_print, begin_print}};

void command_scope(const words_of_line_t* a) {
  if (a->count == 0u) {
    console_run(show, false);
    return;
  }
  for (uint16_t k = 0; k < sizeof sub_commands / sizeof sub_commands[0]; k++) {
    if (!word_is(a, 0, sub_commands[k].word)) continue;
    sub_commands[k].obey(a);
    return;
  }
  line_refused(SAY_no_such_scope_command_see_help);
}
