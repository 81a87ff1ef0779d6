// Commissioning: what the drive finds out about the machine and the inverter it is connected to.
//
// After the ordinary start (axis and polarity) the state DRIVE_COMMISSION goes through the phases below, first at
// standstill with the shaft held in place by its own control, at last in a short spin. The interrupt only keeps sums;
// when the gates are off again the background level turns them into parameters, checks each for plausibility and writes
// those that pass. What each phase measures and how it is evaluated stands at the head of its file; docs/commissioning.
//
// A machine that shows no axis at rest is not held: its rotor turns to where the staircase's current points, a current
// vector starts the spin, and there is no map.
//
// The currents reach the limit, which may be several times what the machine bears for long. Where heat sink or overload
// take something of the limit away the measuring waits at rest until all of it is back (interlock_is_warm).
//
// Cost: at standstill the position sources but AVV are idle, which is more than the sums take; 1400 words.

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_COMMISSIONING_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_COMMISSIONING_H

#include "estimators/inverse_inductance_tensor.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/interfaces/state.h"
#include "svpwm/dead_time.h"

#define STAIRCASE_LEVELS 14u
#define MAP_LEVELS 4u
#define MAP_GROUPS 4u
#define SALIENT_LEAST 2u  // levels of the map: fewer may as well be a wrong order of the phases
#define SPIN_STATIONS 3u
#define SPIN_RAMPS 2u

/// One level of the DC staircase. Sums over periods and over windows; currents and voltages Q20, the sag V^2 Q12.
typedef struct {
  int64_t current, factor, command, sag;  // per period
  int64_t residual;                       // per window
  int32_t periods, windows;
  int32_t link_q16;
} staircase_level_t;

typedef struct {
  uint16_t index;
  uint16_t turn;  // period of those in which the sums take turns
  int32_t tick;
  int32_t held_q20;             // the largest that holds the rotor
  int32_t first_q20, step_q20;  // the first level, and by how much each is above the one before
  dead_time_config_t one_volt;  // the devices, if their drop were that
  bool at_zero;                 // no pulses but those of the voltage: the windows are the zero vector's
  staircase_level_t level[STAIRCASE_LEVELS];
} staircase_t;

/// Periods of one sign of the torque in one kind of train (group: 2 * mirrored train + negative sign).
typedef struct {
  tensor_sums_t tensor;
  int64_t position;  // predicted displacement, binary angle
  int64_t current;   // i_q, Q20
} map_group_t;

typedef struct {
  uint16_t level;
  uint16_t levels;    // with a saliency, or all of them
  int32_t most_q20;   // current of the last level; before the first begins, the mean that leaves the ripple room
  uint16_t train;     // trains begun at this level
  int32_t tick;       // in the train, or in the pause after it
  int32_t segment;    // length of a segment, periods
  int32_t blank;      // of it, in which the current settles
  int32_t step_q20;   // A by which the current may change in a period,
  int32_t slope_q20;  // and what saturation leaves of it at the next level
  bool pause;
  bool kept;            // the first level's sums are those of the second one, with half of the currents
  volatile bool judge;  // the background level owes whether the level has a saliency
  volatile bool lost;   // it has none; written before `judge`
  int32_t plan[2];      // i_q reference: that of now, and the one before it
  int32_t speed_q8;     // predicted motion in this train: binary angle per period
  int32_t position_bam;
  map_group_t group[MAP_LEVELS][MAP_GROUPS];
} map_t;

/// At a steady speed, or between two of them.
typedef struct {
  int64_t speed, voltage_q, current_q, current_d;
  int32_t periods;
  int32_t torque_periods;  // of current_q: at a steady speed those behind the others
} spin_sums_t;

typedef struct {
  bool begun, arrived;
  uint16_t leg;
  uint32_t angle_bam;  // of the last period
  int32_t tick;
  uint16_t waited;   // for a turn's end, periods
  int32_t part_q20;  // what i_d changes by in a period, A
  spin_sums_t station[SPIN_STATIONS];
  spin_sums_t ramp[SPIN_RAMPS];
} spin_t;

/// Samples settle as long as it wants, or there are no pulses but those that the voltage wants.
typedef enum { SAMPLING_USUAL = 0, SAMPLING_LONGER = 1, SAMPLING_AT_ZERO = 2 } commissioning_sampling_t;

typedef struct {
  commissioning_phase_t phase;
  commissioning_outcome_t outcome;
  int32_t tick;       // periods in this phase
  bool predicting;    // the angle runs ahead on the torque alone
  bool solve_motion;  // the background level owes acceleration and torque constant from the spin
  bool evaluate;      // the sums are complete and the gates are off
  commissioning_sampling_t sampling;
  bool uniform;           // no axis at rest: the shaft follows the current, and is not held
  int32_t damping_q30;    // of the hold, per period
  uint32_t target_bam;    // where the shaft is held
  uint32_t goal_bam;      // and where it is to be taken
  int32_t torque_q24;     // 3/2 p flux and
  int32_t accel_q12;      // acceleration per torque, as the spin found them (machine_model.h)
  int32_t mismatch_q30;   // of the current sensors, as taken off the samples meanwhile
  machine_model_t model;  // the one whose slopes were taken off the sums
  tensor_sums_t unsaturated;
  staircase_t staircase;
  map_t map;
  spin_t spin;
} commissioning_t;

/// Its memory: a drive has one commissioning.
extern commissioning_t commissioning;

/// As after power-on.
void commissioning_reset(void);

extern const state_t commissioning_state;

/// How it samples meanwhile.
extern const config_part_t commissioning_part;

#endif
