// Seeded Gaussian noise, the same bytes on every machine: xoshiro256** with a 128-layer ziggurat.
//
// Sources: D. Blackman and S. Vigna, "Scrambled linear pseudorandom number generators" (2021); G. Marsaglia and
// W. W. Tsang, "The ziggurat method for generating random variables" (2000). Layer index and abscissa use different
// bits of one draw, which removes the correlation of the original method.

#ifndef STILLSPIN_SIM_HOST_PLANT_NOISE_HPP
#define STILLSPIN_SIM_HOST_PLANT_NOISE_HPP

#include <array>
#include <cmath>
#include <cstdint>

namespace stillspin::plant {

class Noise {
 public:
  /// Streams of one seed are independent of each other.
  Noise(std::uint64_t seed, std::uint64_t stream);

  /// One draw from the normal distribution with mean 0 and deviation 1.
  double gaussian() {
    const std::uint64_t draw = bits();
    const std::uint64_t layer = draw & (kLayers - 1);
    const double x = abscissa(draw) * table_->edge[layer];
    return std::fabs(x) < table_->edge[layer + 1] ? x : outside(draw);  // 99 of 100 draws lie inside
  }

  std::uint64_t bits() {
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

 private:
  static constexpr int kLayers = 128;

  struct Ziggurat {
    std::array<double, kLayers + 1> edge;     // layer k spans |x| < edge[k]; edge[0] is that of the base rectangle
    std::array<double, kLayers + 1> density;  // exp(-edge^2/2)

    Ziggurat();
  };
  static const Ziggurat& ziggurat();

  static std::uint64_t rotated(std::uint64_t x, int by) { return (x << by) | (x >> (64 - by)); }
  static double abscissa(std::uint64_t draw) {  // [-1, 1)
    return static_cast<double>(static_cast<std::int64_t>(draw) >> 11) * 0x1p-52;
  }
  double outside(std::uint64_t draw);
  double uniform();  // (0, 1]
  double tail(bool negative);

  const Ziggurat* table_ = &ziggurat();
  std::array<std::uint64_t, 4> state_;
};

}  // namespace stillspin::plant

#endif
