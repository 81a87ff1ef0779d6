// The bench's oscilloscope: gate signals, current samples and true waveforms over a stretch of a run.
//
// The record of a run has one row a period; what happens inside a period is seen here: every edge at the gate pins, the
// instants at which the ADC held the phase currents, and the true currents and leg voltages on an even raster. Looking
// does not change the plant's course.

#ifndef STILLSPIN_SIM_HOST_BENCH_WAVEFORM_HPP
#define STILLSPIN_SIM_HOST_BENCH_WAVEFORM_HPP

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/plant/plant.hpp"

namespace stillspin::bench {

using plant::Tick;

/// Which stretch of the run is looked at; nothing while end <= begin.
struct WaveformRequest {
  double begin = 0.0;  // s after the end of the start procedure, rounded to a period start
  double end = 0.0;
  int raster = 100;  // ticks of 10 ns between two looks at the currents
};

/// Named columns; those of one table are equally long. Tables: "raster", "edges", "samples".
using WaveformTable = std::vector<std::pair<std::string, std::vector<double>>>;
using Waveform = std::vector<std::pair<std::string, WaveformTable>>;

class WaveformProbe {
 public:
  /// Looks from the tick `begin` on up to `end`; times are counted from `origin`.
  void arm(Tick origin, Tick begin, Tick end, Tick raster);

  /// When it wants to look next.
  Tick next() const { return next_; }

  /// Looks at the plant and at the level of the six gate pins.
  void look(Tick t, plant::Plant& plant, const std::array<bool, 3>& upper, const std::array<bool, 3>& lower);

  void edge(Tick t, int leg, bool upper, bool lower) {
    if (sees(t)) keep_edge(t, leg, upper, lower);
  }
  void sample(Tick t) {
    if (sees(t)) samples_.push_back(seconds(t));
  }

  Waveform take();

 private:
  bool sees(Tick t) const { return t >= begin_ && t < end_; }
  void keep_edge(Tick t, int leg, bool upper, bool lower);
  double seconds(Tick t) const { return static_cast<double>(t - origin_) * 1e-8; }

  Tick origin_ = 0;
  Tick begin_ = 0;
  Tick end_ = 0;
  Tick raster_ = 100;
  Tick next_ = std::numeric_limits<Tick>::max();
  std::array<std::vector<double>, 8> raster_columns_;  // time, i_a, i_b, i_c, angle, v_a, v_b, v_c
  std::array<std::vector<double>, 4> edges_;           // time, leg, upper, lower
  std::vector<double> samples_;
};

}  // namespace stillspin::bench

#endif
