// Heat sink and overload: the current limit falls first, then the drive faults.
//
// The mean square of the phase current over the overload's time constant is held against that of the current that may
// flow for ever, the motor's rated one unless it is said to be another (I^2 t: what the winding's copper loss heats).
// Where neither is given it is half of the current limit, safe where that is up to twice the rated current.
// From 0.9 of that current on the limit falls in a straight line to it.

#include "control/rise.h"
#include "firmware/board/functions.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/sampling.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "hal/hal_board.h"
#include "hal/qmath/qcall.h"

#define TURN 8u           // ms between two looks
#define SLOW_SETTLES 3u   // ms from the choice of the converter's input to its code
#define SENSOR_MARGIN 32  // codes beyond the table: a broken wire, a short circuit
#define HEAT_ONE_Q24 16777216L
#define SHARE_END_Q12 46340L  // its square fits

static const int16_t ntc[BOARD_NTC_POINTS] = BOARD_NTC_CODES;

// Between the table's points straight lines; the codes fall.
static int32_t celsius_q8(int32_t code) {
  uint16_t k = 1;
  while (k < BOARD_NTC_POINTS - 1u && code < ntc[k]) k++;
  const int32_t rest = q_div(ntc[k - 1u] - code, ntc[k - 1u] - ntc[k], 8);
  return (int32_t)BOARD_NTC_FIRST * 256 + (int32_t)BOARD_NTC_STEP * ((int32_t)(k - 1u) * 256 + rest);
}

// Share left between `from` (all) and `to` (the share at the end).
static int32_t share_between(int32_t value, int32_t from, int32_t to, int32_t end_q15) {
  return INTERLOCK_SHARE_ONE - qc_mul(rise_q30(value, from, to), INTERLOCK_SHARE_ONE - end_q15, 30);
}

static drive_fault_t follow_heat_sink(int32_t* share_q15) {
  const int32_t code = (int32_t)sampling_auxiliary();
  const bool broken = code > ntc[0] + SENSOR_MARGIN || code < ntc[BOARD_NTC_POINTS - 1u] - SENSOR_MARGIN;
  board.heat_sink_q8 = celsius_q8(code);
  known_beside = broken ? 0u : KNOWN_HEAT_SINK;
  if (broken || board.heat_sink_q8 > parameters.temperature_limit) return FAULT_TEMPERATURE;
  *share_q15 = share_between(board.heat_sink_q8, parameters.temperature_derating, parameters.temperature_limit,
                             INTERLOCK_SHARE_ONE / 2);
  return FAULT_NONE;
}

int32_t board_lasting_current(void) {
  const config_values_t* const v = &drive.config.values;
  if (v->overload_current >= 0) return v->overload_current;
  return (v->rated_current != 0) ? v->rated_current : v->current_limit / 2;
}

// Square of the current, of that which may flow for ever; saturated at eleven times that current.
static int32_t heating_q24(int32_t ever_q20) {
  const dq_t i = drive.estimate.measured_q20;
  const int32_t share_q12 = q_min(q_div(q_hypot(i.d, i.q), ever_q20, 12), SHARE_END_Q12);
  return drive_is_energised() ? share_q12 * share_q12 : 0;
}

static drive_fault_t follow_overload(int32_t ever_q20, int32_t* share_q15) {
  board.heat_q24 += (heating_q24(ever_q20) - board.heat_q24) / (drive.config.values.overload_time / (int32_t)TURN);
  const int32_t end_q15 = q_min(INTERLOCK_SHARE_ONE, q_div(ever_q20, drive.config.values.current_limit, 15));
  *share_q15 = q_min(*share_q15, share_between(board.heat_q24, HEAT_ONE_Q24 / 5 * 4, HEAT_ONE_Q24, end_q15));
  return board.heat_q24 > HEAT_ONE_Q24 / 10 * 11 ? FAULT_OVERLOAD : FAULT_NONE;
}

int32_t board_current_share(void) { return board.share_q15; }

drive_fault_t board_follow_heat(void) {
  if ((board.at_ms & (TURN - 1u)) != 0u) return FAULT_NONE;
  int32_t share_q15 = INTERLOCK_SHARE_ONE;
  drive_fault_t fault = FAULT_NONE;
  if (parameters.temperature_limit != 0 && drive.state != DRIVE_CALIBRATE) {
    fault = follow_heat_sink(&share_q15);
  } else {
    known_beside = 0u;
  }
  const int32_t ever_q20 = board_lasting_current();
  if (ever_q20 != 0) {
    const drive_fault_t overload = follow_overload(ever_q20, &share_q15);
    if (fault == FAULT_NONE) fault = overload;
  }
  board.share_q15 = (uint16_t)share_q15;
  return fault;
}
