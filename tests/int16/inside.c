// Compiled with the drive's 16-bit int: what the native side needs of structures that are laid out otherwise there.

#include "firmware/commissioning/outcome.h"
#include "firmware/mode/mode.h"

uint16_t samples_out(int32_t* flat);
void commissioning_out(uint16_t index, int32_t* flat);

// Windows of the last period, eight numbers each change, current, voltage and the rest; returns how many.
uint16_t samples_out(int32_t* flat) {
  for (uint16_t k = 0; k < ESTIMATOR_WINDOWS; k++) {
    const estimator_window_t* const w = &drive.samples.windows[k];
    *flat++ = w->change_q19.alpha;
    *flat++ = w->change_q19.beta;
    *flat++ = w->current_q20.alpha;
    *flat++ = w->current_q20.beta;
    *flat++ = w->voltage_q19.alpha;
    *flat++ = w->voltage_q19.beta;
    *flat++ = w->middle_tick;
    *flat++ = w->span_ticks;
  }
  return drive.samples.count;
}

void commissioning_out(uint16_t index, int32_t* flat) {
  const commissioning_result_t* const r = drive_commissioning_result(index);
  flat[0] = (int32_t)r->id;
  flat[1] = r->before;
  flat[2] = r->value;
  flat[3] = (int32_t)r->verdict;
}
