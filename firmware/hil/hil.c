#include "firmware/hil/hil.h"

#include <stddef.h>

#include "firmware/drive.h"
#include "firmware/link/crc.h"
#include "firmware/store/store.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_sci.h"
#include "hal/hal_tape.h"

#define ANSWER_MAX (2u + 1u + 1u + 2u * TAPE_OUTPUTS + 4u)

typedef struct {
  bool active, leaving;
  volatile uint16_t heartbeat;
  uint16_t expected;
  uint16_t answer[ANSWER_MAX];  // of the last step, to be given again
  uint16_t count;
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
  hal_tape_start(TAPE_PLAYS, drive_window_interrupt);
  hal_irq_enable();
  return HIL_OK;
}

hil_result_t hil_leave(void) {
  if (!hil.active) return HIL_NOT_ACTIVE;
  hil.leaving = true;
  return HIL_OK;
}

static bool read_windows(octet_reader_t* r, tape_period_t* p) {
  const uint16_t words = take_u8(r);
  p->window_count = take_u8(r);
  if (words > TAPE_RESULTS || p->window_count > TAPE_WINDOWS) return false;
  for (uint16_t k = 0; k < p->window_count; k++) {
    p->windows[k].call = take_u16(r);
    for (uint16_t n = 0; n < words; n++) p->windows[k].results[n] = take_u16(r);
  }
  return true;
}

static bool read_inputs(octet_reader_t* r, tape_period_t* p) {
  p->input_count = take_u8(r);
  if (p->input_count > TAPE_INPUTS) return false;
  for (uint16_t k = 0; k < p->input_count; k++) p->inputs[k] = take_u16(r);
  return true;
}

static void play(void) {
  hal_tape_step_begin();
  drive_control_step(&drive);
  hal_tape_step_end();
  background_step(&drive);
}

static void write_answer(bool torn) {
  const tape_period_t* const p = &hal_tape.period;
  octet_writer_t w = octet_writer(hil.answer, ANSWER_MAX);
  put_u16(&w, hil.expected);
  put_u8(&w, torn ? 1u : 0u);
  put_u8(&w, p->output_count);
  for (uint16_t k = 0; k < p->output_count; k++) put_u16(&w, p->outputs[k]);
  put_u32(&w, hil_signals_crc());
  hil.count = w.count;
}

hil_result_t hil_step(octet_reader_t* step, octet_writer_t* answer) {
  if (!hil.active) return HIL_NOT_ACTIVE;
  const uint16_t sequence = take_u16(step);
  const bool again = hil.count > 0u && sequence == (uint16_t)(hil.expected - 1u);
  if (!again) {
    if (sequence != hil.expected) return HIL_SEQUENCE;
    hal_tape_next_period();
    if (!read_windows(step, &hal_tape.period) || !read_inputs(step, &hal_tape.period) || !octets_fit(step)) {
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
