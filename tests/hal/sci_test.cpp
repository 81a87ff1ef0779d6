// Set-up of the serial port: order, divider, pins, refusals. What octets do is tested on the virtual chip.

#include <cstdlib>

#include "hal/f2808/registers.h"
#include "hal/hal_sci.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint32_t kSci = SCI_BASE(1);
constexpr double kLspclk = 50e6;
}  // namespace

class Serial : public BusTest {
 protected:
  void SetUp() override { bus.power_all(); }
  double rate() {
    const unsigned divider = bus.words[kSci + SCI_HBAUD] << 8 | bus.words[kSci + SCI_LBAUD];
    return kLspclk / (8.0 * (divider + 1));
  }
};

// In a process of its own: the driver's state is global.
TEST_F(Serial, port_that_has_not_been_set_up_is_not_served) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto serve = [this] {
    hal_sci_service();
    std::exit(bus.steps.empty() ? 0 : 1);
  };
  EXPECT_EXIT(serve(), ::testing::ExitedWithCode(0), "");
}

TEST_F(Serial, port_is_set_up_in_reset_and_then_let_go) {
  for (std::uint32_t n = 0; n <= SCI_PRI; ++n) bus.words[kSci + n] = 0xFFFF;  // a boot loader's
  ASSERT_TRUE(hal_sci_init(115200));
  const std::size_t held = bus.first_write(kSci + SCI_CTL1);
  ASSERT_NE(held, FakeBus::npos);
  EXPECT_EQ(bus.steps.at(held).value, 0u) << "in reset, receiver and transmitter off";
  for (std::uint32_t reg : {SCI_CCR, SCI_LBAUD, SCI_FFTX, SCI_FFRX}) {
    expect_before(held, bus.first_write(kSci + reg), "settings in reset");
    expect_before(bus.last_write(kSci + reg), bus.last_write(kSci + SCI_CTL1), "settings before it is let go");
  }
  EXPECT_EQ(bus.words[kSci + SCI_CTL1], 0x0023u) << "receiver, transmitter, out of reset";
  EXPECT_EQ(bus.words[kSci + SCI_CCR], 0x0007u) << "8N1, idle-line";
  EXPECT_EQ(bus.words[kSci + SCI_FFTX], 0xE000u) << "FIFO on, no interrupt";
  EXPECT_EQ(bus.words[kSci + SCI_FFRX], 0x201Fu) << "FIFO on, no interrupt";
  EXPECT_EQ(bus.words[kSci + SCI_CTL2], 0u) << "no interrupt";
  EXPECT_EQ(bus.words[kSci + SCI_FFCT], 0u) << "the rate is not measured, and octets follow each other at once";
  EXPECT_EQ(bus.written(kSci + SCI_FFTX).front(), 0u) << "FIFOs that hold nothing";
  EXPECT_EQ(bus.written(kSci + SCI_FFRX).front(), SCI_FFRX_RXFFOVRCLR_MASK);
}

TEST_F(Serial, pins_belong_to_the_port_before_it_listens) {
  bus.words[REG_GPAPUD + 1] = 0xFFFF;
  ASSERT_TRUE(hal_sci_init(115200));
  EXPECT_EQ(pair_of(bus.word32(REG_GPAMUX2), 28), 1u);
  EXPECT_EQ(pair_of(bus.word32(REG_GPAMUX2), 29), 1u);
  EXPECT_EQ(bus.word32(REG_GPAPUD) & 3u << 28, 0u) << "an open line must rest high";
  EXPECT_EQ(pair_of(bus.word32(REG_GPAQSEL2), 28), 3u) << "not sampled";
  expect_before(bus.first_write(REG_GPAMUX2), bus.last_write(kSci + SCI_CTL1), "pins first");
}

TEST_F(Serial, usual_rates_are_met) {
  for (std::uint32_t baud : {96u, 9600u, 19200u, 38400u, 57600u, 115200u, 230400u, 250000u}) {
    ASSERT_TRUE(hal_sci_init(baud)) << baud;
    EXPECT_NEAR(rate() / baud, 1.0, 0.005) << baud;
  }
}

TEST_F(Serial, rates_that_cannot_be_met_change_nothing) {
  ASSERT_TRUE(hal_sci_init(115200));
  bus.forget_steps();
  // Too slow for the divider, between two of its steps, beyond what a period carries.
  for (std::uint32_t baud : {0u, 50u, 95u, 340000u, 380000u, 400001u, 460800u})
    EXPECT_FALSE(hal_sci_init(baud)) << baud;
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
  bus.words[kSci + SCI_FFRX] = SCI_FFRX_RXFFOVF_MASK | 16u << SCI_FFRX_RXFFST_LSB;
  bus.forget_steps();
  hal_sci_service();
  EXPECT_EQ(hal_sci_errors().overrun, 1);
  std::uint16_t octets[16];
  EXPECT_EQ(hal_sci_read(octets, 16), 4) << "those that are there are good";
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

TEST_F(Serial, octets_go_out_in_their_order_four_a_period_and_as_the_fifo_has_room) {
  ASSERT_TRUE(hal_sci_init(115200));
  std::uint16_t octets[20];
  for (std::uint16_t n = 0; n < 20; ++n) octets[n] = static_cast<std::uint16_t>(0xAB00u + n);
  const auto sent_into = [&](unsigned used) {
    bus.words[kSci + SCI_FFTX] = static_cast<std::uint16_t>(used << SCI_FFTX_TXFFST_LSB);
    bus.forget_steps();
    hal_sci_service();
    return bus.written(kSci + SCI_TXBUF);
  };
  using Octets = std::vector<std::uint32_t>;
  EXPECT_EQ(sent_into(0), Octets{});
  ASSERT_EQ(hal_sci_write(octets, 12), 12);
  EXPECT_EQ(sent_into(0), (Octets{0, 1, 2, 3})) << "the lower halves of the words";
  EXPECT_EQ(sent_into(16), Octets{}) << "full";
  EXPECT_EQ(sent_into(13), (Octets{4, 5, 6}));
  EXPECT_EQ(sent_into(12), (Octets{7, 8, 9, 10}));
  EXPECT_EQ(sent_into(0), (Octets{11}));
  EXPECT_EQ(sent_into(0), Octets{});
  EXPECT_EQ(hal_sci_room(), HAL_SCI_TRANSMIT_RING);
}

// More than once round both rings, and across the end of their counters.
TEST_F(Serial, rings_keep_the_order_for_ever) {
  ASSERT_TRUE(hal_sci_init(115200));
  std::uint16_t in = 0, got = 0, to_send = 0, sent = 0;
  for (unsigned k = 0; k < 70'000 / 3; ++k) {
    bus.words[kSci + SCI_FFRX] = 1u << SCI_FFRX_RXFFST_LSB;
    for (int n = 0; n < 3; ++n) {
      bus.words[kSci + SCI_RXBUF] = in++ & 0xFFu;
      const std::uint16_t next = to_send++ & 0xFFu;
      ASSERT_EQ(hal_sci_write(&next, 1), 1);
      hal_sci_service();
      ASSERT_EQ(bus.words[kSci + SCI_TXBUF], sent++ & 0xFFu);
    }
    std::uint16_t octets[4];
    ASSERT_EQ(hal_sci_read(octets, 4), 3);
    for (int n = 0; n < 3; ++n) ASSERT_EQ(octets[n], got++ & 0xFFu);
    bus.forget_steps();
  }
}

TEST_F(Serial, characters_without_a_stop_bit_are_no_octets) {
  ASSERT_TRUE(hal_sci_init(115200));
  bus.words[kSci + SCI_FFRX] = 2u << SCI_FFRX_RXFFST_LSB;
  bus.words[kSci + SCI_RXBUF] = SCI_RXBUF_SCIFFFE_MASK | 0x55u;
  hal_sci_service();
  std::uint16_t octets[4];
  EXPECT_EQ(hal_sci_read(octets, 4), 0);
  EXPECT_EQ(hal_sci_errors().framing, 2);
  EXPECT_EQ(hal_sci_errors().lost, 0);
}

TEST_F(Serial, what_finds_the_ring_full_is_lost_and_the_older_is_kept) {
  ASSERT_TRUE(hal_sci_init(115200));
  bus.words[kSci + SCI_FFRX] = 1u << SCI_FFRX_RXFFST_LSB;
  for (unsigned k = 0; k < HAL_SCI_RECEIVE_RING + 3; ++k) {
    bus.words[kSci + SCI_RXBUF] = static_cast<std::uint16_t>(k & 0xFFu);
    hal_sci_service();
    EXPECT_EQ(hal_sci_errors().lost, k < HAL_SCI_RECEIVE_RING ? 0 : k + 1 - HAL_SCI_RECEIVE_RING);
  }
  std::uint16_t octets[HAL_SCI_RECEIVE_RING + 1];
  ASSERT_EQ(hal_sci_read(octets, HAL_SCI_RECEIVE_RING + 1), HAL_SCI_RECEIVE_RING);
  EXPECT_EQ(octets[0], 0);
  EXPECT_EQ(octets[HAL_SCI_RECEIVE_RING - 1], 255);
}

class SerialBreak : public Serial {
 protected:
  void SetUp() override {
    Serial::SetUp();
    ASSERT_TRUE(hal_sci_init(115200));
    const std::uint16_t octets[12] = {};
    ASSERT_EQ(hal_sci_write(octets, 12), 12);
    status(true, false, false);
  }
  void status(bool has_broken, bool line, bool all_sent) {
    bus.words[kSci + SCI_RXST] = has_broken ? SCI_RXST_BRKDT_MASK : 0u;
    bus.words[kSci + SCI_CTL2] = all_sent ? SCI_CTL2_TXEMPTY_MASK : 0u;
    bus.words[REG_GPADAT + 1] = line ? 0xFFFF : static_cast<std::uint16_t>(~(1u << (28 - 16)));
  }
  /// One period: how many octets it has sent, and whether it has reset the port.
  std::size_t sent = 0;
  bool reset = false;
  void service() {
    bus.forget_steps();
    hal_sci_service();
    sent = bus.written(kSci + SCI_TXBUF).size();
    const std::size_t held = bus.first_write(kSci + SCI_CTL1);
    reset = held != FakeBus::npos;
    if (!reset) return;
    EXPECT_EQ(bus.steps.at(held).value, 0x0003u) << "the receiver and the transmitter stay on";
    EXPECT_EQ(bus.words[kSci + SCI_CTL1], 0x0023u) << "and the port is let go";
    expect_before(held, bus.last_write(kSci + SCI_CTL1), "reset, then let go");
  }
};

TEST_F(SerialBreak, port_is_reset_when_the_line_is_high_and_all_has_been_sent) {
  service();
  EXPECT_EQ(sent, 4u) << "the line is low: no use in a reset";
  EXPECT_FALSE(reset);
  EXPECT_EQ(hal_sci_errors().breaks, 1);
  status(true, true, false);
  service();
  EXPECT_EQ(sent, 0u) << "it must become empty";
  EXPECT_FALSE(reset) << "an octet is on the line";
  status(true, true, true);
  service();
  EXPECT_TRUE(reset);
  EXPECT_EQ(sent, 4u);
  status(false, true, true);
  service();
  EXPECT_FALSE(reset) << "once";
  EXPECT_EQ(sent, 4u);
  EXPECT_EQ(hal_sci_errors().breaks, 1) << "it was one break";
}

TEST_F(SerialBreak, each_break_counts) {
  for (std::uint16_t times = 1; times < 4; ++times) {
    status(true, true, true);
    service();
    EXPECT_TRUE(reset);
    EXPECT_EQ(hal_sci_errors().breaks, times);
    status(false, true, true);
    service();
  }
}

// The octets of two periods, a break behind the first: what is read after it was told came behind it.
TEST_F(SerialBreak, what_came_before_it_is_dropped_and_what_came_behind_it_is_kept) {
  std::uint16_t octets[8];
  const auto receive = [&](std::uint16_t octet) {
    bus.words[kSci + SCI_FFRX] = 2u << SCI_FFRX_RXFFST_LSB;
    bus.words[kSci + SCI_RXBUF] = octet;
    service();
    bus.words[kSci + SCI_FFRX] = 0;
  };
  status(false, true, true);
  receive('a');
  EXPECT_FALSE(hal_sci_take_break());
  status(true, true, true);
  receive('b');
  status(false, true, true);
  receive('c');
  EXPECT_TRUE(hal_sci_take_break());
  ASSERT_EQ(hal_sci_read(octets, 8), 2);
  EXPECT_EQ(octets[1], 'c');
  EXPECT_FALSE(hal_sci_take_break()) << "once";
  status(true, true, true);
  service();
  status(false, true, true);
  receive('d');
  ASSERT_EQ(hal_sci_read(octets, 1), 1) << "before anybody asks for the break";
  EXPECT_TRUE(hal_sci_take_break());
  ASSERT_EQ(hal_sci_read(octets, 8), 1) << "nothing comes twice";
  EXPECT_EQ(octets[0], 'd');
}

TEST_F(SerialBreak, a_new_set_up_knows_nothing_of_it) {
  bus.words[kSci + SCI_FFRX] = 1u << SCI_FFRX_RXFFST_LSB;
  for (unsigned k = 0; k <= HAL_SCI_RECEIVE_RING; ++k) service();
  bus.words[kSci + SCI_FFRX] = SCI_FFRX_RXFFOVF_MASK | 1u << SCI_FFRX_RXFFST_LSB;
  bus.words[kSci + SCI_RXBUF] = SCI_RXBUF_SCIFFFE_MASK;
  service();
  hal_sci_errors_t errors = hal_sci_errors();
  for (const std::uint16_t one : {errors.breaks, errors.overrun, errors.framing, errors.lost}) ASSERT_EQ(one, 1);
  ASSERT_TRUE(hal_sci_init(9600));
  errors = hal_sci_errors();
  EXPECT_EQ(errors.breaks + errors.overrun + errors.framing + errors.lost, 0);
  EXPECT_EQ(hal_sci_room(), HAL_SCI_TRANSMIT_RING) << "what was to be sent is dropped";
  std::uint16_t octet;
  EXPECT_EQ(hal_sci_read(&octet, 1), 0) << "and what had come";
  EXPECT_FALSE(hal_sci_take_break());
  status(false, true, true);
  service();
  EXPECT_FALSE(reset);
}

}  // namespace stillspin::test
