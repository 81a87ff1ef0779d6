#include "tests/fuzz/fuzz_board.hpp"

#include "tests/firmware/fake_hal.hpp"
#include "tests/firmware/fake_nvm.hpp"
#include "tests/fuzz/fuzz_drive.h"

using namespace stillspin::test;

extern "C" {

void fuzz_board_power_on(void) {
  board = FakeBoard{};
  nvm = FakeNvm{};
}

void fuzz_board_still_window(void) { board.adc.push_back(still_window()); }
void fuzz_board_gates(bool on) { board.gates_on = on; }

void fuzz_board_serial_errors(std::uint16_t* flat) {
  const hal_sci_errors_t e = hal_sci_errors();
  for (const std::uint16_t count : {e.framing, e.overrun, e.breaks, e.lost}) *flat++ = count;
}

void fuzz_board_can_status(std::uint16_t* flat) {
  const hal_can_status_t s = hal_can_status();
  *flat++ = static_cast<std::uint16_t>(s.state);
  for (const std::uint16_t count : {s.transmit_errors, s.receive_errors, s.lost, s.bus_offs, s.restarts}) {
    *flat++ = count;
  }
}

}  // extern "C"

namespace stillspin::test {

std::string fuzz_complaint_of_parameters() {
  static const char* const names[] = {
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) #name,
#include "firmware/dictionary/all_parameters.h"
#undef PARAMETER
  };
  const std::uint16_t place = fuzz_parameter_out_of_range();
  return place == 0 ? "" : std::string(names[place - 1]) + " is out of its range";
}

}  // namespace stillspin::test
