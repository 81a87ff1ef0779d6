// A drive without a host: a switch starts and stops it, a voltage is its speed.
//
// The converter's last place in a window is the heat sink's input, and three milliseconds in eight the speed command's:
// both halves of that pair see the DC link, so the drive does not notice. With the live zero (speed_input 2) the range
// is 10 % to 90 % of 3 V, and what lies beyond 5 % or 95 % is a broken wire or a short circuit. A lost signal stops the
// drive; it runs again when the switch has been opened and closed. The same clears a fault.

#include "firmware/api/comm_watchdog.h"
#include "firmware/board/functions.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/sampling.h"
#include "firmware/mode/mode.h"
#include "hal/hal_adc.h"
#include "hal/hal_digital_io.h"
#include "hal/qmath/qcall.h"

#define ONE_Q15 ((int32_t)32768)
#define TURN 8u
#define CHOOSE_AT 1u  // of the turn; the heat sink is read at 0
#define READ_AT 4u
#define LIVE_ZERO 2
#define LOST_MS 20u
#define LOW_CODE 205    // 5 %
#define HIGH_CODE 3891  // 95 %
#define LIVE_FIRST 410  // 10 %
#define LIVE_SPAN 3276  // 80 %
#define SPAN 4095

// The switch decides, the voltage says how fast.
static void follow_switch(void) {
  const bool on = hal_digital_io_run();
  if (!on) board.input = SPEED_INPUT_WAITS;
  if (on == board.switch_closed) return;
  board.switch_closed = on;
  if (!on) {
    drive_command_stop();
    if (drive.state == DRIVE_FAULT) drive_command_reset();
  } else if (drive.state == DRIVE_READY) {
    board.input = SPEED_INPUT_RUNS;
    comm_watchdog_begin(COMM_WATCHDOG_OWN, 0);
    drive_command_start();
  }
}

static void lose(void) {
  if (board.input == SPEED_INPUT_LOST) return;
  board.input = SPEED_INPUT_LOST;
  if (parameters.speed_input_loss == 2) {
    drive_command_coast();
  } else {
    drive_command_stop();
  }
}

static void take(int32_t code) {
  const bool live = parameters.speed_input == LIVE_ZERO;
  const bool lost = live && (code < LOW_CODE || code > HIGH_CODE);
  board.lost_ms = lost ? (uint16_t)(board.lost_ms + TURN) : 0u;
  if (board.lost_ms > LOST_MS) lose();
  if (lost || board.input != SPEED_INPUT_RUNS) return;
  const int32_t share_q15 = live ? q_div(code - LIVE_FIRST, LIVE_SPAN, 15) : q_div(code, SPAN, 15);
  const int32_t dead_q15 = qc_mul(parameters.speed_input_dead, 21474836L, 32);
  const int32_t beyond = q_clamp(share_q15, 0, ONE_Q15) - dead_q15;
  const int32_t reference = beyond <= 0 ? 0 : q_div(beyond, ONE_Q15 - dead_q15, 15);
  drive_command_speed(qc_mul(parameters.speed_input_full * 256, reference, 15));
}

void board_follow_speed_input(void) {
  if (parameters.speed_input == 0) {
    board.input = SPEED_INPUT_OFF;
    board.switch_closed = true;
    return;
  }
  follow_switch();
  const uint16_t at = (uint16_t)(board.at_ms & (TURN - 1u));
  if (at == CHOOSE_AT) hal_adc_choose_slow(true);
  if (at != READ_AT) return;
  board.code = sampling_auxiliary();
  hal_adc_choose_slow(false);
  take((int32_t)board.code);
}
