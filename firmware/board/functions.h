// What the board does beside the gates, in the background: precharge relay, brake resistor, emergency stop, heat sink
// and overload, stalled shaft, gate enable watched, speed command without a host. What needs a wire is off until its
// parameter (400..449) says that there is one, and costs nothing until then; overload and stall are watched unless they
// are switched off. The control interrupt sees no more of it than the current limit in use.
//
// Once a millisecond of the drive's time, the brake resistor in every pass of the background loop. While a computer
// steps the drive (hil/hil.h) the functions rest.

#ifndef STILLSPIN_FIRMWARE_BOARD_FUNCTIONS_H
#define STILLSPIN_FIRMWARE_BOARD_FUNCTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/api/status.h"
#include "firmware/mode/commands.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// What the speed command has come to.
typedef enum { SPEED_INPUT_OFF = 0, SPEED_INPUT_WAITS = 1, SPEED_INPUT_RUNS = 2, SPEED_INPUT_LOST = 3 } speed_input_t;

/// The words of the functions, CATALOGUE_BOARD.
typedef enum {
  BOARD_RELEASED = 0,
  BOARD_PRESSED = 1,
  BOARD_CHARGING = 2,
  BOARD_CHARGED = 3,
  BOARD_NOT_BRAKING = 4,
  BOARD_BRAKING = 5,
  BOARD_INPUT_OFF = 6,  // from here on a speed_input_t
  BOARD_HEAT_SINK = 10,
  BOARD_LIMIT_IN_USE = 11,
  BOARD_RATED_UNTOLD = 12,
  BOARD_OVERLOAD_UNWATCHED = 13
} board_words_t;

typedef struct {
  uint32_t at_ms;          // of the last look
  bool wired, stop_wired;  // outputs, emergency stop set up
  bool relay, braking;     // as commanded
  uint16_t charging_ms;    // the DC link has been on its way for so long
  uint16_t silent_ms;      // the gates should pass and have not for so long
  int32_t brake_mean_q30;  // share of the last seconds in which the brake resistor was on
  int32_t heat_sink_q8;    // degrees C
  int32_t heat_q24;        // mean square of the current, of that which may flow for ever
  uint16_t code;           // of the speed command
  uint16_t lost_ms;        // without a signal for so long
  speed_input_t input;
  bool switch_closed;       // the switch was closed at the last look
  uint16_t stalled_ms;      // the shaft has not got on for so long
  uint32_t stall_from_bam;  // from here
  int32_t stall_back_bpp;   // and turned so fast against the reference
  bool stall_slows;         // which gets less
  uint16_t share_q15;       // of current_limit, left by heat sink and overload
} board_t;

extern board_t board;

void board_reset(void);

/// Background level, once behind every interrupt.
void board_service(void);

/// The precharge against a start (mode/interlock.h).
drive_fault_t board_refusal(void);

/// Of current_limit what heat sink and overload leave (mode/interlock.h).
int32_t board_current_share(void);

/// Phase current that may flow for ever, peak: overload_current, else the motor's rated one, else half of
/// current_limit. A, Q20; 0: any may.
int32_t board_lasting_current(void);

/// The functions in use, in words.
extern const status_line_t board_line;

// The parts, once a millisecond each.
drive_fault_t board_follow_heat(void);   // derating.c
drive_fault_t board_follow_shaft(void);  // stall.c
void board_follow_speed_input(void);     // speed_input.c

#if defined(__cplusplus)
}
#endif

#endif
