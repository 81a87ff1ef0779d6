#include "hal/f2808/i2c.h"

#include <stddef.h>

#include "hal/f2808/f2808_values.h"
#include "hal/f2808/gpio.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_time.h"

// Module clock 10 MHz; 13 clocks low and 12 high, 5 of each are the module's own.
#define PRESCALE 9u
#define CLOCKS_LOW 8u
#define CLOCKS_HIGH 7u

#define FIFO_DEPTH 16u
#define ADDRESS_OCTETS 2u
#define STANDSTILL_CYCLES (10000uL * HAL_TIME_CYCLES_PER_US)
#define HALF_CLOCK_CYCLES (10uL * HAL_TIME_CYCLES_PER_US)
#define CLEAR_CLOCKS 9u
#define STOP_EDGE (2u * CLEAR_CLOCKS)

#define MODE_ON (I2C_MDR_IRS_MASK | I2C_MDR_FREE_MASK)
#define MODE_START ((uint16_t)(MODE_ON | I2C_MDR_STT_MASK | I2C_MDR_MST_MASK))
#define MODE_STOP ((uint16_t)(MODE_ON | I2C_MDR_STP_MASK | I2C_MDR_MST_MASK))

// NONE: before the first transfer.
enum { PHASE_NONE, PHASE_ADDRESS, PHASE_SEND, PHASE_RECEIVE, PHASE_ABORT };

static struct {
  uint32_t moved_at;  // cycles of the last progress
  uint32_t clear_at;
  uint16_t phase;
  uint16_t moved;  // octets of the job that went through the FIFO
  uint16_t level_seen;
  uint16_t clear_edge;
  i2c_transfer_t job;
} self;

static void write_register(uint16_t offset, uint16_t value) { target_write16(I2C_BASE + offset, value); }
static uint16_t read_register(uint16_t offset) { return target_read16(I2C_BASE + offset); }

static void empty_fifos(void) {
  write_register(I2C_FFTX, I2C_FFTX_I2CFFEN_MASK);
  write_register(I2C_FFRX, 0u);
  write_register(I2C_FFTX, I2C_FFTX_I2CFFEN_MASK | I2C_FFTX_TXFFRST_MASK);
  write_register(I2C_FFRX, I2C_FFRX_RXFFRST_MASK);
}

static void start_module(void) {
  write_register(I2C_MDR, 0u);
  write_register(I2C_PSC, PRESCALE);
  write_register(I2C_CLKL, CLOCKS_LOW);
  write_register(I2C_CLKH, CLOCKS_HIGH);
  write_register(I2C_IER, 0u);
  write_register(I2C_MDR, MODE_ON);
  empty_fifos();
}

static void give_pins_to_module(void) {
  gpio_connect(BOARD_PIN_SDA);
  gpio_connect(BOARD_PIN_SCL);
}

void i2c_init(void) {
  start_module();
  give_pins_to_module();
}

bool i2c_lines_free(void) { return gpio_read(BOARD_PIN_SDA) && gpio_read(BOARD_PIN_SCL); }

// ---- transfers
// -------------------------------------------------------------------------------------------------------

static void note_progress(void) { self.moved_at = hal_time_cycles(); }

void i2c_begin(const i2c_transfer_t* transfer) {
  self.job = *transfer;
  self.moved = 0;
  self.level_seen = 0;
  note_progress();
  empty_fifos();
  write_register(I2C_STR, 0xFFFFu);  // what the last transfer has left
  write_register(I2C_SAR, self.job.device);
  write_register(I2C_DXR, (uint16_t)(self.job.address >> 8));
  write_register(I2C_DXR, (uint16_t)(self.job.address & 0xFFu));
  if (self.job.read != NULL) {
    self.phase = PHASE_ADDRESS;
    write_register(I2C_CNT, ADDRESS_OCTETS);
    write_register(I2C_MDR, MODE_START | I2C_MDR_TRX_MASK);
  } else {
    self.phase = PHASE_SEND;
    write_register(I2C_CNT, (uint16_t)(ADDRESS_OCTETS + self.job.count));
    write_register(I2C_MDR, MODE_START | I2C_MDR_TRX_MASK | I2C_MDR_STP_MASK);
  }
}

static bool has_stopped(void) { return (read_register(I2C_MDR) & I2C_MDR_MST_MASK) == 0u; }

// The module waits behind an octet that nobody acknowledged, unless it was told to stop anyway.
static void abort_transfer(void) {
  self.phase = PHASE_ABORT;
  write_register(I2C_STR, I2C_STR_NACK_MASK);
  empty_fifos();
  note_progress();
  if (!has_stopped()) write_register(I2C_MDR, MODE_STOP);
}

static void fill(void) {
  uint16_t level = REG_GET_FIELD(I2C_BASE + I2C_FFTX, I2C_FFTX_TXFFST);
  if (level != self.level_seen) note_progress();
  while (level < FIFO_DEPTH && self.moved < self.job.count) {
    write_register(I2C_DXR, self.job.write[self.moved]);
    self.moved++;
    level++;
  }
  self.level_seen = level;
}

static void drain(void) {
  uint16_t level = REG_GET_FIELD(I2C_BASE + I2C_FFRX, I2C_FFRX_RXFFST);
  if (level > 0u) note_progress();
  for (; level > 0u && self.moved < self.job.count; level--) {
    self.job.read[self.moved] = read_register(I2C_DRR);
    self.moved++;
  }
}

static void begin_reception(void) {
  self.phase = PHASE_RECEIVE;
  note_progress();
  write_register(I2C_CNT, self.job.count);
  write_register(I2C_MDR, MODE_START | I2C_MDR_STP_MASK);
}

// True when the transfer's work is done.
static bool advance(uint16_t status) {
  switch (self.phase) {
    case PHASE_ADDRESS:
      if ((status & I2C_STR_ARDY_MASK) != 0u) begin_reception();
      return false;
    case PHASE_SEND:
      fill();
      return self.moved == self.job.count && has_stopped();
    case PHASE_RECEIVE:
      drain();
      return self.moved == self.job.count && has_stopped();
    default:
      return has_stopped();
  }
}

i2c_result_t i2c_step(void) {
  const uint16_t status = read_register(I2C_STR);
  if ((status & I2C_STR_AL_MASK) != 0u) return I2C_STUCK;
  if ((status & I2C_STR_NACK_MASK) != 0u) {
    abort_transfer();
    return I2C_BUSY;
  }
  const bool aborted = self.phase == PHASE_ABORT;
  if (advance(status)) return aborted ? I2C_NO_ANSWER : I2C_DONE;
  return (hal_time_cycles() - self.moved_at > STANDSTILL_CYCLES) ? I2C_STUCK : I2C_BUSY;
}

// ---- clearing the bus
// --------------------------------------------------------------------------------------------------

void i2c_begin_clear(void) {
  write_register(I2C_MDR, 0u);
  gpio_make_open_drain(BOARD_PIN_SDA);
  gpio_make_open_drain(BOARD_PIN_SCL);
  self.clear_edge = 0;
  self.clear_at = hal_time_cycles();
}

static i2c_result_t end_clear(i2c_result_t result) {
  gpio_pull_low(BOARD_PIN_SDA, false);
  gpio_pull_low(BOARD_PIN_SCL, false);
  i2c_init();
  return result;
}

// Clocks until the device has let SDA go: it takes the high SDA for a missing acknowledge. Then a stop, which is a rise
// of SDA while SCL is high. Edges 0, 2, .. pull SCL low, 1, 3, .. let it go; those of the stop pull SCL low, SDA low,
// and let them go in that order.
i2c_result_t i2c_clear_step(void) {
  if (hal_time_cycles() - self.clear_at < HALF_CLOCK_CYCLES) return I2C_BUSY;
  self.clear_at = hal_time_cycles();
  const uint16_t edge = self.clear_edge++;
  const bool odd = (edge & 1u) != 0u;
  if (edge < STOP_EDGE) {
    gpio_pull_low(BOARD_PIN_SCL, !odd);
    if (odd && gpio_read(BOARD_PIN_SDA)) self.clear_edge = STOP_EDGE;
    return I2C_BUSY;
  }
  const bool over = edge == STOP_EDGE + 4u;
  if (edge == STOP_EDGE || over) {
    const bool is_free = i2c_lines_free();
    if (over || !is_free) return end_clear(is_free ? I2C_DONE : I2C_STUCK);
  }
  gpio_pull_low(odd ? BOARD_PIN_SDA : BOARD_PIN_SCL, edge < STOP_EDGE + 2u);
  return I2C_BUSY;
}
