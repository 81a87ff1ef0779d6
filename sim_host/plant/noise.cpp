#include "sim_host/plant/noise.hpp"

#include <cmath>

#include "sim_host/plant/portable_math.hpp"

namespace stillspin::plant {
namespace {

constexpr int kLayers = 128;
constexpr double kTailStart = 3.442619855899;       // of the 128-layer ziggurat
constexpr double kLayerArea = 9.91256303526217e-3;  // for the density exp(-x^2/2)

struct Ziggurat {
  std::array<double, kLayers + 1> edge;     // layer k spans |x| < edge[k]; edge[0] is that of the base rectangle
  std::array<double, kLayers + 1> density;  // exp(-edge^2/2)

  Ziggurat() {
    edge[0] = kLayerArea / exponential(-0.5 * kTailStart * kTailStart);
    edge[1] = kTailStart;
    for (int k = 2; k < kLayers; ++k) {
      const double below = edge[k - 1];
      edge[k] = std::sqrt(-2.0 * logarithm(kLayerArea / below + exponential(-0.5 * below * below)));
    }
    edge[kLayers] = 0.0;
    for (int k = 0; k <= kLayers; ++k) density[k] = exponential(-0.5 * edge[k] * edge[k]);
  }
};

const Ziggurat& ziggurat() {
  static const Ziggurat table;
  return table;
}

std::uint64_t rotated(std::uint64_t x, int by) { return (x << by) | (x >> (64 - by)); }

std::uint64_t split_mix(std::uint64_t& x) {
  x += 0x9e3779b97f4a7c15u;
  std::uint64_t z = x;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

Noise::Noise(std::uint64_t seed, std::uint64_t stream) {
  std::uint64_t other = stream + 1;
  std::uint64_t x = seed ^ split_mix(other);
  for (auto& word : state_) word = split_mix(x);
}

std::uint64_t Noise::bits() {
  const std::uint64_t result = rotated(state_[1] * 5, 7) * 9;
  const std::uint64_t shifted = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= shifted;
  state_[3] = rotated(state_[3], 45);
  return result;
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

double Noise::gaussian() {
  const Ziggurat& z = ziggurat();
  for (;;) {
    const std::uint64_t draw = bits();
    const int layer = static_cast<int>(draw & (kLayers - 1));
    const double u = static_cast<double>(static_cast<std::int64_t>(draw) >> 11) * 0x1p-52;  // [-1, 1)
    const double x = u * z.edge[layer];
    if (std::fabs(x) < z.edge[layer + 1]) return x;
    if (layer == 0) return tail(u < 0.0);
    const double height = z.density[layer] + uniform() * (z.density[layer + 1] - z.density[layer]);
    if (height < exponential(-0.5 * x * x)) return x;
  }
}

}  // namespace stillspin::plant
