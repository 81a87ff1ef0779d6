#include "firmware/hil/hil.h"

#include <stddef.h>

#include "firmware/drive.h"
#include "firmware/hil/delta.h"
#include "firmware/link/crc.h"
#include "firmware/store/store.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_sci.h"
#include "hal/hal_tape.h"
#include "hal/hal_time.h"

#define ANSWER_MAX 200u  // 50 words of up to three octets and a mask for eight of them; sequence and check sum

typedef struct {
  bool active, leaving;
  volatile uint16_t heartbeat;
  uint16_t expected;
  uint16_t answer[ANSWER_MAX];  // of the last step, to be given again
  uint16_t count;
  uint32_t heard;  // cycles
  uint16_t step_before[HIL_STEP_WORDS];
  uint16_t answer_before[HIL_ANSWER_WORDS];
} hil_t;

static hil_t hil;

void hil_reset(void) {
  static const hil_t empty = {0};
  hil = empty;
  hal_tape_start(TAPE_OFF, NULL);
}

bool hil_is_active(void) { return hil.active; }

uint16_t hil_expected(void) { return hil.expected; }

uint16_t hil_heartbeat(uint16_t of_drive) { return hil.active ? hil.heartbeat : of_drive; }

// The board's own interrupts while the drive's are stepped.
static void own_interrupt(void) {
  if (!hil.leaving) hil.heartbeat++;
  hal_sci_service();
  hal_irq_control_end();
}

// No burst is triggered any more. The last one's interrupt has nobody to take its results, so none follows.
static void own_window(void) {}

static void stop_bursts(void) {
  hal_pwm_frame_t none;
  for (uint16_t k = 0; k < HAL_PWM_LEGS; k++) none.rise_tick[k] = none.fall_tick[k] = HAL_PWM_NONE;
  for (uint16_t k = 0; k < HAL_PWM_WINDOWS; k++) none.burst_start_tick[k] = none.burst_end_tick[k] = HAL_PWM_NONE;
  (void)hal_pwm_write(&none, HAL_PWM_LAST_TICK);
}

hil_result_t hil_enter(void) {
  // In the loop already, the drive only believes that its power stage is on: it may begin anew at any time.
  if (!hil.active && (drive_is_energised() || !hal_pwm_is_tripped())) return HIL_ENERGISED;
  if (store_is_busy()) return HIL_BUSY;
  hal_tape_start(TAPE_OFF, NULL);
  hal_irq_install(own_interrupt, own_window);
  hal_pwm_gates_off();
  stop_bursts();
  drive_reset();
  hil_reset();
  hil.active = true;
  hil.heard = hal_time_cycles();
  hal_tape_start(TAPE_PLAYS, drive_window_interrupt);
  hal_irq_enable();
  return HIL_OK;
}

hil_result_t hil_leave(void) {
  if (!hil.active) return HIL_NOT_ACTIVE;
  hil.leaving = true;
  return HIL_OK;
}

void hil_service(void) {
  if (hil.active && hal_time_cycles() - hil.heard > HIL_REST_S * HAL_TIME_CYCLES_PER_S) hil.leaving = true;
}

static void fill(tape_period_t* p, const uint16_t* words) {
  const uint16_t results = words[1];
  const uint16_t* from = &words[HIL_STEP_SHAPE];
  p->window_count = words[0];
  p->input_count = words[2];
  for (uint16_t k = 0; k < p->input_count; k++) p->inputs[k] = *from++;
  for (uint16_t k = 0; k < p->window_count; k++) {
    p->windows[k].call = *from++;
    for (uint16_t n = 0; n < results; n++) p->windows[k].results[n] = *from++;
  }
}

// Only a step that is whole becomes the one before the next.
static bool read_step(octet_reader_t* r, tape_period_t* p) {
  static uint16_t words[HIL_STEP_WORDS];  // much for a stack
  delta_take(r, words, hil.step_before, HIL_STEP_SHAPE);
  if (words[0] > TAPE_WINDOWS || words[1] > TAPE_RESULTS || words[2] > TAPE_INPUTS) return false;
  const uint16_t count = (uint16_t)(words[2] + words[0] * (1u + words[1]));
  delta_take(r, &words[HIL_STEP_SHAPE], &hil.step_before[HIL_STEP_SHAPE], count);
  if (!octets_fit(r)) return false;
  for (uint16_t k = 0; k < HIL_STEP_SHAPE + count; k++) hil.step_before[k] = words[k];
  fill(p, words);
  return true;
}

static void play(void) {
  hal_tape_step_begin();
  drive_control_step(&drive);
  hal_tape_step_end();
  background_step(&drive);
}

void hil_put_answer(octet_writer_t* w, uint16_t sequence, bool torn, const tape_period_t* p, uint16_t* before) {
  const uint16_t shape[HIL_ANSWER_SHAPE] = {torn ? 1u : 0u, p->output_count};
  put_u16(w, sequence);
  delta_put(w, shape, before, HIL_ANSWER_SHAPE);
  delta_put(w, p->outputs, &before[HIL_ANSWER_SHAPE], p->output_count);
  put_u32(w, hil_signals_crc());
  for (uint16_t k = 0; k < HIL_ANSWER_SHAPE; k++) before[k] = shape[k];
  for (uint16_t k = 0; k < p->output_count; k++) before[HIL_ANSWER_SHAPE + k] = p->outputs[k];
}

static void write_answer(bool torn) {
  octet_writer_t w = octet_writer(hil.answer, ANSWER_MAX);
  hil_put_answer(&w, hil.expected, torn, &hal_tape.period, hil.answer_before);
  hil.count = w.count;
}

hil_result_t hil_step(octet_reader_t* step, octet_writer_t* answer) {
  if (!hil.active) return HIL_NOT_ACTIVE;
  const uint16_t sequence = take_u16(step);
  hil.heard = hal_time_cycles();
  const bool again = hil.count > 0u && sequence == (uint16_t)(hil.expected - 1u);
  if (!again) {
    if (sequence != hil.expected) return HIL_SEQUENCE;
    hal_tape_next_period();
    if (!read_step(step, &hal_tape.period)) {
      hal_tape_next_period();
      return HIL_FORMAT;
    }
    play();
    write_answer(!hal_tape_finish_period());
    hil.expected++;
  }
  for (uint16_t k = 0; k < hil.count; k++) put_u8(answer, hil.answer[k]);
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
#define SIGNAL(name, unit, q, value, meaning) crc = add_i32(crc, s.name);
#include "firmware/signal_list.h"
#undef SIGNAL
  return crc32_end(crc);
}
