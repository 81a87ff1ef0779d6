#include "torque_limit.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/sampling.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/interlock.h"
#include "firmware/text/text.h"
#include "hal/hal_adc.h"
#include "hal/qmath/qmath.h"

// The converter's last place in a window is the heat sink's input but for three of eight milliseconds, which are those
// of board/speed_input.c.
#define TURN_MS 8u
#define CHOOSE_AT 1u
#define READ_AT 4u
#define FULL_CODE 4095
#define PERCENT_Q15 200  // in a per cent, Q16, as often as in the whole, Q15

static uint32_t at_ms;
static int32_t share_q15;

// So that the drive still starts.
static int32_t least(void) { return parameters.torque_limit_least / PERCENT_Q15; }

void torque_limit_reset(void) {
  at_ms = 0;
  share_q15 = least();
}

void torque_limit_service(void) {
  const uint32_t now_ms = drive_time_ms();
  if (feature_status.stepped || parameters.speed_input != 0 || now_ms == at_ms) return;
  at_ms = now_ms;
  const uint32_t turn = now_ms & (TURN_MS - 1u);
  if (turn == CHOOSE_AT) hal_adc_choose_slow(true);
  if (turn != READ_AT) return;
  const int32_t code = (int32_t)sampling_auxiliary();
  hal_adc_choose_slow(false);
  share_q15 = q_clamp(q_div(code, FULL_CODE, 15), least(), INTERLOCK_SHARE_ONE);
}

int32_t torque_limit_share(void) { return (parameters.speed_input != 0) ? INTERLOCK_SHARE_ONE : share_q15; }

static void put_share(octet_writer_t* w) {
  put_fixed(w, torque_limit_share() * 25 / 8, 10, 0);
  put_packed(w, SAY_percent_of_current_limit);
}

const status_line_t torque_limit_line = {SAY_torque, put_share};
