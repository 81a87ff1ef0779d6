#include "sim_host/bench/loop_plugs.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <utility>

#include "sim_host/bench/slcan_line.hpp"

namespace stillspin::bench {
namespace {

constexpr int kWaitMs = 20;
constexpr Tick kAnswer = 1'000'000;      // that a board may think before the plugs are looked at again
constexpr std::size_t kAtOnce = 256;     // octets of the serial port, which the drive's ring holds
constexpr std::size_t kCanAtOnce = 512;  // octets of the adapter: some twenty frames
constexpr std::size_t kQueue = 32;       // frames that may wait for the bus

using Clock = std::chrono::steady_clock;

}  // namespace

LoopPlugs::Served LoopPlugs::serve(int milliseconds) {
  const auto end = Clock::now() + std::chrono::milliseconds(milliseconds);
  while (!ended_ && Clock::now() < end && VirtualBoard::in_loop()) {
    if (!wait()) break;
    if (serial_ready_) hear_serial();
    if (can_ready_ && board_.can_host().waiting() < kQueue) hear_can();
    (void)board_.advance_until_heard(kAnswer);
    say();
  }
  if (!line_.empty()) {
    served_.for_adapter.insert(served_.for_adapter.begin(), line_.begin(), line_.end());
  }
  return std::exchange(served_, {});
}

// Something was handed over that the drive has not got yet.
bool LoopPlugs::is_on_its_way() {
  return board_.serial().sent_until(board_.now()) > board_.now() || board_.can_host().waiting() > 0;
}

// Until a program has sent something, or for a while; false when one of them has gone.
bool LoopPlugs::wait() {
  pollfd plugs[] = {{serial_, POLLIN, 0}, {can_, POLLIN, 0}};
  if (::poll(plugs, 2, is_on_its_way() ? 0 : kWaitMs) < 0) return errno == EINTR;
  serial_ready_ = (plugs[0].revents & POLLIN) != 0;
  can_ready_ = (plugs[1].revents & POLLIN) != 0;
  return ((plugs[0].revents | plugs[1].revents) & ~POLLIN) == 0;
}

// What is there; nothing ends it.
LoopPlugs::Octets LoopPlugs::read(int descriptor) {
  Octets octets(descriptor == can_ ? kCanAtOnce : kAtOnce);
  const ssize_t n = ::read(descriptor, octets.data(), octets.size());
  octets.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  if (octets.empty()) ended_ = true;
  return octets;
}

void LoopPlugs::hear_serial() {
  const Octets octets = read(serial_);
  served_.serial_in += octets.size();
  board_.serial().send(octets, board_.now());
}

void LoopPlugs::hear_can() {
  for (const std::uint8_t octet : read(can_)) {
    if (ended_) {
      served_.for_adapter.push_back(octet);
    } else if (octet == '\r') {
      take_line(std::exchange(line_, {}));
    } else {
      line_.push_back(static_cast<char>(octet));
    }
  }
}

// A plain frame is sent and acknowledged; all else is the adapter's own business, with what comes behind it.
void LoopPlugs::take_line(const std::string& line) {
  std::string_view rest;
  const auto frame = slcan_frame(line, rest);
  if (frame && rest.empty()) {
    board_.can_host().send(*frame, board_.now());
    to_can_.insert(to_can_.end(), {'z', '\r'});
    return;
  }
  ended_ = true;
  served_.for_adapter.assign(line.begin(), line.end());
  served_.for_adapter.push_back('\r');
}

void LoopPlugs::say() {
  const Octets octets = board_.serial().take();
  served_.serial_out += octets.size();
  write(serial_, octets, served_.serial_left);
  for (const auto& heard : board_.can_host().take_heard(board_.now())) put_slcan_line(to_can_, heard.frame);
  write(can_, std::exchange(to_can_, {}), served_.can_left);
}

// What nobody listens to is lost.
void LoopPlugs::write(int descriptor, const Octets& octets, Octets& left) {
  if (octets.empty() || descriptor < 0) return;
  const ssize_t n = ::write(descriptor, octets.data(), octets.size());
  const auto written = n > 0 ? static_cast<std::size_t>(n) : 0;
  if (written == octets.size()) return;
  left.assign(octets.begin() + static_cast<std::ptrdiff_t>(written), octets.end());
  ended_ = true;
}

}  // namespace stillspin::bench
