// What the windows say of machine and sensors, learnt slowly.

#include "estimators/sensor_match.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/sources/observer/observer.h"

// A period with three windows has no room for both the polarity's watch and what else has the slot.
static bool is_full(const drive_t* d) { return d->samples.count >= ESTIMATOR_WINDOWS; }

static bool is_slot(const drive_t* d, schedule_slot_t slot) { return d->schedule.slot == slot; }

static void match_sensors(const drive_t* d, drive_estimate_t* e, const regression_t* r, q_inverse_t per_spread,
                          int32_t share_q30) {
  if (!d->modulation.state.is_alternating) return;
  // Ydd of the map in the place of the mean: its reciprocal is known, and a mismatch is learnt a little later.
  sensor_match_step(&e->trim.mismatch_q30, r, per_spread, e->model.per_ydd0, share_q30);
}

void source_learn(const drive_t* d, drive_estimate_t* e, const regression_t* r) {
  const bool inductance = is_slot(d, SLOT_INDUCTANCE);
  if (!(inductance || is_slot(d, SLOT_VOLTAGE)) || e->avv.is_near == 0u) return;
  // The slot comes 5/4 as seldom where eight of ten periods have one, and 5/2 where four have; there, learning 3/2 as
  // much leaves the angle quieter.
  const int32_t share_q30 = d->config.adapt_share_q30 / 4 * (d->schedule.turning ? 6 : 5);
  const bool runs = drive_is_turning(d);
  const q_inverse_t per_spread = q_invert(r->spread_q8);
  if (inductance) inverse_inductance_step(&e->model, r, per_spread, share_q30);
  if (inductance == runs) {
    match_sensors(d, e, r, per_spread, share_q30);
  } else if (runs && !(polarity_watch_is_awake(d) && is_full(d))) {
    const int32_t w_q30 = machine_speed_rad_q30(e->selected.speed_bpp);
    voltage_match_step(&e->model, r, w_q30, d->config.drift_share_q30 / 2 * 3);
  }
}
