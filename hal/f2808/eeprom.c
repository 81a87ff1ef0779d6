// hal_nvm.h with a 24LC256 at address 0x50 of the I2C bus.

#include <stddef.h>

#include "hal/f2808/i2c.h"
#include "hal/hal_nvm.h"
#include "hal/hal_time.h"

#define DEVICE 0x50u
#define TRIES 3u                                            // for a device that does not answer, for a bus that hangs
#define PATIENCE_CYCLES (20000uL * HAL_TIME_CYCLES_PER_US)  // for the write cycle, 5 ms at most

#define LINES_CYCLES (1000uL * HAL_TIME_CYCLES_PER_US)  // for lines to rise, far beyond what they need

enum { STAGE_NONE, STAGE_TRANSFER, STAGE_STORE, STAGE_CLEAR };

static struct {
  uint32_t wanted_since;  // cycles
  uint32_t since;         // cycles, when that began
  uint16_t stage;
  uint16_t state;      // hal_nvm_state_t
  uint16_t fault;      // hal_nvm_fault_t
  bool begun;          // the stage's transfer; the lines must be high first
  uint16_t refusals;   // transfers that nobody answered
  uint16_t clearings;  // of the bus
  bool patient;        // the device may be storing a page: it does not answer then
  i2c_transfer_t job;
} self;

bool hal_nvm_init(void) {
  self.stage = STAGE_NONE;
  self.state = NVM_IDLE;
  self.fault = NVM_NO_FAULT;
  i2c_init();
  return i2c_lines_free();
}

static void clear_bus(void) {
  self.clearings++;
  self.stage = STAGE_CLEAR;
  i2c_begin_clear();
}

// The job's transfer, or while the device stores the shortest transfer there is.
static void try_to_begin(void) {
  if (!i2c_lines_free()) {
    if (hal_time_cycles() - self.wanted_since > LINES_CYCLES) clear_bus();
    return;
  }
  i2c_transfer_t transfer = self.job;
  if (self.stage == STAGE_STORE) {
    transfer.read = NULL;
    transfer.count = 0;
  }
  self.begun = true;
  i2c_begin(&transfer);
}

static void begin(uint16_t next) {
  self.stage = next;
  self.begun = false;
  self.wanted_since = hal_time_cycles();
  try_to_begin();
}

static bool begin_job(uint16_t address, uint16_t* read, const uint16_t* write, uint16_t count) {
  if (self.state == NVM_BUSY || count == 0u || address >= HAL_NVM_SIZE || count > HAL_NVM_SIZE - address) return false;
  const i2c_transfer_t transfer = {DEVICE, address, read, write, count};
  self.job = transfer;
  self.state = NVM_BUSY;
  self.fault = NVM_NO_FAULT;
  self.refusals = 0;
  self.clearings = 0;
  self.patient = false;
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
  self.stage = STAGE_NONE;
  self.state = (uint16_t)result;
  self.fault = (uint16_t)why;
}

static void be_patient(void) {
  self.patient = true;
  self.since = hal_time_cycles();
}

static void on_done(void) {
  if (self.stage == STAGE_TRANSFER && self.job.write != NULL) {
    be_patient();
    begin(STAGE_STORE);
  } else {
    end(NVM_DONE, NVM_NO_FAULT);
  }
}

// The time is looked at before the next try: at least one comes after the end of the patience, however rare the steps.
static void on_no_answer(void) {
  self.refusals++;
  const bool again = self.patient ? hal_time_cycles() - self.since < PATIENCE_CYCLES : self.refusals < TRIES;
  if (again) {
    begin(self.stage);
  } else if (self.patient) {
    self.patient = false;
    self.refusals = TRIES - 1u;
    begin(self.stage);
  } else {
    end(NVM_FAILED, NVM_NO_ANSWER);
  }
}

static void on_stuck(void) {
  if (self.clearings < TRIES) {
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
  if (self.state != NVM_BUSY) return (hal_nvm_state_t)self.state;
  if (self.stage == STAGE_CLEAR) {
    step_clearing();
    return (hal_nvm_state_t)self.state;
  }
  if (!self.begun) {
    try_to_begin();
    return (hal_nvm_state_t)self.state;
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
  return (hal_nvm_state_t)self.state;
}

hal_nvm_fault_t hal_nvm_fault(void) { return (hal_nvm_fault_t)self.fault; }
