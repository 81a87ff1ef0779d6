// Compiled with a 16-bit int alone: what the HAL returns as a structure, which the two compilers hand over differently.

#include "hal/hal_can.h"
#include "hal/hal_sci.h"
#include "tests/fuzz/fuzz_drive.h"

hal_sci_errors_t hal_sci_errors(void) {
  uint16_t flat[4];
  fuzz_board_serial_errors(flat);
  const hal_sci_errors_t errors = {flat[0], flat[1], flat[2], flat[3]};
  return errors;
}

hal_can_status_t hal_can_status(void) {
  uint16_t flat[6];
  fuzz_board_can_status(flat);
  const hal_can_status_t status = {(hal_can_state_t)flat[0], flat[1], flat[2], flat[3], flat[4], flat[5]};
  return status;
}
