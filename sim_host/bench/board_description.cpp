// What the plant has from the board's file.

#include "hal/hal_board.h"
#include "sim_host/bench/setup.hpp"

namespace stillspin::bench {

Setup::Setup() {
  nominal.adc.current_range = BOARD_CURRENT_RANGE / 100.0;
  nominal.adc.voltage_range = BOARD_LINK_RANGE / 10.0;
  board.bootstrap = BOARD_BOOTSTRAP_TIME > 0;
}

}  // namespace stillspin::bench
