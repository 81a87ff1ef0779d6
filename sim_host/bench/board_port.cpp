#include "sim_host/bench/board_port.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <utility>

#include "firmware/link/record.h"

namespace stillspin::bench {
namespace {

constexpr int kPatienceMs = 1000;  // a step on a slow bus takes tens of milliseconds
constexpr int kTries = 5;
constexpr std::size_t kRead = 512;

std::int64_t now_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

// False when the time is over.
bool wait_for(int descriptor, short what, int ms) {
  pollfd p{descriptor, what, 0};
  const int n = ::poll(&p, 1, ms > 0 ? ms : 0);
  if (n < 0 && errno != EINTR) throw PortError(std::string("the port is lost: ") + std::strerror(errno));
  if (n > 0 && (p.revents & what) == 0) throw PortError("the port is lost: nobody is at its other end");
  return n > 0;
}

bool may_come_again(int error) { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

BoardPort::BoardPort(int descriptor, std::unique_ptr<Framing> framing)
    : descriptor_(descriptor), framing_(std::move(framing)) {}

void BoardPort::send(const Octets& request) {
  tag_++;
  type_ = request.front();
  Words record{type_, tag_};
  record.insert(record.end(), request.begin() + 1, request.end());
  wire_ = framing_->wrap(record);
  write(wire_);
}

Octets BoardPort::receive() {
  Octets answer;
  for (int k = 1; !wait_for_answer(kPatienceMs, answer); k++) {
    if (k == kTries) throw PortError("the board does not answer");
    write(wire_);
  }
  return answer;
}

void BoardPort::write(const Octets& octets) const {
  std::size_t sent = 0;
  while (sent < octets.size()) {
    const ssize_t n = ::write(descriptor_, octets.data() + sent, octets.size() - sent);
    if (n >= 0) {
      sent += static_cast<std::size_t>(n);
    } else if (!may_come_again(errno)) {
      throw PortError(std::string("the port is lost: ") + std::strerror(errno));
    } else if (!wait_for(descriptor_, POLLOUT, kPatienceMs)) {
      throw PortError("the port accepts no data: is anything connected to it?");
    }
  }
}

bool BoardPort::wait_for_answer(int patience_ms, Octets& answer) {
  const std::int64_t end = now_ms() + patience_ms;
  while (!look(answer)) {
    if (wait_for(descriptor_, POLLIN, static_cast<int>(end - now_ms()))) {
      read();
    } else if (now_ms() >= end) {
      return false;
    }
  }
  return true;
}

void BoardPort::read() {
  heard_.resize(kRead);
  at_ = 0;
  const ssize_t n = ::read(descriptor_, heard_.data(), kRead);
  if (n == 0 || (n < 0 && !may_come_again(errno))) throw PortError("the port is lost: it has been closed");
  heard_.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
}

// Looks for the answer in what has been heard; other records, of an earlier question or unasked, are passed over.
bool BoardPort::look(Octets& answer) {
  while (at_ < heard_.size()) {
    if (!framing_->take(heard_[at_++])) continue;
    const Words record = framing_->record();
    if (record.size() < 3 || record[0] != (type_ | RECORD_ANSWER) || record[1] != tag_) continue;
    answer.assign(record.begin() + 2, record.end());
    return true;
  }
  return false;
}

}  // namespace stillspin::bench
