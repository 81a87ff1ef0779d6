// Records from either port: every request with any body, one after the other without end, and what goes out unasked.

#include "firmware/link/requests.h"

#include "firmware/commissioning/requests.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/steps.h"
#include "firmware/hil/hil.h"
#include "firmware/hil/requests.h"
#include "firmware/link/link.h"
#include "firmware/link/stream.h"
#include "firmware/mode/commands.h"
#include "firmware/scope/requests.h"
#include "firmware/scope/scope.h"
#include "firmware/store/requests.h"
#include "hal/hal_flash.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_replay.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"
#include "tests/prove/any_drive.h"

const request_row_t* const edition_requests[] = {drive_requests, parameter_requests,     signal_requests,
                                                 table_requests, scope_requests,         hil_requests,
                                                 store_requests, commissioning_requests, 0};

uint16_t hal_sci_room(void) { return any_up_to(HAL_SCI_TRANSMIT_RING); }
void hal_sci_service(void) {}
void hal_irq_control_end(void) {}
void hal_irq_enable(void) {}
void hal_irq_install(hal_isr_t control, hal_isr_t window) {
  control();
  window();
}
uint16_t hal_flash_read(uint32_t address) { return (uint16_t)(address & any_u16); }
bool hal_pwm_is_tripped(void) { return any_bool(); }
void hal_pwm_gates_off(void) {}
bool hal_pwm_write(const hal_pwm_frame_t* frame, uint16_t deadline_tick) {
  (void)frame;
  (void)deadline_tick;
  return any_bool();
}
uint32_t hal_time_cycles(void) { return any_u32; }

link_errors_t link_errors(void) {
  const link_errors_t e = {{any_u16, any_u16, any_u16}, hal_sci_errors(), any_u16};
  return e;
}

void drive_reset(void) { scope_reset(); }

// What the drive asks of the recording while it is stepped, in any order.
static void ask_the_recording(void) {
  uint16_t words[REPLAY_OUTPUTS];
  any_octets(words, REPLAY_OUTPUTS);
  while (any_bool()) {
    (void)replay_note(any_u16);
    if (replay_plays()) (void)replay_take();
    replay_output((replay_output_t)any_up_to(8), words, any_up_to(15));
  }
}

// A call of a window that is played plays no other.
void drive_window_interrupt(void) {
  uint16_t results[REPLAY_RESULTS];
  if (any_bool()) replay_take_results(results, any_bool() ? REPLAY_RESULTS : 3u);
  ask_the_recording();
}

void drive_control_step(drive_t* d) {
  (void)d;
  while (any_bool()) {
    replay_call();
    ask_the_recording();
  }
}

void background_step(drive_t* d) {
  (void)d;
  if (!hal_replay_has_work(any_bool() ? REPLAY_RELOADED : REPLAY_EVALUATED)) return;
  hal_replay_work_begin(REPLAY_RELOADED);
  hal_replay_work_end();
}

static uint16_t request[RECORD_MAX];
static uint16_t answer[RECORD_MAX];

static void ask(comm_watchdog_t port, uint16_t type) {
  any_octets(request, RECORD_MAX);
  request[0] = type;
  (void)request_answer(port, request, any_up_to(RECORD_MAX - 2u), answer);
}

// One type by itself; those of the others leave what they left before.
static void one_type(uint16_t type) {
  while (any_bool()) {
    any_moment();
    hil_service();
    requests_service(answer);
    ask(any_bool() ? COMM_WATCHDOG_SERIAL : COMM_WATCHDOG_BUS, type);
    (void)stream_event(COMM_WATCHDOG_SERIAL, answer);
    (void)stream_event(COMM_WATCHDOG_BUS, answer);
    comm_watchdog_service();
  }
}

void prove_requests(void) {
  scope_reset();
  requests_reset();
  stream_reset();
  hil_reset();
  //@ loop unroll 64;
  for (uint16_t type = 0; type < 0x40u; type++) one_type(type);
}
