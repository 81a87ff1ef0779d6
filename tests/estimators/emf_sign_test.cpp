// The back-EMF's sign on voltages of a machine in steady state and while its current changes.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "estimators/emf_sign.h"
}

namespace {

using namespace stillspin::test;

emf_sign_result_t step(emf_sign_t& s, const machine_model_t& model, Vector v, Vector i, std::int32_t speed,
                       std::int32_t periods) {
  const emf_sign_seen_t seen = {raw_dq(v, 16).q, raw_dq(i, 20), speed, periods};
  emf_sign_look(&s, &model, &seen);
  return emf_sign_judge(&s, &model, speed);
}

// Periods until there is an answer; -1 when there is none within 400. One look in `every` periods.
int answer_after(emf_sign_result_t answer, double rpm, bool wrong, double iq, int every = 1) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const double w = m.electrical(rpm);
  const double flux = wrong ? -m.flux : m.flux;
  emf_sign_t s;
  emf_sign_reset(&s);
  for (int n = 0; n < 400; n += every) {
    const Vector v = {-w * m.lq * iq, m.rs * iq + w * flux};
    if (step(s, model, v, {0.0, iq}, bpp(w), every) == answer) return n;
  }
  return -1;
}

TEST(EmfSign, RightIsNeverReversed) {
  for (const double rpm : {-3000.0, -300.0, -150.0, 0.0, 150.0, 300.0, 3000.0}) {
    for (const double iq : {-14.0, 0.0, 14.0}) {
      EXPECT_EQ(answer_after(EMF_SIGN_REVERSED, rpm, false, iq), -1) << rpm << ", " << iq;
    }
  }
}

TEST(EmfSign, TheAnswerComesWithinFifteenMilliseconds) {
  for (const double rpm : {-3000.0, -200.0, 200.0, 3000.0}) {
    for (const double iq : {-10.0, 0.0, 10.0}) {
      for (const bool wrong : {false, true}) {
        const int n = answer_after(wrong ? EMF_SIGN_REVERSED : EMF_SIGN_RIGHT, rpm, wrong, iq);
        EXPECT_GE(n, 50) << rpm << ", " << iq;  // never in a moment
        EXPECT_LE(n, 150) << rpm << ", " << iq;
        EXPECT_EQ(answer_after(wrong ? EMF_SIGN_RIGHT : EMF_SIGN_REVERSED, rpm, wrong, iq), -1);
        const int seldom = answer_after(wrong ? EMF_SIGN_REVERSED : EMF_SIGN_RIGHT, rpm, wrong, iq, 8);
        EXPECT_GE(seldom, 48) << rpm << ", " << iq;  // the seventh look
        EXPECT_LE(seldom, 150) << rpm << ", " << iq;
      }
    }
  }
}

TEST(EmfSign, BelowTenVoltsItDoesNotAnswer) {
  for (const bool wrong : {false, true}) {
    EXPECT_EQ(answer_after(EMF_SIGN_REVERSED, 100.0, wrong, 0.0), -1);  // 6.7 V
    EXPECT_EQ(answer_after(EMF_SIGN_RIGHT, 100.0, wrong, 0.0), -1);
  }
}

// More than half of the EMF expected is right, more than a quarter of it against the rotation reversed.
TEST(EmfSign, AnEmfBetweenTheTwoIsNoAnswer) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const double w = m.electrical(600.0);
  for (const auto& [share, answer] :
       {std::pair{-0.27, EMF_SIGN_REVERSED}, {-0.23, EMF_SIGN_OPEN}, {0.48, EMF_SIGN_OPEN}, {0.52, EMF_SIGN_RIGHT}}) {
    emf_sign_t s;
    emf_sign_reset(&s);
    emf_sign_result_t last = EMF_SIGN_OPEN;
    for (int n = 0; n < 1000; ++n) last = step(s, model, {0.0, share * w * m.flux}, {0.0, 0.0}, bpp(w), 1);
    EXPECT_EQ(last, answer) << share;
    EXPECT_EQ(s.agreed > 0, answer == EMF_SIGN_RIGHT) << share;
    EXPECT_EQ(s.agreed < 0, answer == EMF_SIGN_REVERSED) << share;
  }
}

// Reversals of the full current in a millisecond, both ways: the inductance's voltage is ten times the EMF.
TEST(EmfSign, ChangesOfTheCurrentDoNotCount) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const double w = m.electrical(160.0);
  emf_sign_t s;
  emf_sign_reset(&s);
  double iq = -14.0;
  for (int n = 0; n < 2000; ++n) {
    const int phase = n % 100;
    const double slope = phase < 10 ? 2.8 : phase >= 50 && phase < 60 ? -2.8 : 0.0;  // A per period
    iq += slope;
    const Vector v = {-w * m.lq * iq, m.rs * iq + m.lq * slope / kPeriod + w * m.flux};
    EXPECT_NE(step(s, model, v, {0.0, iq}, bpp(w), 1), EMF_SIGN_REVERSED) << n;
  }
}

}  // namespace
