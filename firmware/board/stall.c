// A shaft that is commanded to turn, has all the torque there is, and does not get on.
//
// What counts is how far the angle in use gets, not the speed in use: on a shaft that stands the latter may be off by
// some rpm. In stall_time it has to get half as far as the reference does, or a quarter of an electrical turn: a shaft
// that is run up at the limit of the current is long past that. At a reference of zero a load is held on purpose,
// however much of it. Start and commissioning know their own moves and their own times. A shaft that still turns the
// other way and slows down, as a heavy one does in a reversal, is getting on, too, as long as it gets slower than it
// has been: a load that drives it back does so with a ripple. A moment below the limit of the current takes back four:
// on a blocked shaft the noise of the speed makes such moments.

#include "firmware/board/functions.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "hal/qmath/qcall.h"

#define LEAST_BAM 95443718L                         // 8 degrees: what the angle may stray under changing current
#define MOST_BAM 1073741824L                        // a quarter of an electrical turn
#define FAST_BPP (MOST_BAM / DRIVE_PERIODS_PER_MS)  // too far between two looks to tell the direction
#define SLOWER_BPP 286331L                          // 0.67 Hz: beyond what the speed of a shaft strays that stands
#define RELIEF_MS 4u

// How fast the shaft turns against the reference; 0 where it does not.
static int32_t back_bpp(const drive_t* d) {
  const int32_t speed_bpp = d->estimate.selected.speed_bpp;
  return q_max((d->control.ramp.value > 0) ? qc_sub_sat(0, speed_bpp) : speed_bpp, 0);
}

static void begin_anew(const drive_t* d, int32_t now_bpp, bool slows) {
  board.stalled_ms = 0;
  board.stall_from_bam = d->estimate.selected.angle_bam;
  board.stall_back_bpp = now_bpp;
  board.stall_slows = slows;
}

static bool has_speed_reference(const drive_t* d) {
  return d->state == DRIVE_RUN && d->control.ramp.value != 0 && qc_abs_sat(d->estimate.selected.speed_bpp) < FAST_BPP;
}

// By a sixteenth at least: of its largest speed since it began, and once it slows down, of its speed at the last time.
static bool is_slowing(int32_t now_bpp) {
  if (!board.stall_slows) board.stall_back_bpp = q_max(board.stall_back_bpp, now_bpp);
  return board.stall_back_bpp - now_bpp > board.stall_back_bpp / 16 + SLOWER_BPP;
}

// Half of the reference's way in stall_time.
static int32_t least_way_bam(const drive_t* d) {
  const int32_t way = qc_mul_sat(qc_abs_sat(d->control.ramp.value), parameters.stall_time * DRIVE_PERIODS_PER_MS, 1);
  return q_clamp(way, LEAST_BAM, MOST_BAM);
}

// The way in the direction of the reference; one that is pushed back counts from where it has been pushed to.
static int32_t way_bam(const drive_t* d) {
  const int32_t forth = angle_diff_bam(d->estimate.selected.angle_bam, board.stall_from_bam);
  const int32_t way = (d->control.ramp.value > 0) ? forth : qc_sub_sat(0, forth);
  if (way < 0) board.stall_from_bam = d->estimate.selected.angle_bam;
  return way;
}

drive_fault_t board_follow_shaft(void) {
  const drive_t* const d = &drive;
  const int32_t now_bpp = back_bpp(d);
  const bool gets_on = !has_speed_reference(d) || way_bam(d) > least_way_bam(d);
  const bool slows = !gets_on && is_slowing(now_bpp);
  if (gets_on || slows) begin_anew(d, now_bpp, slows);
  if ((d->control.limits & LIMIT_CURRENT) == 0) {
    board.stalled_ms -= (board.stalled_ms < RELIEF_MS) ? board.stalled_ms : RELIEF_MS;
    return FAULT_NONE;
  }
  if (parameters.stall_time == 0 || (int32_t)board.stalled_ms < parameters.stall_time) {
    board.stalled_ms++;
    return FAULT_NONE;
  }
  return FAULT_STALL;
}
