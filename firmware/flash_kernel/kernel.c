// Nothing here relies on a variable that is zero at the start: the boot ROM clears none, and no start-up code does.

#include "firmware/flash_kernel/kernel.h"

#include "firmware/link/splitter.h"
#include "hal/hal_clock.h"
#include "hal/hal_flash.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"

#define LOOP_CYCLES 100u  // 1 us; an octet takes 87
#define CYCLES_PER_MS (HAL_TIME_CYCLES_PER_S / 1000uL)
#define LAST_OCTET_MS 5uL  // an answer is on its way before the chip resets

static splitter_t splitter;
static uint32_t now_ms;
static uint32_t counted_cycles;

static uint32_t milliseconds(void) {
  const uint32_t cycles = hal_time_cycles();
  while (cycles - counted_cycles >= CYCLES_PER_MS) {
    counted_cycles += CYCLES_PER_MS;
    now_ms++;
  }
  return now_ms;
}

static void pass_a_moment(void) {
  hal_sci_service();
  hal_flash_pass(LOOP_CYCLES);
}

static void send(uint16_t* record, uint16_t count) {
  static uint16_t wire[RECORD_ENCODED_MAX + 2u];
  (void)hal_sci_write(wire, record_to_wire(record, count, wire));
}

// By the watchdog, behind the answer.
static void restart(void) {
  const uint32_t begin = milliseconds();
  while (hal_sci_room() < HAL_SCI_TRANSMIT_RING || milliseconds() - begin < LAST_OCTET_MS) pass_a_moment();
  hal_watchdog_start();
  for (;;) pass_a_moment();
}

static void serve(uint16_t octet) {
  static uint16_t answer[RECORD_MAX];
  if (splitter_octet(&splitter, octet, milliseconds()) != SPLITTER_RECORD) return;
  const uint16_t type = splitter.octets[0];
  const uint16_t count = kernel_answer(splitter.octets, splitter.count, answer);
  const bool leave = type == KERNEL_RESTART && answer[2] == KERNEL_OK;
  send(answer, count);
  if (leave) restart();
}

void flash_kernel_main(void) {
  const bool clock = hal_clock_init();
  hal_time_init();
  now_ms = 0uL;
  counted_cycles = 0uL;
  splitter_reset(&splitter);
  if (clock && hal_sci_init(KERNEL_BAUD)) hal_flash_open();  // else the host hears nothing and says so
  for (;;) {
    uint16_t octet = 0u;
    pass_a_moment();
    (void)splitter_rest(&splitter, milliseconds());
    if (hal_sci_read(&octet, 1u) == 1u) serve(octet);
  }
}
