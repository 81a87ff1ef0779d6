#include "sim_host/plant/sensors.hpp"

#include <cmath>

namespace stillspin::plant {
Sensors::Sensors(const PlantConfig& c, const AlphaBeta& initial)
    : config_(c.sensor),
      tau_(c.sensor.bandwidth > 0.0 ? 1.0 / (2.0 * kPi * c.sensor.bandwidth) : 0.0),
      inverse_tau_(2.0 * kPi * c.sensor.bandwidth),
      ring_scale_(1.5 * c.sensor.ring_amplitude / c.link.source_voltage),
      ring_end_(static_cast<Tick>(kForgotten * c.sensor.ring_decay / kSecondsPerTick)),
      filtered_(initial) {
  repair();
  const double coarse = kFine * kSecondsPerTick;
  for (unsigned n = 0; n < kFine; ++n) fine_[n] = decay(n * kSecondsPerTick);
  for (unsigned n = 0; n < kCoarse; ++n) coarse_[n] = decay(n * kFine * kSecondsPerTick);
  for (unsigned n = 0; n < kFine; ++n) fine_filter_[n] = exponential(-(n * kSecondsPerTick) * inverse_tau_);
  for (unsigned n = 0; n < kCoarse; ++n) {
    coarse_filter_[n] = n == 0 ? 1.0 : coarse_filter_[n - 1] * exponential(-coarse * inverse_tau_);
  }
}

double Sensors::forgetting_between(double seconds) const {
  const double scaled = seconds * inverse_tau_;
  return scaled > kForgotten ? 0.0 : exponential(-scaled);
}

Sensors::Phasor Sensors::decay(double seconds) const {
  const double size = exponential(-seconds / config_.ring_decay);
  const Rotation turn = rotation(2.0 * kPi * config_.ring_frequency * seconds);
  return {size * turn.c, size * turn.s};
}

/// Over at most ring_end_.
Sensors::Phasor Sensors::decay(Tick ticks) const {
  const auto n = static_cast<std::size_t>(ticks);
  if (n < kFine) return fine_[n];
  if (n < kFine * kCoarse) return product(coarse_[n / kFine], fine_[n % kFine]);
  return decay(static_cast<double>(ticks) * kSecondsPerTick);
}

void Sensors::excite(Tick t, double fraction, const std::array<double, 3>& step) {
  if (ring_scale_ == 0.0) return;
  // Phasors live on whole ticks: an edge inside a tick is booked on the next one, already that much older.
  const Tick tick = fraction > 0.0 ? t + 1 : t;
  if (tick - ring_tick_ <= ring_end_) {
    const Phasor factor = decay(tick - ring_tick_);
    ring_alpha_ = product(ring_alpha_, factor);
    ring_beta_ = product(ring_beta_, factor);
  } else {
    ring_alpha_ = ring_beta_ = Phasor{};
  }
  ring_tick_ = tick;
  const Phasor born = fraction > 0.0 ? decay(kSecondsPerTick - fraction) : Phasor{1.0, 0.0};
  const double alpha = ring_scale_ * (2.0 * step[0] - step[1] - step[2]) * (1.0 / 3.0);
  const double beta = ring_scale_ * (step[1] - step[2]) * (1.0 / kSqrt3);
  ring_alpha_.re += alpha * born.re;
  ring_alpha_.im += alpha * born.im;
  ring_beta_.re += beta * born.re;
  ring_beta_.im += beta * born.im;
}

AlphaBeta Sensors::ringing(Tick t) const {
  if (ring_scale_ == 0.0 || t - ring_tick_ > ring_end_) return {};
  const Phasor factor = decay(t - ring_tick_);
  return {product(ring_alpha_, factor).im, product(ring_beta_, factor).im};
}

double Sensors::failing(int phase, Tick t, double current) const {
  const Output& o = outputs_[phase];
  if (o.stuck) return o.stuck_at;
  double reading = o.gain * current + o.offset;
  if (o.drift != 0.0) reading += o.drift * static_cast<double>(t - o.drift_from) * kSecondsPerTick;
  return reading;
}

void Sensors::stick(int phase, double value) {
  outputs_[phase].faulty = outputs_[phase].stuck = true;
  outputs_[phase].stuck_at = value;
}

void Sensors::drift(int phase, Tick from, double per_second) {
  outputs_[phase].faulty = true;
  outputs_[phase].drift = per_second;
  outputs_[phase].drift_from = from;
}

void Sensors::scale(int phase, double factor) { outputs_[phase].gain *= factor; }

void Sensors::repair() {
  for (int k = 0; k < 3; ++k) outputs_[k] = Output{config_.gain[k], config_.offset[k]};
}

}  // namespace stillspin::plant
