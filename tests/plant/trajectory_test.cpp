// The chain of segments where its events do not end.

#include "sim_host/plant/trajectory.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace stillspin::plant {
namespace {

// A current that leaves zero to the wrong side again and again, as if no event chose another side: the chain ends with
// a complaint, also where it goes on by next to nothing between two events because the shaft hardly turns.
TEST(Trajectory, ModesThatDoNotSettleAreADefectHoweverSlowTheShaft) {
  for (const double speed : {0.0003, 0.3, 300.0}) {
    PlantConfig c;
    c.link.stiff = true;
    c.link.ripple = 0.0;
    c.initial.speed = speed;
    Trajectory trajectory(c);
    trajectory.model().clamp = Clamp::kNone;  // short-circuited
    trajectory.model().direction = {1, 1, 1};
    int segments = 0;
    const auto go_on = [&] {
      for (; segments < 100000; ++segments) {
        trajectory.look_ahead(1000000);
        trajectory.locate();
        trajectory.commit();
      }
    };
    EXPECT_THROW(go_on(), std::runtime_error) << speed;
    EXPECT_LT(segments, 60 * 25) << speed << ": 60 moments with some 20 events each";
  }
}

}  // namespace
}  // namespace stillspin::plant
