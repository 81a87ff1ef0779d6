#include "firmware/board/functions.h"

#include "firmware/api/status.h"
#include "firmware/base/clear.h"
#include "firmware/board/selftest.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/text.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_irq.h"
#include "hal/qmath/qcall.h"

#define POWERED_SHARE 8  // a DC link below an eighth of the threshold is not being charged
#define SILENT_MAX 20u   // ms: the gate enable's own time and some
#define BRAKE_SHIFT 13   // the mean over 8192 ms
#define BRAKE_ONE ((int32_t)1073741824L)

board_t board;

void board_reset(void) {
  clear(&board, sizeof board);
  known_beside = 0u;
  board.share_q15 = INTERLOCK_SHARE_ONE;
  board.switch_closed = true;  // a switch that is closed at power-on starts nothing
  selftest_reset();
}

static void report(drive_fault_t fault) {
  if (fault == FAULT_NONE) return;
  const uint16_t state = hal_irq_disable();
  drive_trip(&drive, fault);
  hal_irq_restore(state);
}

// Outputs only where something hangs on them.
static void wire(void) {
  if (!board.wired && (parameters.precharge_voltage != 0 || parameters.brake_voltage != 0)) {
    hal_digital_io_init();
    board.wired = true;
  }
  if (!board.stop_wired && parameters.emergency_stop != 0) {
    hal_digital_io_wire_emergency();
    board.stop_wired = true;
  }
}

static void switch_relay(bool on) {
  if (on == board.relay) return;
  board.relay = on;
  hal_digital_io_relay(on);
}

// The relay closes when the link is charged, and opens when it has lost its supply: the next charge must find it open.
static drive_fault_t precharge(void) {
  const int32_t full = parameters.precharge_voltage;
  const int32_t link = drive.samples.link_q16;
  if (full == 0) return FAULT_NONE;
  if (link >= full) switch_relay(true);
  if (link < full / 4 * 3 && !drive_is_energised()) switch_relay(false);
  const bool charging = !board.relay && link > full / POWERED_SHARE;
  board.charging_ms = charging ? (uint16_t)(board.charging_ms + 1u) : 0u;
  if (board.charging_ms <= (uint16_t)parameters.precharge_time) return FAULT_NONE;
  board.charging_ms = 0;
  return FAULT_PRECHARGE;
}

// With the gates off, too: the diodes of a fast shaft charge the link as well.
static void brake(void) {
  const int32_t on = parameters.brake_voltage;
  if (on == 0 || !board.wired) return;
  const int32_t link = drive.samples.link_q16;
  const bool braking = link > on || (board.braking && link > on - parameters.brake_hysteresis);
  if (braking != board.braking) hal_digital_io_brake(braking);
  board.braking = braking;
}

// The gates off: what charges the link must stop before the resistor burns.
static drive_fault_t watch_brake(void) {
  if (parameters.brake_voltage == 0) return FAULT_NONE;
  board.brake_mean_q30 += q_shr((board.braking ? BRAKE_ONE : 0) - board.brake_mean_q30, BRAKE_SHIFT);
  const int32_t most_q30 = qc_mul(parameters.brake_share, 10737418L, 16);
  return board.brake_mean_q30 > most_q30 ? FAULT_BRAKE_RESISTOR : FAULT_NONE;
}

static drive_fault_t watch_enable(void) {
  if (parameters.gate_feedback == 0) return FAULT_NONE;
  board.silent_ms = hal_digital_io_gates_pass() ? 0u : (uint16_t)(board.silent_ms + 1u);
  return board.silent_ms > SILENT_MAX ? FAULT_GATE_ENABLE : FAULT_NONE;
}

void board_service(void) {
  if (feature_status.stepped) return;
  brake();
  report(selftest_service());
  if (board.at_ms == drive.time_ms) return;
  board.at_ms = drive.time_ms;
  wire();
  if (drive.state == DRIVE_BOOT) return;
  report(interlock_emergency());
  report(watch_enable());
  report(precharge());
  report(watch_brake());
  report(board_follow_heat());
  report(board_follow_shaft());
  drive.control.current_limit_q20 = interlock_current_limit();
  board_follow_speed_input();
}

drive_fault_t board_refusal(void) {
  return drive.config.values.precharge_voltage != 0 && !board.relay ? FAULT_PRECHARGE : FAULT_NONE;
}

static void put_item(octet_writer_t* w, board_words_t word) {
  put_message(w, CATALOGUE_BOARD, (uint16_t)word);
  put_packed(w, SAY_semicolon);
}

static void put_number(octet_writer_t* w, board_words_t word, int32_t value, uint16_t q, packed_text_t unit) {
  put_message(w, CATALOGUE_BOARD, (uint16_t)word);
  put_u8(w, ' ');
  put_fixed(w, value, q, 0);
  put_packed(w, unit);
}

static void put_board(octet_writer_t* w) {
  if (parameters.emergency_stop != 0) put_item(w, hal_digital_io_emergency() ? BOARD_PRESSED : BOARD_RELEASED);
  if (parameters.precharge_voltage != 0) put_item(w, board.relay ? BOARD_CHARGED : BOARD_CHARGING);
  if (parameters.brake_voltage != 0) put_item(w, board.braking ? BOARD_BRAKING : BOARD_NOT_BRAKING);
  if ((known_beside & KNOWN_HEAT_SINK) != 0u) put_number(w, BOARD_HEAT_SINK, board.heat_sink_q8, 8, SAY_celsius);
  if (parameters.speed_input != 0) put_item(w, (board_words_t)((uint16_t)BOARD_INPUT_OFF + (uint16_t)board.input));
  if (parameters.overload_current == 0) put_item(w, BOARD_OVERLOAD_UNWATCHED);
  if (parameters.overload_current < 0 && parameters.rated_current == 0) put_item(w, BOARD_RATED_UNTOLD);
  put_number(w, BOARD_LIMIT_IN_USE, interlock_share_q15 * 25 / 8, 10, SAY_percent);
}

const status_line_t board_line = {SAY_title_board, put_board};
