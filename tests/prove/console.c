// The serial port's two sides: what a terminal types, octet after octet without end, while commands answer at once,
// with lines or not at all; and the sorting of text and records. Commands and requests by themselves are commands.c and
// requests.c.

#include "firmware/console/console.h"

#include "firmware/console/commands.h"
#include "firmware/console/job.h"
#include "firmware/link/link.h"
#include "firmware/link/requests.h"
#include "firmware/link/stream.h"
#include "hal/hal_sci.h"
#include "tests/prove/any_drive.h"

const text_port_t* const edition_text_port = &console_text_port;

uint16_t hal_sci_room(void) { return any_up_to(HAL_SCI_TRANSMIT_RING); }

static bool any_line(uint16_t step) { return step == 0u || any_bool(); }

void command_obey(const editor_line_t* line, bool expired) {
  (void)line;
  (void)expired;
  if (any_bool()) console_run(any_line, any_bool());
}

bool command_makes_safe(const editor_line_t* line) { return line->count > 0u && any_bool(); }

void requests_reset(void) {}
void requests_service(uint16_t* scratch) { (void)scratch; }

uint16_t request_answer(comm_watchdog_t port, const uint16_t* request, uint16_t count, uint16_t* answer) {
  (void)port;
  for (uint16_t k = 0; k < count; k++) any_u16 = request[k];
  any_octets(answer, RECORD_MAX);
  return any_up_to(RECORD_MAX - 2u);
}

void prove_console(void) {
  any_moment();
  link_reset();
  console_reset();
  while (any_bool()) {
    any_moment();
    if (any_bool()) any_stream(COMM_WATCHDOG_SERIAL);
    if (any_bool()) comm_watchdog_begin((comm_watchdog_t)any_up_to(3), any_u32);
    link_service();
    console_service();
    (void)link_errors();
  }
}
