#include "firmware/board/selftest.h"

#include "firmware/api/status.h"
#include "firmware/base/clear.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/text/catalogue.h"
#include "hal/hal_adc.h"
#include "hal/hal_board.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_selftest.h"
#include "hal/hal_time.h"
#include "hal/qmath/qcall.h"

#define PAIRS_A_PASS 16u  // divides HAL_SELFTEST_PAIRS
#define SERVICES 100u
#define REFERENCE_OFF 82  // codes: 2 % of the range
#define FAILURES 6u
#define WORD_PASSED 6u
#define WORD_UNDER_WAY 7u
#define WORD_NO_SUM 8u
#define WORD_WATCHDOG 9u

selftest_t selftest;

void selftest_reset(void) { clear(&selftest, sizeof selftest); }

drive_fault_t selftest_refusal(void) { return selftest.failed == 0u ? FAULT_NONE : FAULT_SELF_TEST; }

static void judge(bool good, selftest_failure_t failure) {
  if (!good) selftest.failed |= (uint16_t)failure;
}

void selftest_look(void) {
  judge(hal_selftest_gates_are_off(), SELFTEST_GATE_PINS);
  selftest.passed_early = hal_digital_io_gates_pass();
  hal_adc_measure_reference(&selftest.ground, &selftest.reference);
  flash_sum_begin(&selftest.flash);
}

// A service loses half a count on average.
void selftest_count(uint32_t cycles) {
  if (selftest.services >= SERVICES) return;
  selftest.services++;
  selftest.counts = (uint16_t)(selftest.counts + hal_selftest_watchdog_count());
  selftest.cycles += cycles;
  if (selftest.services < SERVICES) return;
  const int32_t expected = (int32_t)(selftest.cycles / HAL_SELFTEST_WATCHDOG_CYCLES) - (int32_t)(SERVICES / 2u);
  judge(qc_abs_sat((int32_t)selftest.counts - expected) <= expected / 8, SELFTEST_CLOCK);
}

static void march(void) {
  for (uint16_t n = 0; n < PAIRS_A_PASS; n++) {
    judge(hal_selftest_ram(selftest.pair), SELFTEST_RAM);
    selftest.pair++;
  }
}

drive_fault_t selftest_service(void) {
  if (selftest.pair < HAL_SELFTEST_PAIRS && !drive_is_energised()) march();
  flash_sum_service(&selftest.flash);
  judge(selftest.flash.state != FLASH_SUM_WRONG, SELFTEST_FLASH);
  if (feature_status.loading) return FAULT_NONE;  // what is wired is not known yet
  const int32_t off = qc_abs_sat((int32_t)selftest.reference - BOARD_REFERENCE_CODE);
  judge(parameters.reference_input == 0 || (off < REFERENCE_OFF && selftest.ground < (uint16_t)REFERENCE_OFF),
        SELFTEST_CONVERTER);
  judge(parameters.gate_feedback == 0 || !selftest.passed_early, SELFTEST_GATE_ENABLE);
  return selftest_refusal();
}

static void put_item(octet_writer_t* w, uint16_t* items, uint16_t word) {
  if (*items != 0u) put_packed(w, SAY_semicolon);
  put_message(w, CATALOGUE_SELFTEST, word);
  (*items)++;
}

static void put_selftest(octet_writer_t* w) {
  uint16_t items = 0u;
  for (uint16_t k = 0; k < FAILURES; k++) {
    if (((uint16_t)(selftest.failed >> k) & 1u) != 0u) put_item(w, &items, k);
  }
  const bool done = selftest.pair >= HAL_SELFTEST_PAIRS && selftest.services >= SERVICES &&
                    selftest.flash.state != FLASH_SUM_UNDER_WAY;
  if (!done) put_item(w, &items, WORD_UNDER_WAY);
  if (done && selftest.failed == 0u) put_item(w, &items, WORD_PASSED);
  if (selftest.flash.state == FLASH_SUM_NONE) put_item(w, &items, WORD_NO_SUM);
  if (hal_watchdog_caused_reset()) put_item(w, &items, WORD_WATCHDOG);
}

const status_line_t selftest_line = {SAY_title_self_test, put_selftest};
