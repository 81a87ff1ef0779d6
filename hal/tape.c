#include <stddef.h>

#include "hal/hal_tape.h"

// A word of the background's work.
#define WORK_EARLY 8u
#define WORK_WHICH 15u
#define WORK_WINDOWS_LSB 4u

hal_tape_t hal_tape;

void hal_tape_start(tape_mode_t mode, void (*interrupt)(void)) {
  hal_tape.mode = mode;
  hal_tape.interrupt = interrupt;
  hal_tape.stepping = false;
  hal_tape.working = false;
  hal_tape_next_period();
}

void hal_tape_next_period(void) {
  hal_tape.call = 0u;
  hal_tape.stepped = false;
  hal_tape.playing = false;
  hal_tape.ended = false;
  hal_tape.input = 0u;
  hal_tape.window = 0u;
  hal_tape.work = 0u;
  hal_tape.torn = false;
  hal_tape.period.input_count = 0u;
  hal_tape.period.output_count = 0u;
  hal_tape.period.window_count = 0u;
  hal_tape.period.work_count = 0u;
}

static void interrupt(const hal_tape_t* t) {
  if (t->interrupt != NULL) t->interrupt();
}

static void play_window(hal_tape_t* t) {
  const uint16_t at = t->window;
  interrupt(t);
  if (t->window == at) {
    t->torn = true;  // it did not read its results
    t->window++;
  }
}

// Plays the windows that came by the end of the present call of the control step. A window makes calls, too, which
// count and play nothing: one that came behind it, while the same call went on, has the number that is reached then.
void tape_play_windows(void) {
  hal_tape_t* const t = &hal_tape;
  if (t->mode != TAPE_PLAYS || t->playing) return;
  t->playing = true;
  while (t->window < t->period.window_count && (t->stepped || t->period.windows[t->window].call <= t->call)) {
    play_window(t);
  }
  t->playing = false;
}

void tape_begin_step(void) {
  const hal_tape_t* const t = &hal_tape;
  if (t->mode == TAPE_RECORDS && t->stepped) interrupt(t);
  tape_play_windows();
}

static uint16_t word_of(tape_work_t work) { return (uint16_t)((uint16_t)work | (hal_tape.stepped ? 0u : WORK_EARLY)); }

bool hal_tape_has_work(tape_work_t work) {
  const hal_tape_t* const t = &hal_tape;
  if (t->mode != TAPE_PLAYS) return true;
  return t->work < t->period.work_count && (t->period.works[t->work] & WORK_WHICH) == word_of(work);
}

static void note_work(uint16_t word) {
  tape_period_t* const p = &hal_tape.period;
  if (p->work_count < TAPE_WORKS) {
    p->works[p->work_count++] = (uint16_t)(word | p->window_count << WORK_WINDOWS_LSB);
  } else {
    hal_tape.torn = true;
  }
}

// The windows that came before it.
static void play_work(hal_tape_t* t) {
  if (t->work >= t->period.work_count) {
    t->torn = true;
    return;
  }
  const uint16_t windows = (uint16_t)(t->period.works[t->work++] >> WORK_WINDOWS_LSB);
  t->playing = true;
  while (t->window < windows && t->window < t->period.window_count) play_window(t);
  t->playing = false;
}

static void take_ended_period(void) {
  const hal_tape_t* const t = &hal_tape;
  if (t->mode == TAPE_RECORDS && t->ended) interrupt(t);
}

void hal_tape_work_begin(tape_work_t work) {
  take_ended_period();
  hal_tape.working = true;
  if (hal_tape.mode == TAPE_RECORDS) note_work(word_of(work));
  if (tape_plays()) play_work(&hal_tape);
}

void hal_tape_work_end(void) {
  hal_tape.working = false;
  take_ended_period();
}

bool hal_tape_end_period(void) {
  hal_tape_t* const t = &hal_tape;
  const bool whole = t->stepped && !t->working;
  t->ended = !whole && (t->stepping || t->stepped);
  return whole;
}

bool hal_tape_finish_period(void) {
  hal_tape_t* const t = &hal_tape;
  tape_play_windows();
  const bool left = t->input != t->period.input_count || t->work != t->period.work_count;
  if (t->mode == TAPE_PLAYS && left) t->torn = true;
  return !t->torn;
}

void tape_pass_call(void) {
  hal_tape_t* const t = &hal_tape;
  if (!t->stepping) return;
  t->call++;
  tape_play_windows();
}

uint16_t tape_take(void) {
  hal_tape_t* const t = &hal_tape;
  if (t->input < t->period.input_count) return t->period.inputs[t->input++];
  t->torn = true;
  return 0u;
}

uint16_t tape_note(uint16_t value) {
  tape_period_t* const p = &hal_tape.period;
  if (hal_tape.mode == TAPE_RECORDS) {
    if (p->input_count < TAPE_INPUTS) {
      p->inputs[p->input_count++] = value;
    } else {
      hal_tape.torn = true;
    }
  }
  return value;
}

static void tell(tape_period_t* p, uint16_t word) {
  if (p->output_count < TAPE_OUTPUTS) {
    p->outputs[p->output_count++] = word;
  } else {
    hal_tape.torn = true;
  }
}

void tape_tell(tape_told_t what, const uint16_t* words, uint16_t count) {
  if (hal_tape.mode == TAPE_OFF) return;
  tell(&hal_tape.period, (uint16_t)what);
  for (uint16_t k = 0u; k < count; k++) tell(&hal_tape.period, words[k]);
}

void tape_take_results(uint16_t* results, uint16_t count) {
  hal_tape_t* const t = &hal_tape;
  const bool present = t->window < t->period.window_count;
  for (uint16_t k = 0u; k < count; k++) results[k] = present ? t->period.windows[t->window].results[k] : 0u;
  if (present) {
    t->window++;
  } else {
    t->torn = true;
  }
}

void tape_note_results(const uint16_t* results, uint16_t count) {
  hal_tape_t* const t = &hal_tape;
  if (t->mode != TAPE_RECORDS) return;
  if (t->period.window_count >= TAPE_WINDOWS) {
    t->torn = true;
    return;
  }
  tape_window_t* const w = &t->period.windows[t->period.window_count++];
  w->call = t->stepped ? TAPE_BEHIND : t->call;
  for (uint16_t k = 0u; k < TAPE_RESULTS; k++) w->results[k] = (k < count) ? results[k] : 0u;
}
