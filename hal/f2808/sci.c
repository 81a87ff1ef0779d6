#include "hal/f2808/f2808_values.h"
#include "hal/f2808/gpio.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_sci.h"

#define SCI SCI_BASE(1u)

#define FIFO_DEPTH 16u
#define OCTETS_PER_PERIOD 4u
#define SAMPLES_PER_BIT ((uint32_t)8u)
#define LSPCLK_HZ ((uint32_t)50000000uL)  // see hal_clock_init
#define WORST_RATE_PER_MILLE ((uint32_t)20u)

#define FIFO_TRANSMIT_RUNS (SCI_FFTX_SCIRST_MASK | SCI_FFTX_SCIFFENA_MASK | SCI_FFTX_TXFIFOXRESET_MASK)
#define FIFO_RECEIVE_RUNS ((uint16_t)(SCI_FFRX_RXFIFORESET_MASK | REG_FIELD(SCI_FFRX_RXFFIL, SCI_FIFO_LEVEL_NEVER)))
#define PORT_RUNS (SCI_CTL1_RXENA_MASK | SCI_CTL1_TXENA_MASK | SCI_CTL1_SWRESET_MASK)

// One writes `in`, the other `out`, so that neither level needs a lock. Both run freely; their difference is the fill.
typedef struct {
  volatile uint16_t in;
  volatile uint16_t out;
} ring_t;

static struct {
  volatile bool ready;
  bool broken;  // after a break, until the port has been reset
  uint16_t breaks_taken;
  volatile uint16_t break_at;  // in the receive ring: what lies before it came before the last break
  ring_t receive_ring, transmit_ring;
  hal_sci_errors_t errors;
  uint16_t received[HAL_SCI_RECEIVE_RING];
  uint16_t to_send[HAL_SCI_TRANSMIT_RING];
} self;

static uint16_t fill(const ring_t* ring) { return (uint16_t)(ring->in - ring->out); }

static void count(uint16_t* counter) {
  if (*counter < UINT16_MAX) (*counter)++;
}

// ---- set-up --------------------------------------------------------------------------------------------

// The divider's register value for the rate, or false when it misses the rate by more than 2 %.
static bool divider_for(uint32_t baud, uint16_t* divider) {
  if (baud == 0uL || baud > HAL_SCI_MAX_BAUD) return false;
  const uint32_t unit = SAMPLES_PER_BIT * baud;
  const uint32_t cycles = (LSPCLK_HZ + unit / 2u) / unit;
  if (cycles > 65536uL) return false;
  const uint32_t actual = LSPCLK_HZ / (SAMPLES_PER_BIT * cycles);
  const uint32_t off = actual > baud ? actual - baud : baud - actual;
  *divider = (uint16_t)(cycles - 1u);
  return off * 1000u <= WORST_RATE_PER_MILLE * baud;
}

static void connect_pins(void) {
  gpio_connect(BOARD_PIN_SERIAL_IN);
  gpio_connect(BOARD_PIN_SERIAL_OUT);
}

static void forget(void) {
  self.receive_ring.in = self.receive_ring.out = 0u;
  self.transmit_ring.in = self.transmit_ring.out = 0u;
  self.errors = (hal_sci_errors_t){0u, 0u, 0u, 0u};
  self.breaks_taken = 0u;
  self.broken = false;
}

bool hal_sci_init(uint32_t baud) {
  uint16_t divider = 0u;
  if (!divider_for(baud, &divider)) return false;
  self.ready = false;  // the control interrupt keeps its hands off meanwhile
  target_write16(SCI + SCI_CTL1, 0u);
  forget();
  target_write16(SCI + SCI_CCR, REG_FIELD(SCI_CCR_SCICHAR, SCICHAR_8_BITS));
  target_write16(SCI + SCI_CTL2, 0u);
  target_write16(SCI + SCI_HBAUD, (uint16_t)(divider >> 8));
  target_write16(SCI + SCI_LBAUD, (uint16_t)(divider & 0xFFu));
  target_write16(SCI + SCI_FFCT, 0u);
  target_write16(SCI + SCI_FFTX, 0u);
  target_write16(SCI + SCI_FFRX, SCI_FFRX_RXFFOVRCLR_MASK);
  connect_pins();
  target_write16(SCI + SCI_FFTX, FIFO_TRANSMIT_RUNS);
  target_write16(SCI + SCI_FFRX, FIFO_RECEIVE_RUNS);
  target_write16(SCI + SCI_CTL1, PORT_RUNS);
  self.ready = true;
  return true;
}

// ---- control interrupt level ---------------------------------------------------------------------------

static void keep(uint16_t word) {
  if ((word & SCI_RXBUF_SCIFFFE_MASK) != 0u) {
    count(&self.errors.framing);
  } else if (fill(&self.receive_ring) >= HAL_SCI_RECEIVE_RING) {
    count(&self.errors.lost);
  } else {
    self.received[self.receive_ring.in % HAL_SCI_RECEIVE_RING] = (uint16_t)(word & SCI_RXBUF_RXDT_MASK);
    self.receive_ring.in++;
  }
}

static void receive(void) {
  const uint16_t fifo = target_read16(SCI + SCI_FFRX);
  uint16_t waiting = (uint16_t)((fifo & SCI_FFRX_RXFFST_MASK) >> SCI_FFRX_RXFFST_LSB);
  if (waiting > OCTETS_PER_PERIOD) waiting = OCTETS_PER_PERIOD;
  for (uint16_t k = 0u; k < waiting; k++) keep(target_read16(SCI + SCI_RXBUF));
  if ((fifo & SCI_FFRX_RXFFOVF_MASK) != 0u) {
    count(&self.errors.overrun);
    target_write16(SCI + SCI_FFRX, (uint16_t)(FIFO_RECEIVE_RUNS | SCI_FFRX_RXFFOVRCLR_MASK));
  }
}

// A break stops the receiver until the port is reset. On a line that is still low a reset would give the next break at
// once, and it cuts what is being sent: it waits for the line to rise and then for the transmitter, which gets nothing
// new meanwhile. False while it must get nothing.
static bool may_send_on(void) {
  if (!self.broken) {
    if (!reg_any(SCI + SCI_RXST, SCI_RXST_BRKDT_MASK)) return true;
    self.broken = true;
    self.break_at = self.receive_ring.in;
    self.errors.breaks++;
  }
  if (!gpio_read(BOARD_PIN_SERIAL_IN)) return true;
  if (!reg_any(SCI + SCI_CTL2, SCI_CTL2_TXEMPTY_MASK)) return false;
  target_write16(SCI + SCI_CTL1, (uint16_t)(PORT_RUNS & ~SCI_CTL1_SWRESET_MASK));
  target_write16(SCI + SCI_CTL1, PORT_RUNS);
  self.broken = false;
  return true;
}

static void transmit(void) {
  uint16_t waiting = fill(&self.transmit_ring);
  if (waiting == 0u) return;
  const uint16_t used = REG_GET_FIELD(SCI + SCI_FFTX, SCI_FFTX_TXFFST);
  const uint16_t free_words = (uint16_t)(FIFO_DEPTH - used);
  if (waiting > OCTETS_PER_PERIOD) waiting = OCTETS_PER_PERIOD;
  if (waiting > free_words) waiting = free_words;
  for (uint16_t k = 0u; k < waiting; k++) {
    target_write16(SCI + SCI_TXBUF, self.to_send[self.transmit_ring.out % HAL_SCI_TRANSMIT_RING]);
    self.transmit_ring.out++;
  }
}

void hal_sci_service(void) {
  if (!self.ready) return;
  receive();
  if (may_send_on()) transmit();
}

// ---- background level ----------------------------------------------------------------------------------

uint16_t hal_sci_read(uint16_t* octets, uint16_t room) {
  uint16_t taken = 0u;
  while (taken < room && fill(&self.receive_ring) > 0u) {
    octets[taken++] = self.received[self.receive_ring.out % HAL_SCI_RECEIVE_RING];
    self.receive_ring.out++;
  }
  return taken;
}

// What has been read beyond it was read before its break was counted.
bool hal_sci_take_break(void) {
  const uint16_t breaks = self.errors.breaks;
  if (breaks == self.breaks_taken) return false;
  self.breaks_taken = breaks;
  const uint16_t at = self.break_at;
  if ((uint16_t)(at - self.receive_ring.out) <= HAL_SCI_RECEIVE_RING) self.receive_ring.out = at;
  return true;
}

uint16_t hal_sci_room(void) { return (uint16_t)(HAL_SCI_TRANSMIT_RING - fill(&self.transmit_ring)); }

uint16_t hal_sci_write(const uint16_t* octets, uint16_t count_of) {
  uint16_t put = 0u;
  while (put < count_of && hal_sci_room() > 0u) {
    self.to_send[self.transmit_ring.in % HAL_SCI_TRANSMIT_RING] = (uint16_t)(octets[put++] & 0xFFu);
    self.transmit_ring.in++;
  }
  return put;
}

hal_sci_errors_t hal_sci_errors(void) { return self.errors; }
