// The machine under torque current: incremental inductances and the turn of the saliency axis at four levels of i_q.
//
// The shaft is free, so the torque comes in trains that put it back: four segments + - - + of i_q, and the mirror image
// - + + - at the next turn. Position and speed are those of the beginning again at the end of each. Within a train the
// angle is not corrected, it runs ahead on the torque: the windows are looked at in the frame of the *predicted* angle.
// Four groups of periods are summed, sign of i_q times kind of train; each gives a tensor and so the direction of its
// saliency axis in that frame. Within one kind of train,
//   axis(+) - axis(-) = 2 turn + share * (displacement(+) - displacement(-))
// with the groups' mean displacement; constants and whatever moves evenly fall out. `turn` is cross-saturation, `share`
// what the prediction is wrong by. The two cannot be told apart this way, for the displacement follows the sign; so the
// spin comes first, and flux over inertia, which is all the prediction needs, is known to a few parts in a thousand.
// What still shows between the two kinds of train is a check of it.
//
// A segment is as long as it takes to move by about 6 degrees electrical; the current's ramps make it more. The first
// part of every segment, in which the current still settles, is left out, the same part everywhere so that the groups'
// instants lie symmetrically. The angle is not corrected again before the current is gone, for its turn would be taken
// for motion. Between trains the shaft is held for 40 ms.

#include "firmware/base/clear.h"
#include "firmware/commissioning/phases.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/inertia.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "hal/qmath/qcall.h"

#define EXCURSION_BAM 71582788L  // 6 degrees
#define SEGMENTS 4
#define SEGMENT_MIN 40
#define SEGMENT_MAX 90
#define SETTLE_PERIODS 20
#define PAUSE_PERIODS 400
#define STILL_PERIODS 200
#define WANTED_PERIODS 8000  // in each group at the first level, fewer above: the turn grows
#define PLACES 8u
#define PLACE_BAM 536870912uL  // 45 degrees
#define MOVE_PERIODS 300
#define SLOPE_STEPS 12  // periods for the current limit, or what half of the link drives

int32_t map_level_q20(const map_t* m, uint16_t level) {
  return m->most_q20 / (int32_t)MAP_LEVELS * ((int32_t)level + 1);
}

// Periods in which a reversal of the current settles.
static int32_t blank(const map_t* m) { return 2 * map_level_q20(m, m->level) / m->step_q20 + SETTLE_PERIODS; }

static void begin_train(drive_t* d) {
  map_t* const m = &commissioning.map;
  const int32_t accel_q8 = q_max(drive_accel_q8(d, 0, map_level_q20(m, m->level)), 1);
  const int32_t square = q_div(EXCURSION_BAM, accel_q8, 8);
  m->segment = q_clamp((int32_t)q_sqrt32((uint32_t)square), SEGMENT_MIN, SEGMENT_MAX);
  const int32_t swing_q20 = qc_mul(d->samples.link_q16, d->estimate.model.yq_q30, 27);
  // A slow train takes the shaft far: at least a quarter.
  const int32_t most_q20 = q_max(q_min(drive.config.values.current_limit / SLOPE_STEPS, swing_q20), 4);
  m->step_q20 = q_clamp(m->slope_q20, q_shr(most_q20, 2), most_q20);
  m->blank = blank(m);
  m->segment = q_max(m->segment, m->blank + 14);
  m->pause = false;
  m->tick = 0;
  m->speed_q8 = 0;
  m->position_bam = 0;
  m->train++;
  commissioning.predicting = true;
}

// Follows what the current of the last period did to the shaft.
static void predict(const drive_t* d, map_t* m) {
  const dq_t i = d->estimate.measured_q20;
  m->speed_q8 = qc_add_sat(m->speed_q8, drive_accel_q8(d, i.d, i.q));
  m->position_bam = qc_add_sat(m->position_bam, q_shr(m->speed_q8, 8));
}

// + - - +, and every other train the mirror image.
static uint16_t is_negative(const map_t* m, uint16_t segment) { return ((segment + 1u) / 2u + m->train) % 2u; }

static void add_period(const drive_t* d, map_t* m, uint16_t segment) {
  map_group_t* const g = &m->group[m->level][2u * (m->train % 2u) + is_negative(m, segment)];
  if (!commissioning_add_pair(d, &g->tensor)) return;
  q_gather(&g->position, m->position_bam);
  q_gather(&g->current, d->estimate.measured_q20.q);
}

// The second of two equal segments need not settle.
static bool usable(const map_t* m, uint16_t segment) {
  const int32_t inside = m->tick - (int32_t)segment * m->segment;
  return segment == 2u || inside >= m->blank;
}

// The current follows the plan two periods later: the plan's slope goes to the voltage at once, its value to the
// controller with that delay. So the integrator has nothing to do and the current does not overshoot.
static void follow(drive_t* d, map_t* m, int32_t target_q20) {
  const int32_t last = m->plan[0];
  d->control.references.current_q20.q = m->plan[1];
  m->plan[1] = last;
  m->plan[0] = q_limit(q_clamp(target_q20, last - m->step_q20, last + m->step_q20), d->config.values.current_limit);
  d->control.references.feed_forward_q16 = q_div(m->plan[0] - last, d->estimate.model.yq_q30, 26);
}

// What a level has of WANTED_PERIODS, by the group of the last segment, which is filled last.
static int32_t periods_done(const map_t* m) {
  return q_clamp(m->group[m->level][MAP_GROUPS - 1u].tensor.count, 0, WANTED_PERIODS) * ((int32_t)m->level + 1);
}

static bool level_complete(const map_t* m) {
  return m->train % (2u * PLACES) == 0u && (periods_done(m) >= WANTED_PERIODS || m->train >= 600u);
}

static void run_train(drive_t* d, map_t* m) {
  const uint16_t segment = (uint16_t)(m->tick / q_max(m->segment, 1));
  int32_t sign = 0;
  predict(d, m);
  if (segment < SEGMENTS) {
    if (usable(m, segment)) add_period(d, m, segment);
    sign = (is_negative(m, segment) != 0u) ? -1 : 1;
  }
  follow(d, m, sign * map_level_q20(m, m->level));
  m->tick = qc_add_sat(m->tick, 1);
  if (m->tick < SEGMENTS * m->segment + m->blank) return;
  m->pause = true;
  m->judge = m->train % (2u * PLACES) == 0u;
  m->tick = 0;
  commissioning.predicting = false;
  machine_model_follow(&d->estimate.model, 0);
}

// Before every second train the shaft moves on by 45 degrees electrical: over eight places cogging averages out, and so
// does a mismatch of the sensors that changes with the current (the converter's bend).
static void move_on(const map_t* m) {
  if (m->train % 2u == 0u && m->tick < MOVE_PERIODS) commissioning.target_bam += PLACE_BAM / MOVE_PERIODS;
}

// What was summed up in an earlier commissioning goes piece by piece in the first pause: all of it at once is too much
// for an interrupt. With half of the currents what was the first level is the second one.
static void empty_next_group(map_t* m) {
  if (m->level != 0u || m->train != 0u || m->tick >= (int32_t)(MAP_LEVELS * MAP_GROUPS)) return;
  const uint16_t n = (uint16_t)(MAP_LEVELS * MAP_GROUPS - 1u - (uint16_t)m->tick);
  const uint16_t level = n / MAP_GROUPS, k = n % MAP_GROUPS;
  if (m->kept && level == 1u) {
    m->group[1][k] = m->group[0][k];
  } else {
    clear(&m->group[level][k], sizeof m->group[level][k]);
  }
}

// Thousandths of what four levels take: a level has half of the periods of the one below, and longer segments.
int32_t commissioning_map_done(const map_t* m) {
  static const int16_t ends[MAP_LEVELS + 1u] = {0, 270, 585, 820, 1000};
  if (m->level >= MAP_LEVELS) return ends[MAP_LEVELS];
  const int32_t begin = ends[m->level];
  return begin + q_min(periods_done(m), WANTED_PERIODS) * (ends[m->level + 1u] - begin) / WANTED_PERIODS;
}

static void begin_map(map_t* m) {
  m->levels = MAP_LEVELS;
  m->lost = false;
  m->slope_q20 = INT32_MAX;
  m->level = 0;
  m->train = 0;
  m->tick = 0;
}

// Beyond the saliency nothing shows the angle: no level is tried above one that has none. With too few below it the
// map begins again with half of the currents, a quarter of the limit at the least.
static void next_level(map_t* m) {
  m->train = 0;
  m->level++;
  if (!m->lost) return;
  if (m->level <= SALIENT_LEAST && m->most_q20 > drive.config.values.current_limit / 4) {
    m->kept = m->level > 1u;
    m->most_q20 /= 2;
    begin_map(m);
  } else {
    m->levels = (uint16_t)(m->level - 1u);
    m->level = MAP_LEVELS;
  }
}

static void begin(const drive_t* d, map_t* m) {
  begin_map(m);
  m->segment = 0;
  m->pause = true;
  m->kept = false;
  m->judge = false;
  m->plan[0] = 0;
  m->plan[1] = 0;
  commissioning.target_bam = d->estimate.selected.angle_bam;
  tensor_reset(&commissioning.unsaturated);
}

bool commissioning_map(drive_t* d) {
  map_t* const m = &commissioning.map;
  if (commissioning.tick == 0) begin(d, m);
  if (m->level >= MAP_LEVELS) return true;
  if (!m->pause) {
    run_train(d, m);
    return false;
  }
  const int32_t length = (m->train % 2u == 0u) ? MOVE_PERIODS + PAUSE_PERIODS : PAUSE_PERIODS;
  empty_next_group(m);
  move_on(m);
  commissioning_hold(d);
  if (m->tick == length && interlock_is_warm()) return false;
  if (m->tick <= length) {
    // The last part of a pause, at rest, is the map's point without current.
    if (m->tick > length - STILL_PERIODS) commissioning_add_still(d);
    m->tick = qc_add_sat(m->tick, 1);
    return false;
  }
  if (m->judge) return false;
  if (m->lost || level_complete(m)) next_level(m);
  if (m->level >= MAP_LEVELS) return true;
  if (m->tick > length) begin_train(d);
  return false;
}
