#include "hal/f2808/watchdog.h"

#include "hal/f2808/f2808_values.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_time.h"

// A write of 0 to WDFLAG leaves the cause of the last reset readable.
static void write_control(uint16_t bits) {
  target_eallow();
  target_write16(REG_WDCR, (uint16_t)(REG_FIELD(WDCR_WDCHK, WDCR_WDCHK_KEY) | bits));
  target_edis();
}

void watchdog_stop(void) { write_control(WDCR_WDDIS_MASK); }

void hal_watchdog_start(void) {
  target_eallow();
  // A plain write of 0: reset, not interrupt, on expiry; and the bit that locks WDDIS for good is not touched, because
  // reprogramming the flash has to stop the watchdog.
  target_write16(REG_SCSR, 0u);
  target_edis();
  hal_watchdog_service();
  write_control(REG_FIELD(WDCR_WDPS, WDCR_WDPS_DIVIDE_BY_4));
}

void hal_watchdog_service(void) {
  target_eallow();
  target_write16(REG_WDKEY, WDKEY_FIRST);
  target_write16(REG_WDKEY, WDKEY_SECOND);
  target_edis();
}

bool hal_watchdog_caused_reset(void) { return reg_any(REG_WDCR, WDCR_WDFLAG_MASK); }
