// The inverse inductance tensor from pairs of windows, whichever tensor and whichever vectors: 2 x 2 algebra in double
// precision.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "estimators/inverse_inductance_tensor.h"
}

namespace {

using namespace stillspin::test;

struct Matrix {
  double dd, dq, qd, qq;  // A per V and period
  Vector operator*(Vector v) const { return {dd * v.x + dq * v.y, qd * v.x + qq * v.y}; }
};

// The windows of a machine that has this tensor, as the model leaves them: what it explains itself is taken off.
void add(tensor_sums_t* s, const machine_model_t& m, const Matrix& y, Vector first, Vector second, Vector common) {
  const Matrix left = {y.dd - real(m.yd_q30, 30), y.dq, y.qd, y.qq - real(m.yq_q30, 30)};
  const deviation_t a = {raw_dq(left * first + common, 20), raw_dq(first, 16)};
  const deviation_t b = {raw_dq(left * second + common, 20), raw_dq(second, 16)};
  tensor_add(s, &a, &b);
}

TEST(Tensor, FindsAnyTensorFromAnyPairs) {
  const machine_model_t m = model_of(Motor{});
  Random random(70);
  for (int n = 0; n < 200; ++n) {
    const Matrix y = {random.between(0.01, 0.03), random.between(-0.006, 0.006), random.between(-0.006, 0.006),
                      random.between(0.01, 0.03)};
    tensor_sums_t s;
    tensor_reset(&s);
    // What both windows of a pair have in common (resistance, back-EMF, drops) says nothing.
    for (int k = 0; k < 60; ++k) {
      add(&s, m, y, random.direction(200.0), random.direction(150.0), random.direction(2.0));
    }
    ASSERT_EQ(s.count, 60);
    tensor_axes_t out = {};
    ASSERT_TRUE(tensor_solve(&s, &m, &out)) << n;
    const double difference = y.dd - y.qq, cross = y.dq + y.qd;
    const double half = 0.5 * std::hypot(difference, cross);
    // voltages are rounded to 1/64 V of some 200, residuals to 1e-6 A of some 1
    ASSERT_NEAR(real(out.mean_q30, 30), 0.5 * (y.dd + y.qq), 2e-6) << n;
    ASSERT_NEAR(real(out.half_q30, 30), half, 2e-6) << n;
    ASSERT_NEAR(real(out.across_q30, 30), 0.5 * (y.qd - y.dq), 2e-6) << n;
    const double axis = 0.5 * std::atan2(cross, difference);
    ASSERT_NEAR(wrapped(2.0 * (rad(out.axis_bam) - axis)) * half, 0.0, 4e-6) << n;
  }
}

TEST(Tensor, OneDirectionIsNotEnough) {
  const machine_model_t m = model_of(Motor{});
  const Matrix y = {0.02, 0.001, 0.002, 0.013};
  tensor_axes_t out = {};
  tensor_sums_t s;
  tensor_reset(&s);
  EXPECT_FALSE(tensor_solve(&s, &m, &out));  // no sums at all
  add(&s, m, y, {100.0, 20.0}, {100.0, 20.0}, {0.0, 0.0});
  EXPECT_FALSE(tensor_solve(&s, &m, &out));  // pairs without a difference
  for (int k = 0; k < 10; ++k) add(&s, m, y, {100.0 + k, 0.0}, {-100.0, 0.0}, {0.0, 0.0});
  EXPECT_FALSE(tensor_solve(&s, &m, &out));
  for (int k = 0; k < 10; ++k) add(&s, m, y, {0.0, 100.0}, {0.0, -100.0}, {0.0, 0.0});
  EXPECT_TRUE(tensor_solve(&s, &m, &out));
}

// Evenly spread vectors have a determinant of one, at an angle of 2 a between two directions sin^2: a tenth is 18.4
// degrees.
TEST(Tensor, VectorsMustSpread) {
  const machine_model_t m = model_of(Motor{});
  const Matrix y = {0.02, 0.0, 0.0, 0.013};
  for (const double degrees : {17.9, 18.9}) {
    tensor_sums_t s;
    tensor_reset(&s);
    add(&s, m, y, Vector{150.0, 0.0}, Vector{-150.0, 0.0}, {0.0, 0.0});
    add(&s, m, y, Vector{150.0, 0.0}.turned(degrees * kDegree), Vector{-150.0, 0.0}.turned(degrees * kDegree),
        {0.0, 0.0});
    tensor_axes_t out = {};
    EXPECT_EQ(tensor_solve(&s, &m, &out), degrees > 18.435) << degrees;
  }
}

TEST(Tensor, ResetForgetsEverything) {
  tensor_sums_t s = {1, 2, 3, 4, 5, 6, 7, 8};
  tensor_reset(&s);
  EXPECT_EQ(s.vv_dd | s.vv_dq | s.vv_qq | s.sv_dd | s.sv_dq | s.sv_qd | s.sv_qq, 0);
  EXPECT_EQ(s.count, 0);
}

TEST(Tensor, AdmittanceAndInductance) {
  for (const double mh : {0.1, 1.0, 4.9, 100.0}) {
    EXPECT_NEAR(real(tensor_inductance_q20(raw(0.1 / mh, 30)), 20), mh, mh * 4e-6) << mh;  // 0.1 ms is rounded to Q20
  }
}

}  // namespace
