// The drive: everything that lives from one control interrupt to the next.
//
// One instance, cleared at start-up. The control interrupt owns it; the window interrupt owns sampling.h's buffers; the
// background level only leaves requests in `request`.

#ifndef STILLSPIN_FIRMWARE_MODE_MODE_H
#define STILLSPIN_FIRMWARE_MODE_MODE_H

#include "control/current_controller.h"
#include "control/field_weakening.h"
#include "control/if_start.h"
#include "control/mtpa.h"
#include "control/position_hold.h"
#include "control/ramp.h"
#include "control/speed_controller.h"
#include "estimators/admittance.h"
#include "estimators/avv.h"
#include "estimators/blend.h"
#include "estimators/deviation_observer.h"
#include "estimators/flux_observer.h"
#include "estimators/inertia_match.h"
#include "estimators/sensor_match.h"
#include "estimators/slopes.h"
#include "estimators/synchronism.h"
#include "estimators/voltage_match.h"
#include "estimators/zvv.h"
#include "firmware/commissioning/commissioning.h"
#include "firmware/drive/brake_hold.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/interfaces/schedule.h"
#include "firmware/interfaces/source.h"
#include "firmware/mode/commands.h"
#include "firmware/start/start.h"
#include "firmware/text/packed_text.h"
#include "svpwm/edges.h"
#include "svpwm/modulator.h"

#define DRIVE_PERIOD_US 100
#define DRIVE_PERIODS_PER_MS 10
#define DRIVE_CURRENT_BITS 29u  // 512 A: no two sensors show more
#define DRIVE_CURRENT_END_Q20 ((int32_t)1 << DRIVE_CURRENT_BITS)
#define DRIVE_MIDDLE_Q8 (2048L * 256L)  // of the converter's codes: no current

/// Derived from the parameters, see config/config.c. Holds nothing that is found while the drive runs: the background
/// level replaces it as a whole.
typedef struct drive_config {
  machine_model_t nameplate;
  modulator_config_t modulator;
  dead_time_config_t dead_time;
  current_controller_config_t current;
  speed_controller_config_t speed;
  mtpa_t mtpa;
  if_start_config_t turn;
  avv_config_t avv;
  zvv_config_t zvv;
  deviation_observer_config_t observer, hold_observer;
  blend_config_t blend;
  flux_observer_config_t flux;
  slopes_config_t slopes;
  synchronism_config_t synchronism;
  int32_t volts_per_code_q16;
  int32_t codes_per_amp_q16;  // ADC codes
  int32_t bpp_per_rpm_q8;
  int32_t rpm_per_bpp_q40;
  int32_t adapt_share_q30;       // per turn, of admittances and sensor match
  int32_t drift_share_q30;       // of resistance and flux
  int32_t friction_per_bpp_q40;  // viscous friction torque, N m per binary angle per period
  int32_t ramp_step_bpp;         // change of the speed reference per millisecond, 0 for a jump
  int32_t hold_gain_q30;         // of the position hold, per period
  int32_t hold_below_bpp;        // slower than this counts as at rest
  uint32_t encoder_trim_bam;     // deliberate turn of the encoder's angle
  int32_t sensor_mismatch_q30;   // of the current sensors, as a share
  bool mapped;                   // the turn of the saliency axis with the current is known
  saturation_slopes_t saturation;
} drive_config_t;

/// What the control interrupt knows about the last period.
typedef struct {
  estimator_window_t windows[ESTIMATOR_WINDOWS];
  ab_t ripple_q16;                              // ripple flux at the middles of all windows, added up, V period
  estimator_frame_t frames[ESTIMATOR_WINDOWS];  // the windows in the frame of who looks at them first, or in use
  uint16_t count;
  slopes_scale_t scale;                     // of the sensors, renewed in a turn
  int32_t link_end_q16[ESTIMATOR_WINDOWS];  // DC link at the end of each window, unfiltered, V
  int32_t raw_a_q8, raw_b_q8;               // mean codes of the first burst, for the calibration
  int32_t link_q16;                         // filtered DC-link voltage, V
} drive_samples_t;

/// Angle and speed in use and the estimators behind them.
typedef struct {
  estimator_output_t used, low, high;
  avv_t avv;
  deviation_observer_t observer;
  zvv_t zvv;
  blend_t blend;
  flux_observer_t flux;
  sensor_match_t sensors;
  tracking_observer_t encoder;
  bool is_near;                 // what was last regressed is near enough to learn from
  uint32_t encoder_offset_bam;  // electrical angle at count 0, found at the start
  uint32_t aligned_bam;         // where it was found
  int32_t torque_accel_q8;      // acceleration of the torque of the measured current
  int32_t deviation_q20;        // D of the zero vectors in the frame in use, A per period
} drive_position_t;

typedef struct {
  current_controller_t current;
  speed_controller_t speed;
  field_weakening_t weakening;
  int32_t weakening_q20;
  int32_t seeing_q20;                  // what flows against the d-axis so that the flux is seen
  int32_t current_limit_q20;           // largest phase current now (board/functions.h)
  int32_t room_q20, braking_room_q20;  // torque current that the limits leave, and against the rotation, A
  q_inverse_t per_torque_constant;     // of N m per A, Q24, at the reference of i_d
  ramp_t ramp;
  position_hold_t place;   // kept at a reference of zero
  dq_t reference_q20;      // current reference
  dq_t measured_q20;       // mean current of the last period
  dq_t command_q16;        // voltage command
  int32_t feed_q16;        // q-axis voltage for a change of the reference that is known beforehand
  int32_t wanted_rpm_q16;  // speed asked for, mechanical
  int32_t target_bpp;      // the same, electrical
  bool closed;             // current loop closed
  bool speed_ready;        // the speed controller could be set up
} drive_control_t;

typedef struct {
  modulator_t state;
  svpwm_pattern_t sampled;  // pattern of the period whose windows were just read
  svpwm_pattern_t running;  // pattern of the period that has just begun
  svpwm_pattern_t next;     // pattern in the making
  ab_t asked_q16;           // voltage asked of the modulator, drops of the devices added
} drive_modulation_t;

typedef struct {
  uint16_t missing, overrun, diverged_periods;
  uint16_t judged_at;         // heartbeat when the angle in use was last judged
  uint32_t judged_bam;        // and that angle
  uint32_t stopping_periods;  // in STOP with the reference at zero
  synchronism_t synchronism;
} drive_supervision_t;

typedef struct {
  bool start, stop, coast, reset, reload, commission, look;
} drive_request_t;

/// What the last look at the shaft has shown.
typedef struct {
  look_outcome_t outcome;
  int32_t rpm_q16;
} drive_look_t;

/// What is read everywhere comes first, what is large last: the farther a member, the longer the code that reaches it.
typedef struct drive {
  drive_state_t state;
  drive_fault_t fault;
  int32_t limits;
  uint32_t periods;  // since the state was entered
  schedule_t schedule;
  uint32_t time_ms;          // control interrupts since power-on, in ms; wraps after 49 days
  uint16_t heartbeat;        // counts control interrupts, for the watchdog
  volatile uint16_t sliced;  // 1: a phase control has the legs (interfaces/phase_control.h)
  bool config_valid;
  bool conflict_known;  // of the parameters that the configuration was made of
  bool loading;         // the store is being read: BOOT goes on
  drive_request_t request;
  const position_source_t* source;  // by the parameter, chosen when that changes
  packed_text_t conflict;           // why they do not fit together, or PACKED_NONE
  drive_position_t position;
  drive_control_t control;
  drive_samples_t samples;
  machine_model_t model;  // nameplate, at the working point and with what was learnt
  drive_modulation_t modulation;
  drive_supervision_t supervision;
  hold_t hold;
  polarity_watch_t watch;
  inertia_match_t inertia;
  slopes_trim_t trim;  // current offsets, mismatch of the sensors
  drive_look_t look;
  uint32_t calm_at;              // period in which the currents will have been at rest for long enough
  int32_t rest_a_q8, rest_b_q8;  // currents at rest while the offsets are found, codes
  int32_t unrest_q8;             // mean deviation of the currents from their offsets while these are found, codes
  int32_t heat_sink_q8;          // degrees C, as board/derating.c has it
  bool heat_sink_known;          // by a sensor that is in use and whole
  drive_start_t start;
  drive_config_t config;
  commissioning_t commissioning;
} drive_t;

extern drive_t drive;

/// What is made of the parameters is made anew; the position source is chosen at once.
void drive_parameters_changed(void);
void drive_choose_source(void);

/// True where the speed control and the chosen position source are at work.
bool drive_is_turning(const drive_t* d);

/// True where angle and speed in use are the rotor's: the power stage is on and the start has found them. With the
/// gates off nothing is, with an encoder neither: what it counts has an angle from the start's end on, while the drive
/// runs.
bool drive_knows_speed(const volatile drive_t* d);
/// The bits of known_t.
uint16_t drive_known(const volatile drive_t* d);

/// Mechanical speed, rpm Q16, of an electrical one.
int32_t drive_rpm_q16(const drive_t* d, int32_t speed_bpp);

/// Latches a fault with its circumstances (fault_history.h) and opens the power stage. The speed command is forgotten.
void drive_raise(drive_t* d, drive_fault_t fault);

/// Enters a state and starts counting its periods.
void drive_enter(drive_t* d, drive_state_t state);

/// True while the start turns a current vector: the position source runs, and is not used yet.
static inline bool drive_is_turned(const drive_t* d) { return d->state == DRIVE_START && d->start.phase == START_TURN; }

/// A vector in the frame that the control uses, in the frame of what the position source sees meanwhile.
static inline dq_t drive_seen(const drive_t* d, dq_t vector) {
  return frame_moved(vector, d->start.seen.angle_bam - d->position.used.angle_bam);
}

/// True while what is sampled does not belong to a power stage that is on and to a known pattern.
static inline bool drive_is_blind(const drive_t* d) {
  return d->state == DRIVE_START && (!d->start.powered || d->start.blind > 0u);
}

#endif
