#include "tests/fuzz/fuzz_drive.h"

#include <stddef.h>

#include "firmware/api/status.h"
#include "firmware/can/node.h"
#include "firmware/commissioning/commissioning.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/config/config.h"
#include "firmware/console/console.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/steps.h"
#include "firmware/hil/hil.h"
#include "firmware/link/link.h"
#include "firmware/link/requests.h"
#include "firmware/mode/mode.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/paper/paper.h"
#include "firmware/start/start.h"
#include "firmware/start/step.h"
#include "firmware/store/store.h"

#define CALIBRATION 400u  // periods that are more than enough
#define START 350u

// The drive in a state, with what the state keeps to itself.
typedef struct {
  drive_t drive;
  drive_start_t starting;
  commissioning_t commissioning;
  hold_t brake_release_hold;
  polarity_watch_t polarity_watch;
  inertia_match_t inertia_match;
  zvv_t paper_zvv;
  flux_observer_t flux_observer;
} reached_t;

static reached_t reached[FUZZ_STATES];
static bool all_reached;

static void period(void) {
  for (uint16_t k = 0; k < modulation_sampled(&drive.modulation)->window_count; k++) {
    fuzz_board_still_window();
    drive_window_interrupt();
  }
  drive_control_interrupt();
}

void fuzz_background(void) {
  if (!feature_status.stepped) background_step(&drive);
}

static void periods_until(drive_state_t state, uint16_t most) {
  for (uint16_t k = 0; k < most && drive.state != state; k++) {
    period();
    fuzz_background();
  }
}

static void keep(drive_state_t state) {
  const reached_t now = {drive,          starting,      commissioning, brake_release_hold,
                         polarity_watch, inertia_match, paper_zvv,     flux_observer};
  reached[state] = now;
}

static void restore(uint16_t state) {
  drive = reached[state].drive;
  starting = reached[state].starting;
  commissioning = reached[state].commissioning;
  brake_release_hold = reached[state].brake_release_hold;
  polarity_watch = reached[state].polarity_watch;
  inertia_match = reached[state].inertia_match;
  paper_zvv = reached[state].paper_zvv;
  flux_observer = reached[state].flux_observer;
}

static void power_on(void) {
  fuzz_board_power_on();
  drive_reset();
  parameters.wiring_check = 0;  // no motor is there
  (void)drive_config_load(&drive.config);
  hil_reset();
  link_reset();
  console_reset();
}

// The machine stands, so the drive runs with an encoder and does not ask which way round its magnet is.
static void reach_states(void) {
  power_on();
  keep(DRIVE_BOOT);
  period();
  keep(DRIVE_CALIBRATE);
  periods_until(DRIVE_READY, CALIBRATION);
  keep(DRIVE_READY);
  drive_command_commission();
  periods_until(DRIVE_COMMISSION, START);
  keep(DRIVE_COMMISSION);
  drive_command_coast();
  period();
  parameters.position_source = POSITION_ENCODER;
  parameters.polarity_check = 0;
  drive_parameters_changed();
  fuzz_background();
  drive_command_speed((int32_t)300 << 16);
  drive_command_start();
  periods_until(DRIVE_START, 1);
  keep(DRIVE_START);
  periods_until(DRIVE_RUN, START);
  for (uint16_t k = 0; k < 20u; k++) period();
  keep(DRIVE_RUN);
  drive_command_stop();
  period();
  keep(DRIVE_STOP);
  drive_trip(&drive, FAULT_OVER_CURRENT);
  period();
  keep(DRIVE_FAULT);
  all_reached = true;
}

void fuzz_power_on(void) {
  if (!all_reached) reach_states();
  power_on();
  restore(DRIVE_READY);
}

static uint16_t answer_as_bus(const uint16_t* request, uint16_t count, uint16_t* answer) {
  return request_answer(COMM_WATCHDOG_BUS, request, count, answer);
}

void fuzz_node_on(void) { can_node_reset(answer_as_bus); }

// What goes on whatever the state is.
typedef struct {
  uint32_t time_ms;
  uint16_t heartbeat;
  drive_request_t request;
  drive_config_t config;
  bool config_valid;
} lasting_t;

void fuzz_put_into(uint16_t state) {
  if (feature_status.stepped) return;  // it is a simulation's drive
  const lasting_t now = {drive.time_ms, drive.heartbeat, drive.request, drive.config, drive.config_valid};
  restore(state);
  drive.time_ms = now.time_ms;
  drive.heartbeat = now.heartbeat;
  drive.request = now.request;
  drive.config = now.config;
  drive.config_valid = now.config_valid;
  drive_parameters_changed();
  fuzz_board_gates(drive_is_energised());
}

void fuzz_fault(uint16_t which) {
  static const drive_fault_t faults[] = {
#define FAULT(number, name, words, remedy) FAULT_##name,
#include "firmware/dictionary/all_faults.h"
#undef FAULT
  };
  const drive_fault_t fault = faults[which % (uint16_t)(sizeof faults / sizeof faults[0])];
  if (fault != FAULT_NONE) drive_trip(&drive, fault);
}

void fuzz_pass(uint16_t ms) {
  if (feature_status.stepped) return;  // its time is the simulation's
  drive.time_ms += ms - 1u;
  drive.schedule.period = DRIVE_PERIODS_PER_MS - 1u;
  period();
  fuzz_background();
}

void fuzz_serve_port(void) {
  store_service();
  link_service();
  console_service();
}

void fuzz_serve_bus(void) {
  store_service();
  can_node_service();
}

void fuzz_forget_requests(void) {
  static const drive_request_t none = {0};
  drive.request = none;
}

bool fuzz_is_running(void) { return drive.state == DRIVE_RUN; }
bool fuzz_is_to_stop(void) { return drive.request.stop; }
bool fuzz_has_host(void) { return feature_status.stepped; }
uint32_t fuzz_time_ms(void) { return drive.time_ms; }
uint16_t fuzz_node(void) { return (uint16_t)parameters.can_node; }

// One that the edition has not keeps its default, which no other parameter's range need hold.
static bool is_wrong(uint16_t id, int32_t raw) {
  const parameter_info_t* const p = parameter_by_id(id);
  return p != NULL && !parameter_allows(p, raw);
}

uint16_t fuzz_parameter_out_of_range(void) {
  uint16_t place = 0;
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) \
  place++;                                                                                 \
  if (is_wrong(id, parameters.name)) return place;
#include "firmware/dictionary/all_parameters.h"
#undef PARAMETER
  return 0;
}
