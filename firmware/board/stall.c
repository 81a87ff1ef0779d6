// A shaft that is told to turn, has all the torque there is, and does not get on.
//
// What counts is how far the angle in use gets, not the speed in use: on a shaft that stands the latter may be off by
// some rpm. In stall_time it has to get half as far as the reference does, or a quarter of an electrical turn: a shaft
// that is run up at the limit of the current is long past that. At a reference of zero a load is held on purpose,
// however much of it. Start and commissioning know their own moves and their own times.

#include "firmware/board/functions.h"
#include "firmware/drive.h"
#include "firmware/parameters.h"

#define LEAST_BAM 95443718L                         // 8 degrees: what the angle may stray under changing current
#define MOST_BAM 1073741824L                        // a quarter of an electrical turn
#define FAST_BPP (MOST_BAM / DRIVE_PERIODS_PER_MS)  // too far between two looks to tell the direction

static void begin_anew(const drive_t* d) {
  board.stalled_ms = 0;
  board.stall_from_bam = d->position.used.angle_bam;
}

static bool is_pressed(const drive_t* d) {
  return d->state == DRIVE_RUN && d->control.ramp.value != 0 && (d->limits & LIMIT_CURRENT) != 0 &&
         q_abs_sat(d->position.used.speed_bpp) < FAST_BPP;
}

// Half of the reference's way in stall_time.
static int32_t least_way_bam(const drive_t* d) {
  const int32_t half_periods = parameters.stall_time * (DRIVE_PERIODS_PER_MS / 2);
  return q_clamp(q_sat64(q_product(q_abs_sat(d->control.ramp.value), half_periods)), LEAST_BAM, MOST_BAM);
}

// The way in the direction of the reference; one that is pushed back counts from where it has been pushed to.
static int32_t way_bam(const drive_t* d) {
  const int32_t forth = angle_diff_bam(d->position.used.angle_bam, board.stall_from_bam);
  const int32_t way = (d->control.ramp.value > 0) ? forth : q_neg_sat(forth);
  if (way < 0) board.stall_from_bam = d->position.used.angle_bam;
  return way;
}

drive_fault_t board_follow_shaft(void) {
  const drive_t* const d = &drive;
  if (!is_pressed(d) || way_bam(d) > least_way_bam(d)) begin_anew(d);
  if (parameters.stall_time == 0 || (int32_t)board.stalled_ms < parameters.stall_time) {
    board.stalled_ms++;
    return FAULT_NONE;
  }
  return FAULT_STALL;
}
