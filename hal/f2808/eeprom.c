// hal_nvm.h with a 24LC256 at address 0x50 of the I2C bus.

#include <stddef.h>

#include "hal/f2808/i2c.h"
#include "hal/hal_nvm.h"
#include "hal/hal_time.h"

#define DEVICE 0x50u
#define TRIES 3u                                            // for a device that does not answer, for a bus that hangs
#define PATIENCE_CYCLES (20000uL * HAL_TIME_CYCLES_PER_US)  // for the write cycle, 5 ms at most

#define LINES_CYCLES (1000uL * HAL_TIME_CYCLES_PER_US)  // for lines to rise, far beyond what they need

typedef enum { STAGE_NONE, STAGE_TRANSFER, STAGE_STORE, STAGE_CLEAR } stage_t;

static i2c_transfer_t job;
static stage_t stage;
static bool begun;             // the stage's transfer; the lines must be high first
static uint32_t wanted_since;  // cycles
static hal_nvm_state_t state;
static hal_nvm_fault_t fault;
static uint16_t refusals;   // transfers that nobody answered
static uint16_t clearings;  // of the bus
static bool patient;        // the device may be storing a page: it does not answer then
static uint32_t since;      // cycles, when that began

bool hal_nvm_init(void) {
  stage = STAGE_NONE;
  state = NVM_IDLE;
  fault = NVM_NO_FAULT;
  i2c_init();
  return i2c_lines_free();
}

static void clear_bus(void) {
  clearings++;
  stage = STAGE_CLEAR;
  i2c_begin_clear();
}

// The job's transfer, or while the device stores the shortest transfer there is.
static void try_to_begin(void) {
  if (!i2c_lines_free()) {
    if (hal_time_cycles() - wanted_since > LINES_CYCLES) clear_bus();
    return;
  }
  i2c_transfer_t transfer = job;
  if (stage == STAGE_STORE) {
    transfer.read = NULL;
    transfer.count = 0;
  }
  begun = true;
  i2c_begin(&transfer);
}

static void begin(stage_t next) {
  stage = next;
  begun = false;
  wanted_since = hal_time_cycles();
  try_to_begin();
}

static bool begin_job(uint16_t address, uint16_t* read, const uint16_t* write, uint16_t count) {
  if (state == NVM_BUSY || count == 0u || address >= HAL_NVM_SIZE || count > HAL_NVM_SIZE - address) return false;
  const i2c_transfer_t transfer = {DEVICE, address, read, write, count};
  job = transfer;
  state = NVM_BUSY;
  fault = NVM_NO_FAULT;
  refusals = 0;
  clearings = 0;
  patient = false;
  begin(STAGE_TRANSFER);
  return true;
}

bool hal_nvm_read(uint16_t address, uint16_t* octets, uint16_t count) {
  return begin_job(address, octets, NULL, count);
}

bool hal_nvm_write(uint16_t address, const uint16_t* octets, uint16_t count) {
  if (address % HAL_NVM_PAGE + count > HAL_NVM_PAGE) return false;
  return begin_job(address, NULL, octets, count);
}

static void end(hal_nvm_state_t result, hal_nvm_fault_t why) {
  stage = STAGE_NONE;
  state = result;
  fault = why;
}

static void be_patient(void) {
  patient = true;
  since = hal_time_cycles();
}

static void on_done(void) {
  if (stage == STAGE_TRANSFER && job.write != NULL) {
    be_patient();
    begin(STAGE_STORE);
  } else {
    end(NVM_DONE, NVM_NO_FAULT);
  }
}

// The time is looked at before the next try: at least one comes after the end of the patience, however rare the steps.
static void on_no_answer(void) {
  refusals++;
  const bool again = patient ? hal_time_cycles() - since < PATIENCE_CYCLES : refusals < TRIES;
  if (again) {
    begin(stage);
  } else if (patient) {
    patient = false;
    refusals = TRIES - 1u;
    begin(stage);
  } else {
    end(NVM_FAILED, NVM_NO_ANSWER);
  }
}

static void on_stuck(void) {
  if (clearings < TRIES) {
    clear_bus();
  } else {
    end(NVM_FAILED, NVM_BUS_HUNG);
  }
}

// The whole job again. The stop behind the clocks may have made the device store what it had got of a page.
static void step_clearing(void) {
  const i2c_result_t result = i2c_clear_step();
  if (result == I2C_BUSY) return;
  if (result == I2C_STUCK) {
    end(NVM_FAILED, NVM_BUS_HUNG);
    return;
  }
  be_patient();
  begin(STAGE_TRANSFER);
}

hal_nvm_state_t hal_nvm_step(void) {
  if (state != NVM_BUSY) return state;
  if (stage == STAGE_CLEAR) {
    step_clearing();
    return state;
  }
  if (!begun) {
    try_to_begin();
    return state;
  }
  switch (i2c_step()) {
    case I2C_DONE:
      on_done();
      break;
    case I2C_NO_ANSWER:
      on_no_answer();
      break;
    case I2C_STUCK:
      on_stuck();
      break;
    default:
      break;
  }
  return state;
}

hal_nvm_fault_t hal_nvm_fault(void) { return fault; }
