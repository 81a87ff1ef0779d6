#include "sim_host/plant/noise.hpp"

#include <cmath>

#include "sim_host/plant/portable_math.hpp"

namespace stillspin::plant {
namespace {

constexpr double kTailStart = 3.442619855899;       // of the 128-layer ziggurat
constexpr double kLayerArea = 9.91256303526217e-3;  // for the density exp(-x^2/2)

std::uint64_t split_mix(std::uint64_t& x) {
  x += 0x9e3779b97f4a7c15u;
  std::uint64_t z = x;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

Noise::Ziggurat::Ziggurat() {
  edge[0] = kLayerArea / exponential(-0.5 * kTailStart * kTailStart);
  edge[1] = kTailStart;
  for (int k = 2; k < kLayers; ++k) {
    const double below = edge[k - 1];
    edge[k] = std::sqrt(-2.0 * logarithm(kLayerArea / below + exponential(-0.5 * below * below)));
  }
  edge[kLayers] = 0.0;
  for (int k = 0; k <= kLayers; ++k) density[k] = exponential(-0.5 * edge[k] * edge[k]);
}

const Noise::Ziggurat& Noise::ziggurat() {
  static const Ziggurat table;
  return table;
}

Noise::Noise(std::uint64_t seed, std::uint64_t stream) {
  std::uint64_t other = stream + 1;
  std::uint64_t x = seed ^ split_mix(other);
  for (auto& word : state_) word = split_mix(x);
}

double Noise::uniform() { return (static_cast<double>(bits() >> 11) + 1.0) * 0x1p-53; }

double Noise::tail(bool negative) {
  double x, y;
  do {
    x = -logarithm(uniform()) / kTailStart;
    y = -logarithm(uniform());
  } while (y + y < x * x);
  return negative ? -(kTailStart + x) : kTailStart + x;
}

/// A draw beside the rectangle that lies within its layer: in the wedge under the curve, in the tail, or drawn again.
double Noise::outside(std::uint64_t draw) {
  const Ziggurat& z = *table_;
  const std::uint64_t layer = draw & (kLayers - 1);
  const double u = abscissa(draw);
  if (layer == 0) return tail(u < 0.0);
  const double x = u * z.edge[layer];
  const double height = z.density[layer] + uniform() * (z.density[layer + 1] - z.density[layer]);
  return height < exponential(-0.5 * x * x) ? x : gaussian();
}

}  // namespace stillspin::plant
