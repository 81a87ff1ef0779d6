// The drivers of the background level: the CAN controller with any groups, rates and frames, the memory on the I2C bus
// with any jobs, the self-test's RAM, TI's flash library with any answers. Any contents of every register at every
// access, the calls in any order.

#include "hal/f2808/flash_library.h"
#include "hal/hal_board.h"
#include "hal/hal_can.h"
#include "hal/hal_flash.h"
#include "hal/hal_nvm.h"
#include "hal/hal_selftest.h"
#include "hal/hal_time.h"
#include "tests/prove/any.h"

uint32_t hal_time_cycles(void) { return any_u32; }

uint32_t Flash_CPUScaleFactor;
void (*Flash_CallbackPtr)(void);

uint16_t Flash2808_Erase(uint16_t sectors, flash_library_status_t* status) {
  //@ assert sectors == 2 || sectors == 4 || sectors == 8;
  status->first_failed = any_u32 + sectors;
  return any_u16;
}

uint16_t Flash2808_Program(uint16_t* to, uint16_t* from, uint32_t words, flash_library_status_t* status) {
  (void)to;
  (void)from;
  //@ assert words <= HAL_FLASH_UPDATE_END - HAL_FLASH_START;
  status->first_failed = any_u32 + words;
  return any_u16;
}

static uint16_t octets[HAL_NVM_SIZE];

static void exchange_frames(void) {
  hal_can_group_t groups[HAL_CAN_GROUPS_MAX];
  hal_can_frame_t frame = {any_u32, any_bool(), any_u16, {0u}};
  for (uint16_t k = 0; k < HAL_CAN_GROUPS_MAX; k++) {
    groups[k].id = any_u32;
    groups[k].mask = any_u32;
    groups[k].extended = any_bool();
    groups[k].mailboxes = any_u16;
  }
  for (uint16_t k = 0; k < 8u; k++) frame.data[k] = any_u16;
  if (any_bool()) (void)hal_can_init(any_u32, groups, any_u16);
  if (any_bool()) hal_can_off();
  hal_can_service();
  (void)hal_can_send(&frame, any_u16);
  (void)hal_can_receive(any_u16, &frame);
  hal_can_cancel(any_u16);
  (void)hal_can_waiting(any_u16);
  (void)hal_can_status();
  hal_can_recover();
}

static void remember(void) {
  if (any_bool()) (void)hal_nvm_init();
  if (any_bool()) (void)hal_nvm_read(any_u16, octets, any_up_to(HAL_NVM_SIZE));
  if (any_bool()) (void)hal_nvm_write(any_u16, octets, any_up_to(HAL_NVM_SIZE));
  (void)hal_nvm_step();
  (void)hal_nvm_fault();
}

static void program(void) {
  hal_flash_open();
  (void)hal_flash_is_locked();
  (void)hal_flash_part();
  (void)hal_flash_revision();
  (void)hal_flash_read(any_u32);
  (void)hal_flash_erase(any_u16);
  (void)hal_flash_program(any_u32, octets, any_u16);
  (void)hal_flash_failure();
  hal_flash_pass(any_u16);
}

static void test(void) {
  (void)hal_selftest_ram(any_up_to(HAL_SELFTEST_PAIRS - 1u));
  (void)hal_selftest_watchdog_count();
  (void)hal_selftest_gates_are_off();
}

void prove_devices(void) {
  while (any_bool()) {
    exchange_frames();
    remember();
    program();
    test();
  }
}
