// The serial port's transmitter: frames and their times, FIFO, flags, interrupts; loopback and what is not modelled.

#include "tests/chip/sci.hpp"

namespace stillspin::chip::testing {
namespace {

using SciTransmit = SciBench;

TEST_F(SciTransmit, FrameLeavesWhenItsLastBitIsOver) {
  start();
  now = 100;
  write(SCI_TXBUF, 0xA5);
  EXPECT_EQ(read(SCI_CTL2), SCI_CTL2_TXRDY_MASK) << "the buffer is free again, the shift register is not";
  run_to(100 + 10 * kSerialBit - 1);
  EXPECT_TRUE(services.frames.empty());
  run_to(100 + 10 * kSerialBit);
  ASSERT_EQ(services.frames.size(), 1u);
  const SerialFrame& frame = services.frames[0].what;
  EXPECT_EQ(frame.begin, 100);
  EXPECT_EQ(frame.bit, kSerialBit);
  EXPECT_EQ(frame.bits, 10u);
  EXPECT_EQ(frame.levels, 0xA5u << 1 | 1u << 9);
  EXPECT_EQ(read(SCI_CTL2), SCI_CTL2_TXRDY_MASK | SCI_CTL2_TXEMPTY_MASK);
}

TEST_F(SciTransmit, SecondWordWaitsInTheBuffer) {
  start();
  write(SCI_TXBUF, 1);
  write(SCI_TXBUF, 2);
  EXPECT_EQ(read(SCI_CTL2), 0u);
  run_to(20 * kSerialBit);
  ASSERT_EQ(services.frames.size(), 2u);
  EXPECT_EQ(services.frames[1].what.begin, 10 * kSerialBit);
}

TEST_F(SciTransmit, FifoTakesSixteenBehindTheShiftRegister) {
  start_with_fifo();
  for (unsigned octet = 0; octet < 18; ++octet) write(SCI_TXBUF, octet);
  EXPECT_EQ(waiting(), 16u);
  run_to(1000 * kSerialBit);
  ASSERT_EQ(services.frames.size(), 17u) << "the last one found no room";
  for (unsigned k = 0; k < 17; ++k) {
    EXPECT_EQ(services.frames[k].what.levels, k << 1 | 1u << 9);
    EXPECT_EQ(services.frames[k].t, (k + 1) * 10 * kSerialBit);
  }
}

TEST_F(SciTransmit, FifoDelayPutsBitsBetweenWords) {
  start_with_fifo();
  write(SCI_FFCT, 5);
  write(SCI_TXBUF, 1);
  write(SCI_TXBUF, 2);
  run_to(100 * kSerialBit);
  ASSERT_EQ(services.frames.size(), 2u);
  EXPECT_EQ(services.frames[1].what.begin, 15 * kSerialBit);
}

TEST_F(SciTransmit, FifoInterruptComesWhenFewAreLeft) {
  start_with_fifo();
  for (unsigned octet = 0; octet < 5; ++octet) write(SCI_TXBUF, octet);
  write(SCI_FFTX, kFifoOn | SCI_FFTX_TXFFIENA_MASK | SCI_FFTX_TXFFINTCLR_MASK | 2u);
  EXPECT_TRUE(interrupts_of(VECTOR_SCITXINTA).empty());
  run_to(100 * kSerialBit);
  EXPECT_EQ(interrupts_of(VECTOR_SCITXINTA), (std::vector<Tick>{20 * kSerialBit})) << "two left when the third begins";
}

TEST_F(SciTransmit, EnabledInterruptFindsAFlagThatIsUp) {
  start_with_fifo();
  EXPECT_EQ(read(SCI_FFTX) & SCI_FFTX_TXFFINT_MASK, SCI_FFTX_TXFFINT_MASK) << "empty is at its level";
  write(SCI_FFTX, kFifoOn | SCI_FFTX_TXFFIENA_MASK);
  EXPECT_EQ(interrupts_of(VECTOR_SCITXINTA).size(), 1u);
}

TEST_F(SciTransmit, BufferInterruptComesWhenTheBufferIsFree) {
  start();
  write(SCI_CTL2, SCI_CTL2_TXINTENA_MASK);
  EXPECT_EQ(interrupts_of(VECTOR_SCITXINTA).size(), 1u) << "it is free";
  write(SCI_TXBUF, 1);
  write(SCI_TXBUF, 2);
  EXPECT_EQ(interrupts_of(VECTOR_SCITXINTA).size(), 2u);
  run_to(10 * kSerialBit);
  EXPECT_EQ(interrupts_of(VECTOR_SCITXINTA).size(), 3u);
}

TEST_F(SciTransmit, SoftwareResetCutsTheFrameAndKeepsTheFifo) {
  start_with_fifo();
  write(SCI_TXBUF, 1);
  write(SCI_TXBUF, 2);
  run_to(5 * kSerialBit);
  write(SCI_CTL1, kOn & ~SCI_CTL1_SWRESET_MASK);
  run_to(50 * kSerialBit);
  EXPECT_TRUE(services.frames.empty());
  EXPECT_EQ(waiting(), 1u);
  write(SCI_CTL1, kOn);
  run_to(100 * kSerialBit);
  ASSERT_EQ(services.frames.size(), 1u);
  EXPECT_EQ(services.frames[0].what.levels, 2u << 1 | 1u << 9);
}

TEST_F(SciTransmit, FifoResetEmptiesIt) {
  start_with_fifo();
  for (unsigned octet = 0; octet < 5; ++octet) write(SCI_TXBUF, octet);
  write(SCI_FFTX, kFifoOn & ~SCI_FFTX_TXFIFOXRESET_MASK);
  EXPECT_EQ(waiting(), 0u);
  write(SCI_TXBUF, 9);
  EXPECT_EQ(waiting(), 0u) << "held in reset";
}

TEST_F(SciTransmit, ParityAndTwoStopBits) {
  start();
  write(SCI_CCR, 6u | SCI_CCR_PARITYENA_MASK | SCI_CCR_STOPBITS_MASK);  // 7 bits, odd parity
  write(SCI_TXBUF, 0xFF);
  run_to(20 * kSerialBit);
  ASSERT_EQ(services.frames.size(), 1u);
  EXPECT_EQ(services.frames[0].what.bits, 11u);
  EXPECT_EQ(services.frames[0].what.levels, 0x7Fu << 1 | 0u << 8 | 3u << 9) << "seven ones are odd already";
}

TEST_F(SciTransmit, DisabledTransmitterSendsNothing) {
  start_with_fifo();
  write(SCI_CTL1, kOn & ~SCI_CTL1_TXENA_MASK);
  write(SCI_TXBUF, 1);
  run_to(50 * kSerialBit);
  EXPECT_TRUE(services.frames.empty());
  write(SCI_CTL1, kOn);
  run_to(100 * kSerialBit);
  EXPECT_EQ(services.frames.size(), 1u);
}

TEST_F(SciTransmit, LoopbackComesBackAndLeavesTheLineAlone) {
  line.frame(0x11, 1000, kSerialBit);
  start_with_fifo();
  write(SCI_CCR, 7u | SCI_CCR_LOOPBKENA_MASK);
  write(SCI_TXBUF, 0x42);
  run_to(50 * kSerialBit);
  EXPECT_TRUE(services.frames.empty());
  EXPECT_EQ(received(), 1u);
  EXPECT_EQ(read(SCI_RXBUF), 0x42u);
}

TEST_F(SciTransmit, ResetValues) {
  EXPECT_EQ(read(SCI_CTL2), 0xC0u);
  EXPECT_EQ(read(SCI_FFTX), 0xA000u);
  EXPECT_EQ(read(SCI_FFRX), 0x201Fu);
}

TEST_F(SciTransmit, ModesThatAreNotModelledEndTheRun) {
  write(SCI_CCR, 7u | SCI_CCR_ADDRIDLE_MODE_MASK);
  write(SCI_CTL1, SCI_CTL1_SLEEP_MASK);
  EXPECT_EQ(services.errors.size(), 2u);
}

}  // namespace
}  // namespace stillspin::chip::testing
