// Records to and from a board over an open port of this computer: a serial port, or an SLCAN adapter on a CAN bus.
//
// The port is somebody else's, opened, set up and given back by them; while a BoardPort has it nobody else may read it.
// It stands in a loop that is closed through the board, where every microsecond of a question counts: this is what the
// Python client does (stillspin.drive.requester), without threads and queues.

#ifndef STILLSPIN_SIM_HOST_BENCH_BOARD_PORT_HPP
#define STILLSPIN_SIM_HOST_BENCH_BOARD_PORT_HPP

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "sim_host/bench/step_loop.hpp"

namespace stillspin::bench {

/// The board gave no answer, or the port is lost.
class PortError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How records become octets of the port, and back.
class Framing {
 public:
  virtual ~Framing() = default;
  /// A record without its CRC, as it goes out.
  virtual Octets wrap(const Words& record) = 0;
  /// Takes an octet; true when it completes record().
  virtual bool take(std::uint8_t octet) = 0;
  /// The record that was completed, without its CRC.
  virtual Words record() const = 0;
};

/// Between zeros (firmware/link/record.h).
std::unique_ptr<Framing> serial_framing();
/// In pieces (firmware/can/segments.h) to a node 1..31, each a frame of the adapter's ASCII protocol.
std::unique_ptr<Framing> slcan_framing(unsigned node);

class BoardPort final : public Way {
 public:
  BoardPort(int descriptor, std::unique_ptr<Framing> framing);

  /// See Way. A request whose answer does not come is repeated. Throw PortError.
  void send(const Octets& request) override;
  Octets receive() override;

 private:
  void write(const Octets& octets) const;
  bool wait_for_answer(int patience_ms, Octets& answer);
  void read();
  bool look(Octets& answer);

  int descriptor_;
  std::unique_ptr<Framing> framing_;
  std::uint8_t type_ = 0;  // of the request
  Octets wire_;            // as it went out
  std::vector<std::uint8_t> heard_;
  std::size_t at_ = 0;
  std::uint8_t tag_ = 0;
};

}  // namespace stillspin::bench

#endif
