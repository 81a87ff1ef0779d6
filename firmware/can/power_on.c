#include "firmware/can/node.h"
#include "firmware/link/requests.h"

// Requests come over the bus as they come over the serial port.
static uint16_t answer(const uint16_t* request, uint16_t count, uint16_t* record) {
  return request_answer(COMM_WATCHDOG_BUS, request, count, record);
}

void can_power_on(void) { can_node_reset(answer); }
