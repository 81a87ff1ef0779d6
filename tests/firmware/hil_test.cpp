// The host in the loop as it is asked for over the link: when it is let in, what a step may be, a step that comes
// again.

#include "tests/firmware/requests.hpp"

extern "C" {
#include "firmware/hil/delta.h"
#include "firmware/hil/hil.h"
}

namespace {

using namespace stillspin::test;

class HostInTheLoop : public Requests {
 protected:
  void TearDown() override { hil_reset(); }

  /// A step of such a shape that tells nothing new against zeros: windows, words of a result, inputs, works.
  static Octets step(std::uint16_t sequence, const Octets& shape) {
    const Octets zeros(TAPE_INPUTS + 1);
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
  EXPECT_FALSE(hil_is_active());
  board.gates_on = false;
  EXPECT_EQ(ask(REQUEST_HIL_ENTER).status(), OK);
}

TEST_F(HostInTheLoop, IsNotLetInWhileTheMemoryIsWritten) {
  nvm.latency = 100'000;
  ASSERT_EQ(give(COMMAND_SAVE).status(), OK);
  const Answer refused = ask(REQUEST_HIL_ENTER);
  EXPECT_EQ(refused.status(), BUSY);
  EXPECT_EQ(refused.text(), "parameters are being saved or read: try again");
  EXPECT_FALSE(hil_is_active());
}

TEST_F(HostInTheLoop, NothingIsSteppedBeforeItIsLetIn) {
  EXPECT_EQ(give_step(0).status(), STATE);
  EXPECT_EQ(ask(REQUEST_HIL_LEAVE).status(), STATE);
}

TEST_F(HostInTheLoop, AStepIsNoLongerThanItsTape) {
  const Octets longest = {TAPE_WINDOWS, TAPE_RESULTS, TAPE_INPUTS, TAPE_WORKS};
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
  drive.fault = FAULT_LINK_LOW;  // were it carried out, the step would see to that
  drive.state = DRIVE_FAULT;
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
