#include "core/diagnosis/naming/signature_null.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/absent.hpp"

namespace recald::diagnosis::signature_null_test {
namespace {

TEST(SignatureMetric, MeasuresByTheCovarianceOfTheNull) {
  SignatureNull null{.spread = Eigen::Vector3d(0.5, 2.0, 1.0),
                     .patterns = Eigen::Vector3d(1.0, -1.0, 0.5),
                     .own = Eigen::Vector3d(0.2, 0.3, 0.4)};
  const SignatureMetric metric(null, Eigen::Vector3d::Zero());
  ASSERT_EQ(metric.count(), 3);
  const Eigen::Vector3d change(0.3, -1.0, 0.7);
  const Eigen::Vector3d in_spreads = change.cwiseQuotient(null.spread);
  const Eigen::Matrix3d covariance =
      null.patterns * null.patterns.transpose() + Eigen::Matrix3d(null.own.asDiagonal());
  EXPECT_NEAR(metric.whiten(change).squaredNorm(),
              in_spreads.dot(covariance.inverse() * in_spreads), 1e-12);
}

TEST(SignatureMetric, LeavesOutWhatTheSiteOrTheNullDoesNotKnow) {
  const SignatureNull null{.spread = Eigen::Vector4d(1.0, kAbsent, 1.0, 1.0),
                           .patterns = Eigen::MatrixXd(4, 0),
                           .own = Eigen::Vector4d::Ones()};
  const SignatureMetric metric(null, Eigen::Vector4d(0.0, 0.0, kAbsent, 0.0));
  ASSERT_EQ(metric.count(), 2);
  const Eigen::MatrixXd white = metric.whiten(Eigen::Vector4d(20.0, 5.0, 5.0, kAbsent), 15.0);
  EXPECT_EQ(white, Eigen::Vector2d(15.0, 0.0));  // clipped; no number
}

// A meter that the model gets wrong must not dilute what the others say.
TEST(SignatureMetric, WidensOnlyTheMetersThatTheModelGetsWrong) {
  const SignatureNull null{.spread = Eigen::VectorXd::Constant(6, 2.0),  // two of each meter
                           .patterns = Eigen::MatrixXd(6, 0),
                           .own = Eigen::VectorXd::Ones(6)};
  SignatureMetric metric(null, Eigen::VectorXd::Zero(6));
  Eigen::VectorXd left(6);
  left << 0.5, 0.5, 3.0, 5.0, 1.0, 1.0;
  metric.widen(left);
  const Eigen::VectorXd spreads = metric.in_spreads(Eigen::VectorXd::Constant(6, 2.0), 1e9);
  const double wrong = 1.0 / std::sqrt(0.5 * (9.0 + 25.0));
  Eigen::VectorXd expected(6);
  expected << 1.0, 1.0, wrong, wrong, 1.0, 1.0;  // never narrower
  EXPECT_TRUE(spreads.isApprox(expected, 1e-12)) << spreads.transpose();
}

TEST(SignatureNull, AParameterThatNobodyKnowsHasItsPrior) {
  const SignatureNull null{.centre = {{"base_heat", 0.7}}, .reach = {{"base_heat", 0.1}}};
  EXPECT_EQ(null.centre_of("base_heat"), 0.7);
  EXPECT_EQ(null.reach_of("base_heat"), 0.4);  // at least
  EXPECT_EQ(null.centre_of("else"), 0.0);
  EXPECT_EQ(null.reach_of("else"), 1.0);
}

}  // namespace
}  // namespace recald::diagnosis::signature_null_test
