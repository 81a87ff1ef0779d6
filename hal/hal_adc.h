// The samples of one measuring window: two bursts of simultaneous samples of two phase currents, and the slow signals.
//
// The first burst of a window is four pairs (current a, current b); the last burst is three such pairs and one pair
// (DC link, auxiliary). hal_pwm_frame_t says when the bursts start; the window interrupt (hal_irq.h) comes when the
// last one is complete. Sums, not means, are handed over: the division is left to the user, who knows the scale.
//
// Codes are 12 bits, 0..4095. On silicon before revision C the second channel of a pair reads high by 1/256 of the
// first one's code (SPRZ171); what is handed over is without it. The first pair after power-up or a long pause may be
// wrong: run one window and discard it before measuring offsets.
//
// Times, from the trigger, in ticks of 10 ns at ADCCLK = 12.5 MHz (8 ticks): sampling starts after 2.5 ADCCLK, holds
// 1 ADCCLK later, and pairs follow each other every 3 ADCCLK.

#ifndef STILLSPIN_HAL_HAL_ADC_H
#define STILLSPIN_HAL_HAL_ADC_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HAL_ADC_START_SAMPLES 4u  // codes in start_a and start_b
#define HAL_ADC_END_SAMPLES 3u    // codes in end_a and end_b
#define HAL_ADC_FULL_SCALE 4096u  // codes of the input range
#define HAL_ADC_HOLD_TICKS 28u    // trigger to the first pair's hold: 3.5 ADCCLK
#define HAL_ADC_PAIR_TICKS 24u    // hold to hold within a burst: 3 ADCCLK

// Trigger to the mean instant of a burst's current samples: hold + (samples - 1) / 2 pairs.
#define HAL_ADC_START_DELAY_TICKS 64u
#define HAL_ADC_END_DELAY_TICKS 52u

// Trigger to the last result of a burst of four pairs: the fourth hold and 5 ADCCLK. The next burst may start from
// here.
#define HAL_ADC_BURST_TICKS 140u

// A window's last burst to the next window's first burst, at least: the burst, the interrupt (held off for as long as
// hal_pwm_write takes) and hal_adc_read_window. A first burst that comes too early is lost or spoils its window.
#define HAL_ADC_WINDOW_GAP_TICKS 500u

typedef struct {
  uint16_t start_a;  // sum of 4 codes of current a in the first burst
  uint16_t start_b;  // sum of 4 codes of current b in the first burst
  uint16_t end_a;    // sum of 3 codes of current a in the last burst
  uint16_t end_b;    // sum of 3 codes of current b in the last burst
  uint16_t link;     // one code of the DC link voltage, after the last burst's currents
  uint16_t aux;      // one code of the auxiliary input: third current or heat-sink temperature, as the board says
} hal_adc_window_t;

// Powers the converter up, which takes 5 ms, and arms both sequencers: begin, look until it is up, arm. Needs
// hal_clock_init and hal_time_init.
void hal_adc_power_up(void);
bool hal_adc_is_up(void);
void hal_adc_set_up(void);

// Which pair follows a window's last currents: DC link and auxiliary input, or with `speed` DC link and speed command
// (hal_board.h). Background level; the results of the next two periods may still be of the other pair.
void hal_adc_choose_slow(bool speed);

// Converts ground and reference (hal_board.h), before the interrupts come; behind hal_adc_set_up, whose setting it
// leaves. 0, 0 when the converter does not answer.
void hal_adc_measure_reference(uint16_t* ground, uint16_t* reference);

// For the window interrupt: takes the results, makes both sequencers ready for the next window and acknowledges the
// interrupt. Must be done before the next window's first burst starts.
void hal_adc_read_window(hal_adc_window_t* window);

#ifdef __cplusplus
}
#endif

#endif
