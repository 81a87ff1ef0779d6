// The plugs of a virtual board in the loop while its time is nobody's: what a program has sent is handed over, time
// passes until the drive has answered, and the answer goes back. Nothing else happens between two steps, and all of it
// happens here: this is what the desk does for every board (stillspin.board.desk), without a look at anything else.

#ifndef STILLSPIN_SIM_HOST_BENCH_LOOP_PLUGS_HPP
#define STILLSPIN_SIM_HOST_BENCH_LOOP_PLUGS_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim_host/bench/virtual_board.hpp"

namespace stillspin::bench {

class LoopPlugs {
 public:
  using Octets = std::vector<std::uint8_t>;

  /// What has come of it.
  struct Served {
    std::size_t serial_in = 0, serial_out = 0;  // octets
    Octets for_adapter;                         // from the program at the adapter: begins with what is no plain frame
    Octets serial_left, can_left;               // for the programs, which did not take them
  };

  /// serial, can: descriptors that do not block, -1 for one that nobody has open. At the adapter's every line must be a
  /// command's beginning, its channel open and without time stamps.
  LoopPlugs(VirtualBoard& board, int serial, int can) : board_(board), serial_(serial), can_(can) {}

  /// For so many milliseconds, or until the board is not in the loop any more, or something else has to be looked at.
  Served serve(int milliseconds);

 private:
  bool is_on_its_way();
  bool wait();
  Octets read(int descriptor);
  void hear_serial();
  void hear_can();
  void take_line(const std::string& line);
  void say();
  void write(int descriptor, const Octets& octets, Octets& left);

  VirtualBoard& board_;
  int serial_, can_;
  bool serial_ready_ = false, can_ready_ = false;
  bool ended_ = false;
  std::string line_;  // of the adapter, not complete
  Octets to_can_;
  Served served_;
};

}  // namespace stillspin::bench

#endif
