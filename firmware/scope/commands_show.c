// scope without more, and scope print: set-up, state and a coarse print. Whole captures go over the link's records.

#include <stddef.h>

#include "firmware/console/job.h"
#include "firmware/console/output.h"
#include "firmware/console/signal_text.h"
#include "firmware/drive/signals.h"
#include "firmware/scope/scope.h"
#include "firmware/scope/sub_commands.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"
#include "firmware/text/text.h"
#include "hal/qmath/qcall.h"
#include "hal/qmath/qmath.h"

static void put_state(octet_writer_t* w) {
  const scope_status_t status = scope_status();
  put_packed(w, SAY_scope);
  put_message(w, CATALOGUE_SCOPE, (uint16_t)status.state);
  put_packed(w, SAY_comma);
  put_count(w, status.recorded, SAY_records);
  if (status.trigger_at == SCOPE_NOWHERE) return;
  put_packed(w, SAY_trigger_in_record);
  put_count(w, status.trigger_at, SAY_at);
  put_count(w, status.trigger_time_ms, SAY_ms);
}

static void put_trigger(octet_writer_t* w, const scope_setup_t* s) {
  put_packed(w, SAY_trigger);
  if (s->edge != SCOPE_AT_ONCE) {
    const signal_info_t* const signal = signal_info(s->trigger);
    put_label(w, signal->name);
    put_label(w, scope_edge_text((uint16_t)s->edge));
    put_signal_value(w, signal, s->level);
    if (s->hysteresis >= 0) {
      put_packed(w, SAY_comma);
      put_label(w, SAY_hysteresis);
      put_signal_number(w, signal, s->hysteresis);
    }
  } else {
    put_packed(w, SAY_edge_now);
  }
  put_packed(w, SAY_every);
  put_count(w, s->decimation, SAY_before);
  put_count(w, s->pretrigger, (s->mode == SCOPE_AUTO) ? SAY_mode_auto : SAY_mode_single);
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

void scope_show(void) { console_run(show, false); }

static uint16_t stride;

// False when there is no such record, or none any more: the scope was armed again.
static bool put_record(octet_writer_t* w, const scope_setup_t* s, uint16_t at) {
  put_unsigned(w, at);
  put_spaces_to(w, 6);
  for (uint16_t k = 0; k < s->count; k++) {
    const signal_info_t* const signal = signal_info(s->channel[k].signal);
    int16_t value;
    if (scope_read(k, at, &value, 1) == 0u) return false;
    const int32_t q = (int32_t)signal_q(signal) - (int32_t)s->channel[k].shift;  // -31 has only a sign left
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

bool scope_print(const words_of_line_t* a, scope_setup_t* s) {
  const scope_state_t state = scope_status().state;
  (void)s;
  stride = 16;
  if (a->count > 1u && !scope_whole(a, 1, UINT16_MAX, &stride)) return false;
  if (state != SCOPE_DONE && state != SCOPE_IDLE) {
    line_refused(SAY_the_scope_is_recording_scope_stop_ends);
  } else if (scope_status().recorded == 0u) {
    line_refused(SAY_nothing_has_been_recorded);
  } else {
    console_run(print, false);
  }
  return false;
}
