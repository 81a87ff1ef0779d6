// The serial port's receiver: sampling, errors, breaks, FIFO and interrupts.

#include "tests/chip/sci.hpp"

namespace stillspin::chip::testing {
namespace {

using SciReceive = SciBench;

TEST_F(SciReceive, CharacterIsReadyInItsStopBit) {
  line.frame(0xA5, 1000, kSerialBit);
  start();
  const Tick stop_sample = 1000 + 9 * kSerialBit + 6 * kSerialBit / 8;
  run_to(stop_sample - 1);
  EXPECT_EQ(status(), 0u);
  run_to(stop_sample);
  EXPECT_EQ(status(), SCI_RXST_RXRDY_MASK);
  EXPECT_EQ(read(SCI_RXEMU), 0xA5u);
  EXPECT_EQ(status(), SCI_RXST_RXRDY_MASK) << "the emulation buffer leaves the flag alone";
  EXPECT_EQ(read(SCI_RXBUF), 0xA5u);
  EXPECT_EQ(status(), 0u);
}

TEST_F(SciReceive, RateComesFromLspclkAndDivider) {
  services.sysclk = 1;
  services.lspclk = 4;
  write(SCI_CCR, 7);
  write(SCI_HBAUD, 1);
  write(SCI_LBAUD, 2);  // BRR 258
  write(SCI_CTL1, kOn);
  const Tick bit = 8 * 259 * 4;
  write(SCI_TXBUF, 0);
  run_to(20 * bit);
  ASSERT_EQ(services.frames.size(), 1u);
  EXPECT_EQ(services.frames[0].what.bit, bit);
  write(SCI_HBAUD, 0);
  write(SCI_LBAUD, 0);
  write(SCI_TXBUF, 0);
  run_to(40 * bit);
  EXPECT_EQ(services.frames[1].what.bit, 16 * 4) << "BRR 0 divides by 16";
}

TEST_F(SciReceive, SenderTwoPercentOffIsRead) {
  Tick t = 1000;
  for (const Tick bit : {784, 816}) {
    for (unsigned octet : {0x00u, 0xFFu, 0x5Au}) t = line.frame(octet, t, bit);
  }
  start_with_fifo();
  run_to(t + 10 * kSerialBit);
  EXPECT_EQ(received(), 6u);
  for (unsigned octet : {0x00u, 0xFFu, 0x5Au, 0x00u, 0xFFu, 0x5Au}) EXPECT_EQ(read(SCI_RXBUF), octet);
}

TEST_F(SciReceive, SenderWithDoubleRateIsReadWrongly) {
  Tick t = 1000;
  for (int k = 0; k < 8; ++k) t = line.frame(0x00, t, kSerialBit / 2);
  start_with_fifo();
  run_to(t + 20 * kSerialBit);
  // Nine half bits low, one high, again and again: high lies in the later half of the bits 4 (data bit 3) and 9 (stop).
  EXPECT_EQ(received(), 4u);
  EXPECT_EQ(read(SCI_RXBUF), 0x08u);
}

TEST_F(SciReceive, ShortLowIsNoStartBit) {
  line.low_between(1000, 1000 + 3 * kSerialBit / 8);
  line.frame(0x42, 3000, kSerialBit);
  start_with_fifo();
  run_to(30000);
  EXPECT_EQ(received(), 1u);
  EXPECT_EQ(read(SCI_RXBUF), 0x42u);
}

TEST_F(SciReceive, GlitchOnOneOfThreeSamplesIsOutvoted) {
  // 0xFF: all data bits high; a low of one sample in the middle of bit 3.
  line.low_between(1000, 1000 + kSerialBit);
  const Tick sample = 1000 + 4 * kSerialBit + 5 * kSerialBit / 8;
  line.low_between(sample - 20, sample + 20);
  start_with_fifo();
  run_to(30000);
  EXPECT_EQ(read(SCI_RXBUF), 0xFFu);
}

TEST_F(SciReceive, MissingStopBitIsAFramingErrorAndGoesOn) {
  const Tick end = line.bits(0x31u << 1, 10, 1000, kSerialBit);
  line.frame(0x32, end + kSerialBit, kSerialBit);
  start_with_fifo();
  run_to(60000);
  EXPECT_EQ(status() & (SCI_RXST_FE_MASK | SCI_RXST_BRKDT_MASK | SCI_RXST_RXERROR_MASK),
            SCI_RXST_FE_MASK | SCI_RXST_RXERROR_MASK);
  EXPECT_EQ(read(SCI_RXBUF), SCI_RXBUF_SCIFFFE_MASK | 0x31u);
  EXPECT_EQ(read(SCI_RXBUF), 0x32u) << "the flag belongs to its word";
  write(SCI_CTL1, kOn & ~SCI_CTL1_SWRESET_MASK);
  EXPECT_EQ(status() & SCI_RXST_FE_MASK, 0u);
}

TEST_F(SciReceive, BreakStopsTheReceiverUntilSoftwareReset) {
  const Tick low_end = 1000 + 30 * kSerialBit;
  line.low_between(1000, low_end);
  line.frame(0x33, low_end + 5 * kSerialBit, kSerialBit);
  const Tick second = low_end + 40 * kSerialBit;
  line.frame(0x34, second, kSerialBit);
  start_with_fifo();
  write(SCI_CTL2, SCI_CTL2_RXBKINTENA_MASK);
  const Tick break_at = 1000 + 9 * kSerialBit + 6 * kSerialBit / 8 + 10 * kSerialBit;
  run_to(break_at - 1);
  EXPECT_EQ(status() & SCI_RXST_BRKDT_MASK, 0u);
  run_to(break_at);
  EXPECT_EQ(status() & SCI_RXST_BRKDT_MASK, SCI_RXST_BRKDT_MASK);
  EXPECT_EQ(interrupts_of(VECTOR_SCIRXINTA), (std::vector<Tick>{break_at}));
  run_to(second - kSerialBit);
  EXPECT_EQ(received(), 1u) << "the word that turned into the break, and nothing after it";
  write(SCI_CTL1, kOn & ~SCI_CTL1_SWRESET_MASK);
  write(SCI_CTL1, kOn);
  EXPECT_EQ(status() & SCI_RXST_BRKDT_MASK, 0u);
  run_to(second + 20 * kSerialBit);
  read(SCI_RXBUF);
  EXPECT_EQ(read(SCI_RXBUF), 0x34u);
}

TEST_F(SciReceive, ResetOnALineThatIsStillLowGivesTheNextBreak) {
  line.low_between(1000, 1000 + 100 * kSerialBit);
  start_with_fifo();
  run_to(1000 + 40 * kSerialBit);
  write(SCI_CTL1, kOn & ~SCI_CTL1_SWRESET_MASK);
  write(SCI_CTL1, kOn);
  EXPECT_EQ(status() & SCI_RXST_BRKDT_MASK, 0u);
  run_to(1000 + 80 * kSerialBit);
  EXPECT_EQ(status() & SCI_RXST_BRKDT_MASK, SCI_RXST_BRKDT_MASK);
}

TEST_F(SciReceive, ParityIsChecked) {
  line.bits(0x07u << 1 | 1u << 9 | 1u << 10, 11, 1000, kSerialBit);   // even parity of three ones is 1
  line.bits(0x07u << 1 | 0u << 9 | 1u << 10, 11, 20000, kSerialBit);  // wrong
  start_with_fifo();
  write(SCI_CCR, 7u | SCI_CCR_PARITYENA_MASK | SCI_CCR_PARITY_MASK);
  run_to(40000);
  EXPECT_EQ(read(SCI_RXBUF), 0x07u);
  EXPECT_EQ(read(SCI_RXBUF), SCI_RXBUF_SCIFFPE_MASK | 0x07u);
  EXPECT_EQ(status() & SCI_RXST_PE_MASK, SCI_RXST_PE_MASK);
}

TEST_F(SciReceive, UnreadBufferIsOverrun) {
  line.frame(1, line.frame(2, 1000, kSerialBit), kSerialBit);
  start();
  write(SCI_CTL1, kOn | SCI_CTL1_RXERRINTENA_MASK);
  run_to(30000);
  EXPECT_EQ(status() & SCI_RXST_OE_MASK, SCI_RXST_OE_MASK);
  EXPECT_EQ(interrupts_of(VECTOR_SCIRXINTA).size(), 1u) << "the error's";
  EXPECT_EQ(read(SCI_RXBUF), 1u) << "the newer one";
}

TEST_F(SciReceive, FullFifoLosesTheOldestWord) {
  Tick t = 1000;
  for (unsigned octet = 1; octet <= 17; ++octet) t = line.frame(octet, t, kSerialBit);
  start_with_fifo();
  run_to(t);
  EXPECT_EQ(received(), 16u);
  EXPECT_EQ(read(SCI_FFRX) & SCI_FFRX_RXFFOVF_MASK, SCI_FFRX_RXFFOVF_MASK);
  EXPECT_EQ(read(SCI_RXBUF), 2u);
  write(SCI_FFRX, SCI_FFRX_RXFIFORESET_MASK | SCI_FFRX_RXFFOVRCLR_MASK | 31u);
  EXPECT_EQ(read(SCI_FFRX) & SCI_FFRX_RXFFOVF_MASK, 0u);
  EXPECT_EQ(received(), 15u);
}

TEST_F(SciReceive, FifoInterruptComesAtItsLevelAndAgainWhenClearedTooEarly) {
  Tick t = 1000;
  for (unsigned octet = 1; octet <= 4; ++octet) t = line.frame(octet, t, kSerialBit);
  start_with_fifo();
  const unsigned level = SCI_FFRX_RXFIFORESET_MASK | SCI_FFRX_RXFFIENA_MASK | 3u;
  write(SCI_FFRX, level | SCI_FFRX_RXFFINTCLR_MASK);
  run_to(t);
  const Tick third = 1000 + 29 * kSerialBit + 6 * kSerialBit / 8;
  EXPECT_EQ(interrupts_of(VECTOR_SCIRXINTA), (std::vector<Tick>{third}));
  read(SCI_RXBUF);
  write(SCI_FFRX, level | SCI_FFRX_RXFFINTCLR_MASK);
  EXPECT_EQ(interrupts_of(VECTOR_SCIRXINTA).size(), 2u) << "three words are still there";
  read(SCI_RXBUF);
  write(SCI_FFRX, level | SCI_FFRX_RXFFINTCLR_MASK);
  EXPECT_EQ(interrupts_of(VECTOR_SCIRXINTA).size(), 2u);
  EXPECT_EQ(read(SCI_FFRX) & SCI_FFRX_RXFFINT_MASK, 0u);
}

TEST_F(SciReceive, DisabledReceiverKeepsNothing) {
  line.frame(0x42, 1000, kSerialBit);
  start();
  write(SCI_CTL1, kOn & ~SCI_CTL1_RXENA_MASK);
  run_to(20000);
  EXPECT_EQ(status(), 0u);
}

TEST_F(SciReceive, WithoutAClockNothingIsReceived) {
  line.frame(0x42, 1000, kSerialBit);
  start();
  now = 1500;
  services.clocked = false;
  sci.clocks_changed(now);
  run_to(20000);
  services.clocked = true;
  sci.clocks_changed(now);
  EXPECT_EQ(status(), 0u);
}

TEST_F(SciReceive, LineThatIsWrittenLaterIsSeen) {
  start();
  EXPECT_EQ(sci.next_event(), kNever);
  now = 5000;
  line.frame(0x42, 6000, kSerialBit);
  sci.line_changed(now);
  run_to(20000);
  EXPECT_EQ(read(SCI_RXBUF), 0x42u);
}

}  // namespace
}  // namespace stillspin::chip::testing
