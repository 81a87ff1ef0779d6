#include <stddef.h>

#include "hal/f2808/f2808_values.h"
#include "hal/f2808/gpio.h"
#include "hal/f2808/pie.h"
#include "hal/f2808/pwm_modules.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_pwm.h"
#include "hal/hal_replay.h"

#define POLARITY (BOARD_GATE_ON_LEVEL != 0u ? DBCTL_POLSEL_HIGH_COMPLEMENTARY : DBCTL_POLSEL_LOW_COMPLEMENTARY)
#define TRIP_LEVEL (BOARD_GATE_ON_LEVEL != 0u ? TZCTL_FORCE_LOW : TZCTL_FORCE_HIGH)

static void set_time_base_clock(uint16_t running) {
  target_eallow();
  REG_SET_FIELD(REG_PCLKCR0, PCLKCR0_TBCLKSYNC, running);
  target_edis();
}

static void set_up_time_base(uint16_t module) {
  const uint32_t epwm = EPWM_BASE(module);
  const bool master = module == PWM_MASTER_MODULE;
  // Every period the slaves are loaded with the count that they have anyway: nothing moves, unless one of them has
  // lost its step.
  target_write16(
      epwm + EPWM_TBCTL,
      (uint16_t)(REG_FIELD(EPWM_TBCTL_CTRMODE, TBCTL_CTRMODE_UP) | REG_FIELD(EPWM_TBCTL_PHSEN, master ? 0u : 1u) |
                 REG_FIELD(EPWM_TBCTL_PRDLD, TBCTL_PRDLD_IMMEDIATE) |
                 REG_FIELD(EPWM_TBCTL_SYNCOSEL, master ? TBCTL_SYNCOSEL_ZERO : TBCTL_SYNCOSEL_SYNCI) |
                 REG_FIELD(EPWM_TBCTL_HSPCLKDIV, TBCTL_HSPCLKDIV_1) | REG_FIELD(EPWM_TBCTL_CLKDIV, TBCTL_CLKDIV_1) |
                 REG_FIELD(EPWM_TBCTL_PHSDIR, TBCTL_PHSDIR_UP)));
  target_write16(epwm + EPWM_TBPHS_TBPHS, master ? 0u : EPWM_SYNC_DELAY_TICKS);
  target_write16(epwm + EPWM_TBPRD, HAL_PWM_PERIOD_TICKS - 1u);
  target_write16(epwm + EPWM_TBCTR, 0u);
}

static inline void write_compare(uint32_t epwm, uint16_t a, uint16_t b) {
  target_write16(epwm + EPWM_CMPA_CMPA, a);
  target_write16(epwm + EPWM_CMPB, b);
}

// Both the active values and the shadows: at the counter's start the active ones count, and they are 0 after reset,
// which would be an edge and a burst at once.
static void set_up_compare(uint16_t module) {
  const uint32_t epwm = EPWM_BASE(module);
  target_write16(epwm + EPWM_CMPCTL, REG_FIELD(EPWM_CMPCTL_SHDWAMODE, CMPCTL_IMMEDIATE) |
                                         REG_FIELD(EPWM_CMPCTL_SHDWBMODE, CMPCTL_IMMEDIATE));
  write_compare(epwm, HAL_PWM_NONE, HAL_PWM_NONE);
  target_write16(epwm + EPWM_CMPCTL, REG_FIELD(EPWM_CMPCTL_SHDWAMODE, CMPCTL_SHADOW) |
                                         REG_FIELD(EPWM_CMPCTL_SHDWBMODE, CMPCTL_SHADOW) |
                                         REG_FIELD(EPWM_CMPCTL_LOADAMODE, CMPCTL_LOAD_ZERO) |
                                         REG_FIELD(EPWM_CMPCTL_LOADBMODE, CMPCTL_LOAD_ZERO));
  write_compare(epwm, HAL_PWM_NONE, HAL_PWM_NONE);
}

static inline bool is_tripped(uint16_t module) { return reg_any(EPWM_BASE(module) + EPWM_TZFLG, EPWM_TZFLG_OST_MASK); }

// Written out, with addresses that are constants.
TARGET_RAM_CODE static bool is_any_leg_tripped(void) {
  return is_tripped(PWM_FIRST_LEG_MODULE) || is_tripped(PWM_FIRST_LEG_MODULE + 1u) ||
         is_tripped(PWM_FIRST_LEG_MODULE + 2u);
}

static bool dead_band_is_valid(uint16_t ticks) {
  return ticks >= HAL_PWM_DEAD_BAND_MIN_TICKS && ticks <= HAL_PWM_DEAD_BAND_MAX_TICKS;
}

static void write_dead_band(uint32_t epwm, uint16_t ticks) {
  target_write16(epwm + EPWM_DBRED, ticks);
  target_write16(epwm + EPWM_DBFED, ticks);
}

static void set_up_leg(uint16_t module, uint16_t dead_band_ticks) {
  const uint32_t epwm = EPWM_BASE(module);
  // The clear at zero does nothing to a valid frame; it ends a pulse whose falling edge has been lost.
  target_write16(epwm + EPWM_AQCTLA, REG_FIELD(EPWM_AQCTLA_CAU, AQ_SET) | REG_FIELD(EPWM_AQCTLA_CBU, AQ_CLEAR) |
                                         REG_FIELD(EPWM_AQCTLA_ZRO, AQ_CLEAR));
  target_write16(epwm + EPWM_AQCTLB, 0u);
  write_dead_band(epwm, dead_band_ticks);
  target_write16(epwm + EPWM_DBCTL, REG_FIELD(EPWM_DBCTL_OUT_MODE, DBCTL_OUT_MODE_BOTH) |
                                        REG_FIELD(EPWM_DBCTL_POLSEL, POLARITY) |
                                        REG_FIELD(EPWM_DBCTL_IN_MODE, DBCTL_IN_MODE_A));
}

// A window's first burst starts at compare A, its last one at compare B.
#define BURST_EVENTS                                                               \
  ((uint16_t)(REG_FIELD(EPWM_ETSEL_SOCASEL, ET_CMPA_UP) | EPWM_ETSEL_SOCAEN_MASK | \
              REG_FIELD(EPWM_ETSEL_SOCBSEL, ET_CMPB_UP) | EPWM_ETSEL_SOCBEN_MASK))

static void set_up_window(uint16_t module) {
  const uint32_t epwm = EPWM_BASE(module);
  target_write16(epwm + EPWM_ETPS,
                 REG_FIELD(EPWM_ETPS_SOCAPRD, ET_EVERY_EVENT) | REG_FIELD(EPWM_ETPS_SOCBPRD, ET_EVERY_EVENT));
  target_write16(epwm + EPWM_ETSEL, BURST_EVENTS);
}

// Only what the interrupt comes from; counting its events is switched on by hal_irq_enable. Where the master starts a
// window's bursts as well, what set_up_window has chosen stays.
static void set_up_period_interrupt(void) {
  const uint32_t epwm = EPWM_BASE(PWM_MASTER_MODULE);
  target_write16(epwm + EPWM_ETPS, (uint16_t)(REG_FIELD(EPWM_ETPS_INTPRD, ET_NO_EVENT) | PWM_MASTER_BURSTS));
  target_write16(epwm + EPWM_ETSEL, (uint16_t)(REG_FIELD(EPWM_ETSEL_INTSEL, ET_ZERO) | EPWM_ETSEL_INTEN_MASK |
                                               (PWM_MASTER_BURSTS != 0u ? BURST_EVENTS : 0u)));
}

static void set_trip_action(void) {
  target_eallow();
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    target_write16(EPWM_BASE(PWM_FIRST_LEG_MODULE + leg) + EPWM_TZCTL,
                   REG_FIELD(EPWM_TZCTL_TZA, TRIP_LEVEL) | REG_FIELD(EPWM_TZCTL_TZB, TRIP_LEVEL));
  }
  target_edis();
}

static void connect_gate_pins(void) {
  for (uint16_t i = 0u; i < BOARD_GATE_PINS; i++) {
    gpio_give_to_peripheral((uint16_t)(BOARD_PIN_FIRST_GATE + i), GPIO_MUX_FIRST, 0u, false);
  }
}

bool hal_pwm_init(uint16_t dead_band_ticks) {
  if (!dead_band_is_valid(dead_band_ticks)) {
    return false;
  }
  set_time_base_clock(0u);
  set_trip_action();
  hal_pwm_gates_off();
  for (uint16_t module = 1u; module <= PWM_LAST_MODULE; module++) {
    set_up_time_base(module);
    set_up_compare(module);
  }
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    set_up_leg((uint16_t)(PWM_FIRST_LEG_MODULE + leg), dead_band_ticks);
  }
  for (uint16_t window = 0u; window < HAL_PWM_WINDOWS; window++) {
    set_up_window((uint16_t)(PWM_FIRST_WINDOW_MODULE + window));
  }
  set_up_period_interrupt();
  connect_gate_pins();
  set_time_base_clock(1u);
  return true;
}

static bool set_dead_band(uint16_t dead_band_ticks) {
  if (!dead_band_is_valid(dead_band_ticks) || !is_any_leg_tripped()) {
    return false;
  }
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    write_dead_band(EPWM_BASE(PWM_FIRST_LEG_MODULE + leg), dead_band_ticks);
  }
  return true;
}

bool hal_pwm_set_dead_band(uint16_t dead_band_ticks) {
  replay_output(REPLAY_DEAD_BAND, &dead_band_ticks, 1u);
  return replay_plays() ? replay_take() != 0u : replay_note(set_dead_band(dead_band_ticks) ? 1u : 0u) != 0u;
}

static inline uint16_t period_tick(void) { return target_read16(EPWM_BASE(PWM_MASTER_MODULE) + EPWM_TBCTR); }

uint16_t hal_pwm_period_tick(void) {
  replay_call();
  return replay_plays() ? replay_take() : replay_note(period_tick());
}

// False too when the next period has begun before its control interrupt could come: the counter then looks early. Such
// a period start waits in the event counter. It is read after the time, so that none slips in between.
static inline bool is_in_time(uint16_t deadline_tick) {
  const bool early = period_tick() <= deadline_tick;
  return early && !reg_any(EPWM_BASE(PWM_MASTER_MODULE) + EPWM_ETPS, EPWM_ETPS_INTCNT_MASK);
}

static inline void write_leg(const hal_pwm_frame_t* frame, uint16_t leg) {
  write_compare(EPWM_BASE(PWM_FIRST_LEG_MODULE + leg), frame->edge_tick[leg], frame->edge_tick[HAL_PWM_LEGS + leg]);
}

static inline void write_window(const hal_pwm_frame_t* frame, uint16_t window) {
  write_compare(EPWM_BASE(PWM_FIRST_WINDOW_MODULE + window), frame->burst_start_tick[window],
                frame->burst_end_tick[window]);
}

TARGET_RAM_CODE static bool write_registers(const hal_pwm_frame_t* frame, uint16_t deadline_tick) {
  // An interrupt between the look at the counter and the last write could carry the writes across the period start.
  const uint16_t state = irq_hold();
  const bool in_time = is_in_time(deadline_tick);
  if (in_time) {
    // Written out, with addresses that are constants.
    write_leg(frame, 0u);
    write_leg(frame, 1u);
    write_leg(frame, 2u);
    write_window(frame, 0u);
    write_window(frame, 1u);
    write_window(frame, 2u);
  }
  irq_release(state);
  return in_time;
}

static void tell_frame(const hal_pwm_frame_t* frame, uint16_t deadline_tick) {
  uint16_t words[2u * (HAL_PWM_LEGS + HAL_PWM_WINDOWS) + 1u];
  uint16_t n = 0u;
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    words[n++] = frame->edge_tick[leg];
    words[n++] = frame->edge_tick[HAL_PWM_LEGS + leg];
  }
  for (uint16_t window = 0u; window < HAL_PWM_WINDOWS; window++) {
    words[n++] = frame->burst_start_tick[window];
    words[n++] = frame->burst_end_tick[window];
  }
  words[n++] = deadline_tick;
  replay_output(REPLAY_FRAME, words, n);
}

bool hal_pwm_write(const hal_pwm_frame_t* frame, uint16_t deadline_tick) {
  if (replay_is_off()) {
    return write_registers(frame, deadline_tick);
  }
  tell_frame(frame, deadline_tick);
  replay_call();
  return replay_plays() ? replay_take() != 0u : replay_note(write_registers(frame, deadline_tick) ? 1u : 0u) != 0u;
}

static bool gates_on(void) {
  if (!gpio_read(BOARD_PIN_OVER_CURRENT)) {
    return false;  // clearing the latch now would switch the gates on for as long as it takes to trip again
  }
  target_eallow();
  target_write16(EPWM_BASE(PWM_TRIP_WITNESS_MODULE) + EPWM_TZCLR, EPWM_TZCLR_OST_MASK);
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    target_write16(EPWM_BASE(PWM_FIRST_LEG_MODULE + leg) + EPWM_TZCLR, EPWM_TZCLR_OST_MASK);
  }
  target_edis();
  return !is_any_leg_tripped();
}

bool hal_pwm_gates_on(void) {
  replay_output(REPLAY_GATES_ON, NULL, 0u);
  replay_call();
  return replay_plays() ? replay_take() != 0u : replay_note(gates_on() ? 1u : 0u) != 0u;
}

// Also while a recording is played: switching off is never wrong.
void hal_pwm_gates_off(void) {
  replay_output(REPLAY_GATES_OFF, NULL, 0u);
  replay_call();
  target_eallow();
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    target_write16(EPWM_BASE(PWM_FIRST_LEG_MODULE + leg) + EPWM_TZFRC, EPWM_TZFRC_OST_MASK);
  }
  target_edis();
}

TARGET_RAM_CODE bool hal_pwm_is_tripped(void) {
  if (replay_is_off()) return is_any_leg_tripped();
  replay_call();
  return replay_plays() ? replay_take() != 0u : replay_note(is_any_leg_tripped() ? 1u : 0u) != 0u;
}

TARGET_RAM_CODE bool hal_pwm_was_tripped_by_pin(void) {
  replay_call();
  if (replay_plays()) return replay_take() != 0u;
  return replay_note(is_tripped(PWM_TRIP_WITNESS_MODULE) ? 1u : 0u) != 0u;
}
