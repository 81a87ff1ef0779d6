#include "firmware/hil/hil.h"

#include <stddef.h>

#include "firmware/api/status.h"
#include "firmware/base/clear.h"
#include "firmware/base/crc.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/signals.h"
#include "firmware/drive/steps.h"
#include "firmware/hil/delta.h"
#include "firmware/mode/mode.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_replay.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"

typedef struct {
  bool leaving;
  bool answered, torn;  // a step has been, which may be asked for again; the last one
  uint16_t expected;
  uint32_t heard;                  // cycles
  uint16_t shape[HIL_STEP_SHAPE];  // of the last step, whose words are in the recording
  hil_answer_t before;             // the answer before the last
} hil_t;

static hil_t hil;

void hil_reset(void) {
  clear(&hil, sizeof hil);
  feature_status.stepped = false;
  feature_status.heartbeat = 0u;
  hal_replay_start(REPLAY_OFF, NULL);
}

uint16_t hil_expected(void) { return hil.expected; }

// The board's own interrupts while the drive's are stepped.
static void own_interrupt(void) {
  if (!hil.leaving) feature_status.heartbeat++;
  hal_sci_service();
  hal_irq_control_end();
}

// No burst is triggered any more. The last one's interrupt has nobody to take its results, so none follows.
static void own_window(void) {}

static void stop_bursts(void) {
  hal_pwm_frame_t none;
  for (uint16_t k = 0; k < HAL_PWM_LEGS; k++) none.edge_tick[k] = none.edge_tick[HAL_PWM_LEGS + k] = HAL_PWM_NONE;
  for (uint16_t k = 0; k < HAL_PWM_WINDOWS; k++) none.burst_start_tick[k] = none.burst_end_tick[k] = HAL_PWM_NONE;
  (void)hal_pwm_write(&none, HAL_PWM_LAST_TICK);
}

// The words that the first step is given against.
static void clear_recording(void) {
  replay_period_t* const p = &hal_replay_period;
  for (uint16_t k = 0; k < REPLAY_INPUTS; k++) p->inputs[k] = 0u;
  for (uint16_t k = 0; k < REPLAY_WORKS; k++) p->works[k] = 0u;
  for (uint16_t k = 0; k < REPLAY_WINDOWS; k++) {
    p->windows[k].call = 0u;
    for (uint16_t n = 0; n < REPLAY_RESULTS; n++) p->windows[k].results[n] = 0u;
  }
}

hil_result_t hil_enter(void) {
  // In the loop already, the drive only believes that its power stage is on: it may begin anew at any time.
  if (!feature_status.stepped && (drive_is_energised() || !hal_pwm_is_tripped())) return HIL_ENERGISED;
  if (feature_status.store_work != 0u) return HIL_BUSY;
  hal_replay_start(REPLAY_OFF, NULL);
  hal_irq_install(own_interrupt, own_window);
  hal_pwm_gates_off();
  stop_bursts();
  drive_reset();
  hil_reset();
  feature_status.stepped = true;
  hil.heard = hal_time_cycles();
  clear_recording();
  hal_replay_start(REPLAY_PLAYS, drive_window_interrupt);
  hal_irq_enable();
  return HIL_OK;
}

hil_result_t hil_leave(void) {
  if (!feature_status.stepped) return HIL_NOT_ACTIVE;
  hil.leaving = true;
  return HIL_OK;
}

void hil_service(void) {
  if (feature_status.stepped && hal_time_cycles() - hil.heard > HIL_REST_S * HAL_TIME_CYCLES_PER_S) hil.leaving = true;
}

static void take_window(octet_reader_t* r, replay_window_t* w, uint16_t results) {
  uint16_t words[HIL_WINDOW_WORDS] = {w->call};
  for (uint16_t k = 0; k < results; k++) words[1u + k] = w->results[k];
  delta_take(r, words, words, (uint16_t)(1u + results));
  w->call = words[0];
  for (uint16_t k = 0; k < results; k++) w->results[k] = words[1u + k];
}

// Whether what is left is one step of a shape, neither more nor less.
static bool is_whole(octet_reader_t r, const uint16_t* shape) {
  uint16_t any[REPLAY_INPUTS] = {0};
  if (shape[0] > REPLAY_WINDOWS || shape[1] > REPLAY_RESULTS || shape[2] > REPLAY_INPUTS) return false;
  if (shape[3] > REPLAY_WORKS) return false;
  delta_take(&r, any, any, shape[3]);
  delta_take(&r, any, any, shape[2]);
  for (uint16_t k = 0; k < shape[0]; k++) delta_take(&r, any, any, (uint16_t)(1u + shape[1]));
  return octets_fit(&r);
}

// Into the recording, which still has the words of the step before. Nothing is changed by a step that is not whole.
static bool take_step(octet_reader_t* r) {
  uint16_t shape[HIL_STEP_SHAPE];
  delta_take(r, shape, hil.shape, HIL_STEP_SHAPE);
  if (!is_whole(*r, shape)) return false;
  for (uint16_t k = 0; k < HIL_STEP_SHAPE; k++) hil.shape[k] = shape[k];
  if (hil.answered) hil_keep_answer(&hil.before, hil.torn, &hal_replay_period);
  hal_replay_next_period();
  replay_period_t* const p = &hal_replay_period;
  p->window_count = shape[0];
  p->input_count = shape[2];
  p->work_count = shape[3];
  delta_take(r, p->works, p->works, p->work_count);
  delta_take(r, p->inputs, p->inputs, p->input_count);
  for (uint16_t k = 0; k < p->window_count; k++) take_window(r, &p->windows[k], shape[1]);
  return true;
}

// As long as the recording has work that was done on this side of the step.
static void play_work(void) {
  uint16_t done;
  do {
    done = hal_replay.work;
    background_step(&drive);
  } while (hal_replay.work != done);
}

static void play(void) {
  play_work();
  hal_replay_step_begin();
  drive_control_step(&drive);
  hal_replay_step_end();
  play_work();
}

static uint16_t outputs_of(const replay_period_t* p) { return (uint16_t)q_min(p->output_count, REPLAY_OUTPUTS); }

static void shape_of(uint16_t* shape, bool torn, const replay_period_t* p) {
  shape[0] = torn ? 1u : 0u;
  shape[1] = p->output_count;
}

void hil_put_answer(octet_writer_t* w, uint16_t sequence, bool torn, const replay_period_t* p,
                    const hil_answer_t* before) {
  uint16_t shape[HIL_ANSWER_SHAPE];
  shape_of(shape, torn, p);
  put_u16(w, sequence);
  delta_put(w, shape, before->shape, HIL_ANSWER_SHAPE);
  delta_put(w, p->outputs, before->outputs, outputs_of(p));
  put_u32(w, hil_signals_crc());
}

void hil_keep_answer(hil_answer_t* before, bool torn, const replay_period_t* p) {
  shape_of(before->shape, torn, p);
  const uint16_t count = outputs_of(p);
  for (uint16_t k = 0; k < count; k++) before->outputs[k] = p->outputs[k];
}

// Nothing changes a signal between two steps, so an answer that is asked for again is the same.
hil_result_t hil_step(octet_reader_t* step, octet_writer_t* answer) {
  if (!feature_status.stepped) return HIL_NOT_ACTIVE;
  const uint16_t sequence = take_u16(step);
  hil.heard = hal_time_cycles();
  const bool again = hil.answered && sequence == (uint16_t)(hil.expected - 1u);
  if (!again) {
    if (sequence != hil.expected) return HIL_SEQUENCE;
    if (!take_step(step)) return HIL_FORMAT;
    play();
    hil.torn = !hal_replay_finish_period();
    hil.answered = true;
    hil.expected++;
  }
  hil_put_answer(answer, sequence, hil.torn, &hal_replay_period, &hil.before);
  return HIL_OK;
}

static uint32_t add_i32(uint32_t crc, int32_t value) {
  uint32_t rest = (uint32_t)value;
  for (uint16_t k = 0; k < 4u; k++) {
    crc = crc32_add(crc, (uint16_t)(rest & 0xFFuL));
    rest >>= 8;
  }
  return crc;
}

uint32_t hil_signals_crc(void) {
  const drive_signals_t s = drive_signals();
  uint32_t crc = CRC32_BEGIN;
  const int32_t* const values = (const int32_t*)(const void*)&s;
  for (uint16_t k = 0; k < signal_count(); k++) crc = add_i32(crc, values[k]);
  return crc32_end(crc);
}
