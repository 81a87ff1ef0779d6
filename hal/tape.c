#include <stddef.h>

#include "hal/hal_tape.h"

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
  hal_tape.input = 0u;
  hal_tape.window = 0u;
  hal_tape.torn = false;
  hal_tape.period.input_count = 0u;
  hal_tape.period.output_count = 0u;
  hal_tape.period.window_count = 0u;
}

// Plays the windows that came by the end of the present call of the control step. A window makes calls, too, which
// count and play nothing: one that came behind it, while the same call went on, has the number that is reached then.
void tape_play_windows(void) {
  hal_tape_t* const t = &hal_tape;
  if (t->mode != TAPE_PLAYS || t->playing) return;
  t->playing = true;
  while (t->window < t->period.window_count && (t->stepped || t->period.windows[t->window].call <= t->call)) {
    const uint16_t at = t->window;
    t->interrupt();
    if (t->window == at) {
      t->torn = true;  // it did not read its results
      t->window++;
    }
  }
  t->playing = false;
}

void tape_begin_step(void) {
  const hal_tape_t* const t = &hal_tape;
  if (t->mode == TAPE_RECORDS && t->stepped) t->interrupt();
  tape_play_windows();
}

bool hal_tape_has_work(tape_work_t work) {
  const hal_tape_t* const t = &hal_tape;
  if (t->mode != TAPE_PLAYS) return true;
  return t->input < t->period.input_count && t->period.inputs[t->input] == (uint16_t)work;
}

void hal_tape_work_begin(tape_work_t work) {
  hal_tape.working = true;
  if (tape_plays()) {
    (void)tape_take();
  } else {
    (void)tape_note((uint16_t)work);
  }
}

bool hal_tape_finish_period(void) {
  hal_tape_t* const t = &hal_tape;
  tape_play_windows();
  if (t->mode == TAPE_PLAYS && t->input != t->period.input_count) t->torn = true;
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

void tape_tell(tape_told_t what, const uint16_t* words, uint16_t count) {
  tape_period_t* const p = &hal_tape.period;
  if (hal_tape.mode == TAPE_OFF) return;
  if (p->output_count + count >= TAPE_OUTPUTS) {
    hal_tape.torn = true;
    return;
  }
  p->outputs[p->output_count++] = (uint16_t)what;
  for (uint16_t k = 0u; k < count; k++) p->outputs[p->output_count++] = words[k];
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
