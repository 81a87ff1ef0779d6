// One autosequencer of the ADC: where its pointer stands, and whether a trigger waits.
//
// The converter (adc.hpp) owns two and runs one at a time. `pointer` counts from the sequencer's own first CONV.

#ifndef STILLSPIN_SIM_HOST_CHIP_ADC_SEQUENCER_HPP
#define STILLSPIN_SIM_HOST_CHIP_ADC_SEQUENCER_HPP

namespace stillspin::chip {

struct AdcSequencer {
  int first = 0;            // its first CONV and its first RESULT register: 0 or 8
  int states = 8;           // CONVs it has: 8, or 16 when cascaded
  int pointer = 0;          // 0 .. states-1
  bool waiting = false;     // SOC_SEQn: a trigger has come and not been served
  bool end_toggle = false;  // EOS_BUFn

  int conv() const { return first + pointer; }
  int result(bool simultaneous) const { return first + (simultaneous ? 2 * pointer : pointer); }

  void advance(bool simultaneous) {
    const int limit = simultaneous ? states / 2 : states;
    pointer = pointer + 1 >= limit ? 0 : pointer + 1;
  }
};

}  // namespace stillspin::chip

#endif
