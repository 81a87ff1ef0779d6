// The host's side of the loop: tells a period as a step against the one before, and reads what is answered.

#ifndef STILLSPIN_TESTS_FIRMWARE_HIL_HOST_HPP
#define STILLSPIN_TESTS_FIRMWARE_HIL_HOST_HPP

#include <algorithm>
#include <vector>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/api/status.h"
#include "firmware/hil/delta.h"
#include "firmware/hil/hil.h"
}

namespace stillspin::test {

/// From now on the board's pulses and windows are played while a recording is played, as the drivers do it.
inline void let_recordings_play() {
  board.plays_frame = [](const hal_pwm_frame_t& frame, bool* in_time) {
    replay_output(REPLAY_FRAME, frame.edge_tick, HAL_PWM_LEGS);
    replay_call();
    if (replay_plays()) *in_time = replay_take() != 0;
    return replay_plays();
  };
  board.plays_window = [](hal_adc_window_t* window) {
    std::uint16_t results[REPLAY_RESULTS];
    if (!replay_plays()) return false;
    replay_take_results(results, REPLAY_RESULTS);
    *window = {results[0], results[1], results[2], results[3], results[4], results[5]};
    return true;
  };
}

/// What a step brings.
struct HilPeriod {
  using Words = std::vector<std::uint16_t>;
  std::vector<replay_window_t> windows;
  Words inputs, works;
  std::uint16_t results = REPLAY_RESULTS;  // words of a window that are told
};

struct HilAnswer {
  std::uint16_t sequence = 0, torn = 0;
  std::vector<std::uint16_t> outputs;
  std::uint32_t crc = 0;
  bool fits = false;  // all of it was read, and there was no more
};

class HilHost {
 public:
  using Octets = std::vector<std::uint16_t>;

  Octets step(const HilPeriod& p) {
    Octets octets(1000);
    octet_writer_t w = octet_writer(octets.data(), static_cast<std::uint16_t>(octets.size()));
    put_u16(&w, sequence_++);
    put(&w, {size(p.windows), p.results, size(p.inputs), size(p.works)}, shape_);
    put(&w, p.works, works_);
    put(&w, p.inputs, inputs_);
    for (std::size_t k = 0; k < p.windows.size(); ++k) {
      Octets words = {p.windows[k].call};
      words.insert(words.end(), p.windows[k].results, p.windows[k].results + p.results);
      put(&w, words, windows_[k]);
    }
    octets.resize(w.count);
    return octets;
  }

  HilAnswer read(const Octets& octets) {
    HilAnswer a;
    octet_reader_t r = octet_reader(octets.data(), size(octets));
    a.sequence = take_u16(&r);
    delta_take(&r, before_.shape, before_.shape, HIL_ANSWER_SHAPE);
    a.torn = before_.shape[0];
    const std::uint16_t count = std::min<std::uint16_t>(before_.shape[1], REPLAY_OUTPUTS);
    delta_take(&r, before_.outputs, before_.outputs, count);
    a.outputs.assign(before_.outputs, before_.outputs + count);
    a.crc = take_u32(&r);
    a.fits = octets_fit(&r);
    return a;
  }

 private:
  template <typename List>
  static std::uint16_t size(const List& list) {
    return static_cast<std::uint16_t>(list.size());
  }
  static void put(octet_writer_t* w, const Octets& words, std::uint16_t* before) {
    delta_put(w, words.data(), before, size(words));
    std::copy(words.begin(), words.end(), before);
  }

  std::uint16_t sequence_ = 0;
  std::uint16_t shape_[HIL_STEP_SHAPE] = {}, works_[REPLAY_WORKS] = {}, inputs_[REPLAY_INPUTS] = {};
  std::uint16_t windows_[REPLAY_WINDOWS][HIL_WINDOW_WORDS] = {};
  hil_answer_t before_ = {};
};

}  // namespace stillspin::test

#endif
