#include <stddef.h>

#include "hal/hal_replay.h"

// A word of the background's work.
#define WORK_EARLY 8u
#define WORK_WHICH 15u
#define WORK_WINDOWS_LSB 4u

hal_replay_t hal_replay;
replay_period_t hal_replay_period;

void hal_replay_start(replay_mode_t mode, void (*interrupt)(void)) {
  hal_replay.mode = mode;
  hal_replay.interrupt = interrupt;
  hal_replay.stepping = false;
  hal_replay.working = false;
  hal_replay_next_period();
}

void hal_replay_next_period(void) {
  hal_replay.call = 0u;
  hal_replay.stepped = false;
  hal_replay.playing = false;
  hal_replay.ended = false;
  hal_replay.input = 0u;
  hal_replay.window = 0u;
  hal_replay.work = 0u;
  hal_replay.torn = false;
  replay_period_t* const p = &hal_replay_period;
  p->input_count = 0u;
  p->output_count = 0u;
  p->window_count = 0u;
  p->work_count = 0u;
}

static void interrupt(const hal_replay_t* t) {
  if (t->interrupt != NULL) t->interrupt();
}

static void play_window(hal_replay_t* t) {
  const uint16_t at = t->window;
  interrupt(t);
  if (t->window == at) {
    t->torn = true;  // it did not read its results
    t->window++;
  }
}

// Plays the windows that came by the end of the present call of the control step. A window makes calls, too, which
// count and play nothing: one that came behind it, while the same call went on, has the number that is reached then.
void replay_play_windows(void) {
  hal_replay_t* const t = &hal_replay;
  if (t->mode != REPLAY_PLAYS || t->playing) return;
  t->playing = true;
  const replay_period_t* const p = &hal_replay_period;
  while (t->window < p->window_count && (t->stepped || p->windows[t->window].call <= t->call)) {
    play_window(t);
  }
  t->playing = false;
}

void replay_begin_step(void) {
  const hal_replay_t* const t = &hal_replay;
  if (t->mode == REPLAY_RECORDS && t->stepped) interrupt(t);
  replay_play_windows();
}

static uint16_t word_of(replay_work_t work) {
  return (uint16_t)((uint16_t)work | (hal_replay.stepped ? 0u : WORK_EARLY));
}

bool hal_replay_has_work(replay_work_t work) {
  const hal_replay_t* const t = &hal_replay;
  if (t->mode != REPLAY_PLAYS) return true;
  const replay_period_t* const p = &hal_replay_period;
  return t->work < p->work_count && (p->works[t->work] & WORK_WHICH) == word_of(work);
}

static void note_work(uint16_t word) {
  replay_period_t* const p = &hal_replay_period;
  if (p->work_count < REPLAY_WORKS) {
    p->works[p->work_count++] = (uint16_t)(word | p->window_count << WORK_WINDOWS_LSB);
  } else {
    hal_replay.torn = true;
  }
}

// The windows that came before it.
static void play_work(hal_replay_t* t) {
  const replay_period_t* const p = &hal_replay_period;
  if (t->work >= p->work_count) {
    t->torn = true;
    return;
  }
  const uint16_t windows = (uint16_t)(p->works[t->work++] >> WORK_WINDOWS_LSB);
  t->playing = true;
  while (t->window < windows && t->window < p->window_count) play_window(t);
  t->playing = false;
}

static void take_ended_period(void) {
  const hal_replay_t* const t = &hal_replay;
  if (t->mode == REPLAY_RECORDS && t->ended) interrupt(t);
}

void hal_replay_work_begin(replay_work_t work) {
  take_ended_period();
  hal_replay.working = true;
  if (hal_replay.mode == REPLAY_RECORDS) note_work(word_of(work));
  if (replay_plays()) play_work(&hal_replay);
}

void hal_replay_work_end(void) {
  hal_replay.working = false;
  take_ended_period();
}

bool hal_replay_end_period(void) {
  hal_replay_t* const t = &hal_replay;
  const bool whole = t->stepped && !t->working;
  t->ended = !whole && (t->stepping || t->stepped);
  return whole;
}

bool hal_replay_finish_period(void) {
  hal_replay_t* const t = &hal_replay;
  replay_play_windows();
  const replay_period_t* const p = &hal_replay_period;
  const bool left = t->input != p->input_count || t->work != p->work_count;
  if (t->mode == REPLAY_PLAYS && left) t->torn = true;
  return !t->torn;
}

void replay_pass_call(void) {
  hal_replay_t* const t = &hal_replay;
  if (!t->stepping) return;
  t->call++;
  replay_play_windows();
}

uint16_t replay_take(void) {
  hal_replay_t* const t = &hal_replay;
  const replay_period_t* const p = &hal_replay_period;
  if (t->input < p->input_count) return p->inputs[t->input++];
  t->torn = true;
  return 0u;
}

uint16_t replay_note(uint16_t value) {
  replay_period_t* const p = &hal_replay_period;
  if (hal_replay.mode == REPLAY_RECORDS) {
    if (p->input_count < REPLAY_INPUTS) {
      p->inputs[p->input_count++] = value;
    } else {
      hal_replay.torn = true;
    }
  }
  return value;
}

static void tell(replay_period_t* p, uint16_t word) {
  if (p->output_count < REPLAY_OUTPUTS) {
    p->outputs[p->output_count++] = word;
  } else {
    hal_replay.torn = true;
  }
}

void replay_output(replay_output_t what, const uint16_t* words, uint16_t count) {
  if (hal_replay.mode == REPLAY_OFF) return;
  tell(&hal_replay_period, (uint16_t)what);
  for (uint16_t k = 0u; k < count; k++) tell(&hal_replay_period, words[k]);
}

void replay_take_results(uint16_t* results, uint16_t count) {
  hal_replay_t* const t = &hal_replay;
  const replay_period_t* const p = &hal_replay_period;
  const bool present = t->window < p->window_count;
  for (uint16_t k = 0u; k < count; k++) results[k] = present ? p->windows[t->window].results[k] : 0u;
  if (present) {
    t->window++;
  } else {
    t->torn = true;
  }
}

void replay_note_results(const uint16_t* results, uint16_t count) {
  hal_replay_t* const t = &hal_replay;
  if (t->mode != REPLAY_RECORDS) return;
  replay_period_t* const p = &hal_replay_period;
  if (p->window_count >= REPLAY_WINDOWS) {
    t->torn = true;
    return;
  }
  replay_window_t* const w = &p->windows[p->window_count++];
  w->call = t->stepped ? REPLAY_BEHIND : t->call;
  for (uint16_t k = 0u; k < REPLAY_RESULTS; k++) w->results[k] = (k < count) ? results[k] : 0u;
}
