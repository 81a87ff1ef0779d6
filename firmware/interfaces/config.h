// The constants of a drive: what the interrupt needs of the parameters.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_CONFIG_H
#define STILLSPIN_FIRMWARE_INTERFACES_CONFIG_H

#include "control/current_controller.h"
#include "control/mtpa.h"
#include "control/speed_controller.h"
#include "estimators/avv.h"
#include "estimators/blend.h"
#include "estimators/deviation_observer.h"
#include "estimators/saturation.h"
#include "estimators/slopes.h"
#include "estimators/synchronism.h"
#include "firmware/interfaces/config_values.h"
#include "svpwm/edges.h"
#include "svpwm/modulator.h"

/// Derived from the parameters, see config/config.c. Holds nothing that is found while the drive runs: the background
/// level replaces it as a whole, with the constants that a feature has beside it (config_part.h), and the interrupts
/// read no parameter beside these.
typedef struct drive_config {
  machine_model_t nameplate;
  modulator_config_t modulator;
  dead_time_config_t dead_time;
  current_controller_config_t current;
  speed_controller_config_t speed;
  mtpa_t mtpa;
  avv_config_t avv;
  deviation_observer_config_t observer, hold_observer;
  blend_config_t blend;
  slopes_config_t slopes;
  synchronism_config_t synchronism;
  int32_t volts_per_code_q16;
  int32_t codes_per_amp_q16;  // ADC codes
  int32_t bpp_per_rpm_q8;
  int32_t rpm_per_bpp_q40;
  int32_t adapt_share_q30;       // per slot, of inverse inductances and sensor match
  int32_t drift_share_q30;       // of resistance and flux
  int32_t friction_per_bpp_q40;  // viscous friction torque, N m per binary angle per period
  int32_t ramp_step_bpp;         // change of the speed reference per millisecond, 0 for a jump
  int32_t salient_q20;           // most current while the rotor is found by its saliency
  int32_t salient_bpp_q4;        // up to that speed, for a volt of the link
  int32_t hold_gain_q30;         // of the position hold, per period
  int32_t release_step_q30;      // wc T of a shaft that is held while a brake opens (drive/brake_release_hold.c)
  int32_t sensor_mismatch_q30;   // of the current sensors, as a share
  bool mapped;                   // the turn of the saliency axis with the current is known
  int16_t freed_by_q8;           // of salient_bpp_q4: from that speed on all of the current, 2 or more
  saturation_slopes_t saturation;
  config_values_t values;
} drive_config_t;

/// Electrical speed of a few rpm, up to 20, of whatever number of pole pairs.
static inline int32_t config_slow_bpp(const drive_config_t* c, int32_t rpm) {
  return q_shr_round(rpm * c->bpp_per_rpm_q8, 8);
}

#endif
