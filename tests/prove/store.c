// The store with any contents of its memory, which may change between any two jobs as they do when the power fails or a
// disturbance hits the bus; any parameters; and any order of loads, saves and power-ons, each broken off anywhere.

#include "firmware/store/store.h"

#include "firmware/config/rules.h"
#include "firmware/mode/mode.h"
#include "hal/hal_nvm.h"
#include "tests/prove/any_parameters.h"

bool hal_nvm_read(uint16_t address, uint16_t* octets, uint16_t count) {
  (void)address;
  //@ assert 1 <= count <= 64 && \valid(octets + (0 .. count - 1));
  for (uint16_t k = 0; k < count; k++) octets[k] = any_up_to(0xFF);
  return any_bool();
}

bool hal_nvm_write(uint16_t address, const uint16_t* octets, uint16_t count) {
  (void)address;
  //@ assert count <= HAL_NVM_PAGE && \initialized(octets + (0 .. count - 1));
  return any_bool();
}

hal_nvm_state_t hal_nvm_step(void) { return (hal_nvm_state_t)any_up_to(NVM_FAILED); }

bool drive_is_energised(void) { return any_bool(); }
bool drive_source_is_left_out(const parameters_t* p) { return p->position_source > 0 && any_bool(); }
void drive_parameters_changed(void) {}
packed_text_t parameter_conflict(void) { return any_bool() ? PACKED_NONE : any_up_to(PACKED_NONE - 1u); }

static void ask(void) {
  (void)store_state();
  (void)store_progress();
  (void)store_report();
  if (any_bool()) (void)store_save();
  if (any_bool()) (void)store_load();
  if (any_bool()) (void)store_defaults();
}

void prove_store(void) {
  store_reset();
  while (any_bool()) {
    if (any_bool()) store_begin();
    if (any_bool()) any_parameters();
    store_service();
    ask();
  }
}
