// watch, signals.

#include <stddef.h>

#include "firmware/console/commands.h"
#include "firmware/console/job.h"
#include "firmware/console/names.h"
#include "firmware/console/output.h"
#include "firmware/console/signal_text.h"
#include "firmware/console/status_text.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/text/packed_text.h"

#define WATCH_MS 500u
#define WATCH_SIGNALS 4u

static struct {
  uint32_t shown_ms;
  uint16_t watched_count;
  uint16_t watched[WATCH_SIGNALS];
} self;

static void put_watched(octet_writer_t* w) {
  for (uint16_t k = 0; k < self.watched_count; k++) {
    if (k > 0u) put_packed(w, SAY_gap);
    put_label(w, signal_info(self.watched[k])->name);
    put_signal(w, self.watched[k]);
  }
}

static bool watch(uint16_t step) {
  if (step > 0u && drive_time_ms() - self.shown_ms < WATCH_MS) return true;
  self.shown_ms = drive_time_ms();
  octet_writer_t* const w = line_begin();
  if (self.watched_count > 0u) {
    put_watched(w);
  } else {
    put_overview(w);
  }
  line_end();
  return true;
}

void command_watch(const words_of_line_t* a) {
  self.watched_count = 0;
  if (a->count > WATCH_SIGNALS) {
    line_refused(SAY_watch_shows_at_most_four_signals);
    return;
  }
  for (uint16_t k = 0; k < a->count; k++) {
    const uint16_t place = signal_find(&a->word[k]);
    if (place == SIGNAL_NONE) {
      refuse_name(NAME_SIGNAL, &a->word[k]);
      return;
    }
    self.watched[k] = place;
  }
  self.watched_count = a->count;
  console_run(watch, true);
}

static bool list_signals(uint16_t step) {
  const signal_info_t* const s = signal_info(step);
  if (s == NULL) return false;
  if (signal_is_left_out(step)) return true;
  if (!filter_takes(s->name, signal_meaning(s))) return true;
  put_signal_row(line_begin(), step);
  line_end();
  return true;
}

void command_signals(const words_of_line_t* a) {
  filter_begin(a);
  console_run(list_signals, false);
}
