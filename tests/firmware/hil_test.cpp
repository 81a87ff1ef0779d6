// The host in the loop as it is asked for over the link: when it is let in, what a step may be, a step that comes
// again.

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
#include "tests/firmware/hil_host.hpp"
#include "tests/firmware/requests.hpp"

extern "C" {
#include "hal/hal_time.h"
}

namespace {

using namespace stillspin::test;

class HostInTheLoop : public Requests {
 protected:
  void SetUp() override {
    NEEDS("hil");
    Requests::SetUp();
    let_recordings_play();
  }
  void TearDown() override { hil_reset(); }

  /// A step of such a shape that tells nothing new against zeros: windows, words of a result, inputs, works.
  static Octets step(std::uint16_t sequence, const Octets& shape) {
    const Octets zeros(REPLAY_INPUTS + 1);
    Octets octets(RECORD_BODY_MAX);
    octet_writer_t w = octet_writer(octets.data(), RECORD_BODY_MAX);
    put_u16(&w, sequence);
    delta_put(&w, shape.data(), zeros.data(), HIL_STEP_SHAPE);
    delta_put(&w, zeros.data(), zeros.data(), shape[3]);
    delta_put(&w, zeros.data(), zeros.data(), shape[2]);
    for (int k = 0; k < shape[0]; ++k)
      delta_put(&w, zeros.data(), zeros.data(), static_cast<std::uint16_t>(1 + shape[1]));
    octets.resize(w.count);
    return octets;
  }
  Answer give_step(std::uint16_t sequence, const Octets& shape = {0, 0, 0, 0}) {
    return ask(REQUEST_HIL_STEP, step(sequence, shape));
  }
};

// The power stage may be on although the drive does not think so.
TEST_F(HostInTheLoop, IsNotLetInWhileAGateMayBeOn) {
  board.gates_on = true;
  const Answer refused = ask(REQUEST_HIL_ENTER);
  EXPECT_EQ(refused.status(), RUNNING);
  EXPECT_EQ(refused.text(), "the power stage is on: stop first");
  EXPECT_TRUE(board.gates_on) << "whoever has it on keeps it";
  EXPECT_FALSE(feature_status.stepped);
  board.gates_on = false;
  EXPECT_EQ(ask(REQUEST_HIL_ENTER).status(), OK);
}

TEST_F(HostInTheLoop, IsNotLetInWhileTheMemoryIsWritten) {
  NEEDS("store");
  nvm.latency = 100'000;
  ASSERT_EQ(give(COMMAND_SAVE).status(), OK);
  const Answer refused = ask(REQUEST_HIL_ENTER);
  EXPECT_EQ(refused.status(), BUSY);
  EXPECT_EQ(refused.text(), "parameters are being saved or read: try again");
  EXPECT_FALSE(feature_status.stepped);
}

TEST_F(HostInTheLoop, NothingIsSteppedBeforeItIsLetIn) {
  for (const Answer& refused : {give_step(0), ask(REQUEST_HIL_LEAVE)}) {
    EXPECT_EQ(refused.status(), STATE);
    EXPECT_EQ(refused.text(), "not in host-in-the-loop mode: enter it first");
  }
}

// At first a drive of the board's own may have been there, then one that was stepped.
TEST_F(HostInTheLoop, TheDriveBeginsAnewWithEveryEntry) {
  const Octets longest = {REPLAY_WINDOWS, REPLAY_RESULTS, REPLAY_INPUTS, REPLAY_WORKS};
  for (int entry = 0; entry < 2; ++entry) {
    ASSERT_EQ(set(86, 500 * 256).status(), OK);
    board.frame = {};
    board.interrupts_enabled = false;
    const int switched_off = board.gates_off_calls;
    ASSERT_EQ(ask(REQUEST_HIL_ENTER).status(), OK);
    EXPECT_GT(board.gates_off_calls, switched_off);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(board.frame.edge_tick[k], HAL_PWM_NONE) << "the board itself makes no pulses";
      EXPECT_EQ(board.frame.edge_tick[HAL_PWM_LEGS + k], HAL_PWM_NONE);
      EXPECT_EQ(board.frame.burst_start_tick[k], HAL_PWM_NONE) << "nor does it sample";
      EXPECT_EQ(board.frame.burst_end_tick[k], HAL_PWM_NONE);
    }
    EXPECT_TRUE(board.interrupts_enabled);
    EXPECT_TRUE(replay_plays());
    EXPECT_EQ(inside::state(), DRIVE_BOOT);
    EXPECT_EQ(parameter_get(86), 3000 * 256);
    EXPECT_EQ(hil_expected(), 0);
    ASSERT_EQ(give_step(0, longest).status(), OK);
    ASSERT_NE(inside::state(), DRIVE_BOOT) << "it is stepped";
  }
  hil_reset();
  EXPECT_FALSE(feature_status.stepped || replay_plays()) << "only power-on ends it";
}

// Of the board's own interrupts the serial port and the watchdog live on. The drive is not theirs.
TEST_F(HostInTheLoop, TheBoardsInterruptsServeThePortAndTheWatchdog) {
  ASSERT_EQ(ask(REQUEST_HIL_ENTER).status(), OK);
  const std::uint16_t heartbeat = inside::heartbeat(), before = feature_status.heartbeat;
  for (int k = 1; k <= 3; ++k) {
    board.control_interrupt();
    board.window_interrupt();
    EXPECT_EQ(feature_status.heartbeat, before + k);
    EXPECT_EQ(board.serial_services, k);
    EXPECT_EQ(board.control_ends, k);
  }
  EXPECT_EQ(inside::heartbeat(), heartbeat);
  ASSERT_EQ(ask(REQUEST_HIL_LEAVE).status(), OK);
  const std::uint16_t last = feature_status.heartbeat;
  board.control_interrupt();
  EXPECT_EQ(feature_status.heartbeat, last) << "nothing is left for the watchdog";
  EXPECT_EQ(board.serial_services, 4) << "the answer still goes out";
  EXPECT_EQ(board.control_ends, 4);
}

TEST_F(HostInTheLoop, AHostThatIsGoneResetsTheBoard) {
  const std::uint32_t rest = HIL_REST_S * HAL_TIME_CYCLES_PER_S;
  const auto is_alive = [] {
    hil_service();
    const std::uint16_t before = feature_status.heartbeat;
    board.control_interrupt();
    return feature_status.heartbeat != before;
  };
  board.cycles = 0xFFFFFFFFu - rest / 2;  // the clock wraps
  ASSERT_EQ(ask(REQUEST_HIL_ENTER).status(), OK);
  board.cycles += rest;
  EXPECT_TRUE(is_alive());
  ASSERT_EQ(give_step(0).status(), OK);
  board.cycles += rest;
  EXPECT_TRUE(is_alive()) << "the time is since the last step";
  ASSERT_EQ(give_step(77).status(), CONFLICT);
  board.cycles += rest;
  EXPECT_TRUE(is_alive()) << "who asks for the wrong one is still there";
  board.cycles += 1;
  EXPECT_FALSE(is_alive());
  EXPECT_FALSE(is_alive());
  hil_reset();
  board.cycles = 2 * rest;
  hil_service();
  ASSERT_EQ(ask(REQUEST_HIL_ENTER).status(), OK);
  EXPECT_TRUE(is_alive()) << "nobody is missed before he is let in";
}

TEST_F(HostInTheLoop, AStepIsNoLongerThanItsRecording) {
  const Octets longest = {REPLAY_WINDOWS, REPLAY_RESULTS, REPLAY_INPUTS, REPLAY_WORKS};
  ASSERT_EQ(ask(REQUEST_HIL_ENTER).status(), OK);
  for (std::size_t k = 0; k < longest.size(); ++k) {
    Octets shape = longest;
    shape[k]++;
    EXPECT_EQ(give_step(0, shape).status(), LENGTH) << k;
    EXPECT_EQ(hil_expected(), 0);
  }
  EXPECT_EQ(give_step(0, longest).status(), OK);
}

// Its answer was lost on the way.
TEST_F(HostInTheLoop, AStepThatComesAgainIsAnsweredAgainAndNotCarriedOut) {
  ASSERT_EQ(ask(REQUEST_HIL_ENTER).status(), OK);
  EXPECT_EQ(give_step(0xFFFF).status(), CONFLICT) << "there is none before the first";
  ASSERT_EQ(give_step(0).status(), OK);
  const Answer once = give_step(1);
  ASSERT_EQ(once.status(), OK);
  inside::fault() = FAULT_LINK_LOW;  // were it carried out, the step would see to that
  inside::be_in(DRIVE_FAULT);
  const std::uint32_t crc = hil_signals_crc();
  const Answer again = give_step(1);
  EXPECT_EQ(again.status(), OK);
  EXPECT_EQ(again.body(), once.body());
  EXPECT_EQ(again.number(again.body() - 4, 4), crc);
  EXPECT_EQ(hil_expected(), 2);
  EXPECT_EQ(give_step(0).status(), CONFLICT) << "the one before is gone";
  EXPECT_EQ(give_step(0).number(0, 2), 2u) << "what is expected instead";
}

}  // namespace
