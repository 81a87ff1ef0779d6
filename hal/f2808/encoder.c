#include "hal/f2808/f2808_values.h"
#include "hal/f2808/gpio.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_encoder.h"
#include "hal/hal_replay.h"

#define EQEP EQEP_BASE(1u)

// Six samples 100 ns apart: an edge has to last 0.5 us. At 6000 rpm 1024 lines give an edge every 2.4 us.
#define FILTER_SAMPLE_HALF_CYCLES 5u

static void connect_pins(void) {
  target_eallow();
  reg32_change(REG_GPACTRL, GPACTRL_QUALPRD2_MASK, (uint32_t)FILTER_SAMPLE_HALF_CYCLES << GPACTRL_QUALPRD2_LSB);
  target_edis();
  gpio_give_to_peripheral(BOARD_PIN_ENCODER_A, GPIO_MUX_FIRST, GPIO_QUALIFY_6_SAMPLES, true);
  gpio_give_to_peripheral(BOARD_PIN_ENCODER_B, GPIO_MUX_FIRST, GPIO_QUALIFY_6_SAMPLES, true);
  gpio_give_to_peripheral(BOARD_PIN_ENCODER_INDEX, GPIO_MUX_FIRST, GPIO_QUALIFY_6_SAMPLES, true);
}

void hal_encoder_init(uint32_t counts_per_turn) {
  target_write16(EQEP + EQEP_QEPCTL, 0u);
  target_write16(EQEP + EQEP_QDECCTL, REG_FIELD(EQEP_QDECCTL_QSRC, QDECCTL_QSRC_QUADRATURE));
  target_write32(EQEP + EQEP_QPOSINIT, 0uL);
  target_write32(EQEP + EQEP_QPOSMAX, counts_per_turn - 1u);
  // The pins first: their levels at connection may look like an edge.
  connect_pins();
  target_write32(EQEP + EQEP_QPOSCNT, 0uL);
  target_write16(EQEP + EQEP_QEPCTL, REG_FIELD(EQEP_QEPCTL_PCRM, QEPCTL_PCRM_MAXIMUM) |
                                         REG_FIELD(EQEP_QEPCTL_FREE_SOFT, QEPCTL_FREE_RUN) | EQEP_QEPCTL_QPEN_MASK);
}

// The counter itself, not the unit timer's latch: the timer cannot be started in step with the PWM, so the latch would
// be up to a period old by an unknown amount, while a read in the control interrupt is late by less than a microsecond,
// 0.4 counts at 6000 rpm. The 32-bit read is one access.
uint32_t hal_encoder_count(void) {
  replay_call();
  if (replay_plays()) {
    const uint32_t low = replay_take();
    return low | ((uint32_t)replay_take() << 16);
  }
  const uint32_t count = target_read32(EQEP + EQEP_QPOSCNT);
  (void)replay_note((uint16_t)(count & 0xFFFFuL));
  (void)replay_note((uint16_t)(count >> 16));
  return count;
}
