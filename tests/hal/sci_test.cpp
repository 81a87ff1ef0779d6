// Set-up of the serial port: order, divider, pins, refusals. What octets do is tested on the virtual chip.

#include "hal/f2808/registers.h"
#include "hal/hal_sci.h"
#include "tests/hal/bus_test.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint32_t kSci = SCI_BASE(1);
constexpr double kLspclk = 50e6;
std::uint32_t pair(std::uint32_t word, unsigned pin) { return (word >> (2 * (pin % 16))) & 3u; }
}  // namespace

class Serial : public BusTest {
 protected:
  void SetUp() override { bus.power_all(); }
  double rate() {
    const unsigned divider = bus.words[kSci + SCI_HBAUD] << 8 | bus.words[kSci + SCI_LBAUD];
    return kLspclk / (8.0 * (divider + 1));
  }
};

TEST_F(Serial, port_is_set_up_in_reset_and_then_let_go) {
  ASSERT_TRUE(hal_sci_init(115200));
  const std::size_t held = bus.first_write(kSci + SCI_CTL1);
  ASSERT_NE(held, FakeBus::npos);
  EXPECT_EQ(bus.steps[held].value & SCI_CTL1_SWRESET_MASK, 0u);
  for (std::uint32_t reg : {SCI_CCR, SCI_LBAUD, SCI_FFTX, SCI_FFRX}) {
    expect_before(held, bus.first_write(kSci + reg), "settings in reset");
    expect_before(bus.last_write(kSci + reg), bus.last_write(kSci + SCI_CTL1), "settings before it is let go");
  }
  EXPECT_EQ(bus.words[kSci + SCI_CTL1], 0x0023u) << "receiver, transmitter, out of reset";
  EXPECT_EQ(bus.words[kSci + SCI_CCR], 0x0007u) << "8N1, idle-line";
  EXPECT_EQ(bus.words[kSci + SCI_FFTX], 0xE000u) << "FIFO on, no interrupt";
  EXPECT_EQ(bus.words[kSci + SCI_FFRX], 0x201Fu) << "FIFO on, no interrupt";
}

TEST_F(Serial, pins_belong_to_the_port_before_it_listens) {
  ASSERT_TRUE(hal_sci_init(115200));
  EXPECT_EQ(pair(bus.word32(REG_GPAMUX2), 28), 1u);
  EXPECT_EQ(pair(bus.word32(REG_GPAMUX2), 29), 1u);
  EXPECT_EQ(bus.word32(REG_GPAPUD) & 1u << 28, 0u) << "an open line must rest high";
  expect_before(bus.first_write(REG_GPAMUX2), bus.last_write(kSci + SCI_CTL1), "pins first");
}

TEST_F(Serial, usual_rates_are_met) {
  for (std::uint32_t baud : {9600u, 19200u, 38400u, 57600u, 115200u, 230400u, 250000u}) {
    ASSERT_TRUE(hal_sci_init(baud)) << baud;
    EXPECT_NEAR(rate() / baud, 1.0, 0.005) << baud;
  }
}

TEST_F(Serial, rates_that_cannot_be_met_change_nothing) {
  ASSERT_TRUE(hal_sci_init(115200));
  bus.forget_steps();
  // Too slow for the divider, between two of its steps, beyond what a period carries.
  for (std::uint32_t baud : {0u, 50u, 340000u, 380000u, 400001u, 460800u}) EXPECT_FALSE(hal_sci_init(baud)) << baud;
  EXPECT_EQ(bus.count_writes(), 0u);
}

// The control interrupt may come anywhere in a change of the rate.
TEST_F(Serial, a_port_that_is_being_set_up_is_left_alone) {
  ASSERT_TRUE(hal_sci_init(115200));
  bus.forget_steps();
  ASSERT_TRUE(hal_sci_init(9600));
  const std::size_t alone = bus.steps.size();
  bus.forget_steps();
  bus.between = hal_sci_service;
  ASSERT_TRUE(hal_sci_init(9600));
  bus.between = nullptr;
  EXPECT_EQ(bus.steps.size(), alone);
  hal_sci_service();
  EXPECT_GT(bus.steps.size(), alone) << "and served from then on";
}

TEST_F(Serial, four_octets_a_period_are_taken) {
  ASSERT_TRUE(hal_sci_init(115200));
  std::uint16_t octets[16];
  const auto taken_of = [&](unsigned waiting) {
    bus.words[kSci + SCI_FFRX] = static_cast<std::uint16_t>(waiting << SCI_FFRX_RXFFST_LSB);
    hal_sci_service();
    return hal_sci_read(octets, 16);
  };
  bus.words[kSci + SCI_RXBUF] = 0x5A;
  EXPECT_EQ(taken_of(0), 0);
  EXPECT_EQ(taken_of(3), 3);
  EXPECT_EQ(octets[2], 0x5A);
  EXPECT_EQ(taken_of(4), 4);
  EXPECT_EQ(taken_of(16), 4) << "the rest in the next: the interrupt's time is known";
}

TEST_F(Serial, an_overrun_is_counted_and_its_flag_cleared) {
  ASSERT_TRUE(hal_sci_init(115200));
  hal_sci_service();
  EXPECT_EQ(hal_sci_errors().overrun, 0);
  bus.words[kSci + SCI_FFRX] = SCI_FFRX_RXFFOVF_MASK;
  hal_sci_service();
  EXPECT_EQ(hal_sci_errors().overrun, 1);
  EXPECT_EQ(bus.words[kSci + SCI_FFRX], 0x201Fu | SCI_FFRX_RXFFOVRCLR_MASK) << "the FIFO goes on";
}

TEST_F(Serial, errors_are_counted_to_the_end_of_a_word) {
  ASSERT_TRUE(hal_sci_init(115200));
  bus.words[kSci + SCI_RXBUF] = SCI_RXBUF_SCIFFFE_MASK;
  bus.words[kSci + SCI_FFRX] = 1u << SCI_FFRX_RXFFST_LSB;
  for (unsigned k = 0; k < 65535; ++k) {
    hal_sci_service();
    bus.forget_steps();
  }
  EXPECT_EQ(hal_sci_errors().framing, 65535);
  hal_sci_service();
  EXPECT_EQ(hal_sci_errors().framing, 65535) << "and not from the beginning";
}

TEST_F(Serial, ring_takes_what_fits) {
  ASSERT_TRUE(hal_sci_init(115200));
  std::uint16_t octets[HAL_SCI_TRANSMIT_RING + 5] = {};
  EXPECT_EQ(hal_sci_room(), HAL_SCI_TRANSMIT_RING);
  EXPECT_EQ(hal_sci_write(octets, 100), 100u);
  EXPECT_EQ(hal_sci_room(), HAL_SCI_TRANSMIT_RING - 100);
  EXPECT_EQ(hal_sci_write(octets, HAL_SCI_TRANSMIT_RING), HAL_SCI_TRANSMIT_RING - 100);
  EXPECT_EQ(hal_sci_write(octets, 1), 0u);
  EXPECT_EQ(hal_sci_read(octets, 1), 0u);
}

}  // namespace stillspin::test
