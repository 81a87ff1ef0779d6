// What hangs on a virtual board beside chip and motor, and what somebody does to its inputs.

#ifndef STILLSPIN_SIM_HOST_BENCH_BOARD_OPTIONS_HPP
#define STILLSPIN_SIM_HOST_BENCH_BOARD_OPTIONS_HPP

#include <array>

namespace stillspin::bench {

struct BoardOptions {
  bool bootstrap = false;           // upper drivers have bootstrap supplies
  double precharge_resistance = 0;  // ohm, until the relay bridges it; 0: no relay, the link hangs on its source
  bool brake = false;               // the drive's output switches the brake resistor (link.brake_resistance)
  bool enable_stuck = false;        // the gate enable passes the gates for ever
  std::array<int, 2> input{0, 1};   // whose sensor is on the converter's inputs a and b
  int crossed = 0;                  // 1..3: the motor's wires of the two other phases than a, b, c are crossed
};

/// What somebody at the board does to its inputs.
struct BoardInputs {
  bool emergency = false;      // pressed
  bool run = false;            // switch closed
  double speed_volts = 0.0;    // V at the speed command's input
  double heat_sink = -300.0;   // degrees C; below absolute zero: the plant's temperature_code
  double reference_codes = 0;  // error of the converter's reference input
};

}  // namespace stillspin::bench

#endif
