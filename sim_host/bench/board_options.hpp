// What hangs on a virtual board beside chip and motor, and what somebody does to its inputs.

#ifndef STILLSPIN_SIM_HOST_BENCH_BOARD_OPTIONS_HPP
#define STILLSPIN_SIM_HOST_BENCH_BOARD_OPTIONS_HPP

namespace stillspin::bench {

struct BoardOptions {
  bool bootstrap = false;           // upper drivers have bootstrap supplies
  double precharge_resistance = 0;  // ohm, until the relay bridges it; 0: no relay, the link hangs on its source
  bool brake = false;               // the drive's output switches the brake resistor (link.brake_resistance)
  bool enable_stuck = false;        // the gate enable passes the gates for ever
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
