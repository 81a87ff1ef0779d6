// A serial line as a list of edges, and a port on it: what the tests of the SCI share.

#ifndef STILLSPIN_TESTS_CHIP_SCI_HPP
#define STILLSPIN_TESTS_CHIP_SCI_HPP

#include <gtest/gtest.h>

#include <vector>

#include "hal/f2808/registers.h"
#include "sim_host/chip/sci.hpp"
#include "tests/chip/peripheral.hpp"

namespace stillspin::chip::testing {

/// High until the first edge, then alternating. The tests write it down before the port runs.
class EdgeLine {
 public:
  std::vector<Tick> edges;

  void low_between(Tick from, Tick to) {
    if (!edges.empty() && edges.back() == from) {
      edges.back() = to;
    } else {
      edges.push_back(from);
      edges.push_back(to);
    }
  }

  /// An 8N1 frame; returns its end.
  Tick frame(unsigned octet, Tick t, Tick bit) { return bits(octet << 1 | 1u << 9, 10, t, bit); }

  Tick bits(unsigned levels, unsigned count, Tick t, Tick bit) {
    for (unsigned k = 0; k < count; ++k, t += bit) {
      if ((levels >> k & 1u) == 0) low_between(t, t + bit);
    }
    return t;
  }

  Tick reaches(Tick t, bool level) {
    EXPECT_GE(t, asked_) << "the line is never asked backwards";
    asked_ = t;
    bool now = true;
    std::size_t k = 0;
    for (; k < edges.size() && edges[k] <= t; ++k) now = !now;
    if (now == level) return t;
    return k < edges.size() ? edges[k] : kNever;
  }

 private:
  Tick asked_ = 0;
};

inline constexpr Tick kSerialBit = 800;  // ticks: BRR 99 with LSPCLK 100 MHz
inline constexpr unsigned kOn = SCI_CTL1_RXENA_MASK | SCI_CTL1_TXENA_MASK | SCI_CTL1_SWRESET_MASK;
inline constexpr unsigned kFifoOn = SCI_FFTX_SCIRST_MASK | SCI_FFTX_SCIFFENA_MASK | SCI_FFTX_TXFIFOXRESET_MASK;

class SciBench : public ::testing::Test {
 protected:
  RecordingServices services;
  EdgeLine line;
  Sci sci{services};
  Tick now = 0;

  void SetUp() override {
    services.line = [this](Tick t, bool level) { return line.reaches(t, level); };
    sci.reset(0);
  }

  void write(std::uint16_t offset, unsigned value) { sci.write(offset, static_cast<std::uint16_t>(value), now); }
  unsigned read(std::uint16_t offset) { return sci.read(offset, now); }
  unsigned status() { return read(SCI_RXST); }

  /// 8N1 at kSerialBit a bit, without FIFO; nothing runs yet.
  void set_up() {
    write(SCI_CCR, 7);
    write(SCI_HBAUD, 0);
    write(SCI_LBAUD, 99);
  }
  void start() {
    set_up();
    write(SCI_CTL1, kOn);
  }
  void start_with_fifo() {
    write(SCI_FFTX, kFifoOn);
    write(SCI_FFRX, SCI_FFRX_RXFIFORESET_MASK | 31u);
    start();
  }

  void run_to(Tick t) {
    run_until(sci, t);
    now = t;
  }
  unsigned received() { return (read(SCI_FFRX) & SCI_FFRX_RXFFST_MASK) >> SCI_FFRX_RXFFST_LSB; }
  unsigned waiting() { return (read(SCI_FFTX) & SCI_FFTX_TXFFST_MASK) >> SCI_FFTX_TXFFST_LSB; }
  std::vector<Tick> interrupts_of(unsigned vector) {
    std::vector<Tick> ticks;
    for (const auto& i : services.interrupts) {
      if (i.what == vector) ticks.push_back(i.t);
    }
    return ticks;
  }
};

}  // namespace stillspin::chip::testing

#endif
