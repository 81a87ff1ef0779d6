#include "firmware/store/power_on.h"

#include "firmware/api/status.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "firmware/store/store.h"
#include "hal/hal_nvm.h"
#include "hal/hal_sci.h"

void store_load_at_power_on(void) {
  if (feature_status.loading) {
    store_service();
    return;
  }
  (void)hal_nvm_init();  // a bus that hangs is the first job's business
  feature_status.loading = true;
  store_begin();
}

void store_end_loading(void) {
  if (!feature_status.loading || store_is_busy() || drive.request.reload) return;
  feature_status.loading = false;
  if (parameters.baud_rate != (int32_t)HAL_SCI_USUAL_BAUD) (void)hal_sci_init((uint32_t)parameters.baud_rate);
}
