// Seeded Gaussian noise, the same bytes on every machine: xoshiro256** with a 128-layer ziggurat.
//
// Sources: D. Blackman and S. Vigna, "Scrambled linear pseudorandom number generators" (2021); G. Marsaglia and
// W. W. Tsang, "The ziggurat method for generating random variables" (2000). Layer index and abscissa use different
// bits of one draw, which removes the correlation of the original method.

#ifndef STILLSPIN_SIM_HOST_PLANT_NOISE_HPP
#define STILLSPIN_SIM_HOST_PLANT_NOISE_HPP

#include <array>
#include <cstdint>

namespace stillspin::plant {

class Noise {
 public:
  /// Streams of one seed are independent of each other.
  Noise(std::uint64_t seed, std::uint64_t stream);

  /// One draw from the normal distribution with mean 0 and deviation 1.
  double gaussian();

  std::uint64_t bits();

 private:
  double uniform();  // (0, 1]
  double tail(bool negative);

  std::array<std::uint64_t, 4> state_;
};

}  // namespace stillspin::plant

#endif
