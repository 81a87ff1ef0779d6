#include "sim_host/bench/waveform.hpp"

namespace stillspin::bench {

void WaveformProbe::arm(Tick origin, Tick begin, Tick end, Tick raster) {
  if (end <= begin) return;
  origin_ = origin;
  begin_ = begin;
  end_ = end;
  raster_ = raster;
  next_ = begin;
}

void WaveformProbe::look(Tick t, plant::Plant& plant, const std::array<bool, 3>& upper,
                         const std::array<bool, 3>& lower) {
  plant.advance(t);
  const plant::PlantState s = plant.state();
  if (t == begin_) {
    for (int leg = 0; leg < 3; leg++) edge(t, leg, upper[leg], lower[leg]);
  }
  const double row[] = {seconds(t), s.current[0],     s.current[1],     s.current[2],
                        s.angle_e,  s.leg_voltage[0], s.leg_voltage[1], s.leg_voltage[2]};
  for (std::size_t k = 0; k < raster_columns_.size(); k++) raster_columns_[k].push_back(row[k]);
  next_ = t + raster_ < end_ ? t + raster_ : std::numeric_limits<Tick>::max();
}

void WaveformProbe::keep_edge(Tick t, int leg, bool upper, bool lower) {
  const double row[] = {seconds(t), static_cast<double>(leg), upper ? 1.0 : 0.0, lower ? 1.0 : 0.0};
  for (std::size_t k = 0; k < edges_.size(); k++) edges_[k].push_back(row[k]);
}

Waveform WaveformProbe::take() {
  const char* const raster_names[] = {"time", "i_a", "i_b", "i_c", "angle", "v_a", "v_b", "v_c"};
  const char* const edge_names[] = {"time", "leg", "upper", "lower"};
  WaveformTable raster;
  WaveformTable edges;
  for (std::size_t k = 0; k < raster_columns_.size(); k++)
    raster.emplace_back(raster_names[k], std::move(raster_columns_[k]));
  for (std::size_t k = 0; k < edges_.size(); k++) edges.emplace_back(edge_names[k], std::move(edges_[k]));
  return {{"raster", std::move(raster)}, {"edges", std::move(edges)}, {"samples", {{"time", std::move(samples_)}}}};
}

}  // namespace stillspin::bench
