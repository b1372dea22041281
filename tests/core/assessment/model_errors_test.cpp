#include "core/assessment/model_errors.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace recald::assessment::model_errors_test {
namespace {

/// Two outputs of three months, linear in the first parameter and curved in the second.
class Sloped final : public MonthlyModel {
 public:
  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<Sloped>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 2; }
  [[nodiscard]] int output_count() const override { return 2; }
  [[nodiscard]] int month_count() const override { return 3; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto month = static_cast<double>(i);
      outputs[i] = 100.0 + (1.0 + month) * theta[0];
      outputs[3 + i] = 50.0 + 2.0 * theta[1] * theta[1];
    }
  }
};

const std::vector<Parameter> kParameters{{"flow", "m3/s", {1.0, 2.0, 3.0}},
                                         {"people", "-", {0.0, 3.0, 6.0}}};
constexpr std::array kServices{Service::cooling, Service::heating};

// sd of a symmetric triangle of half width w is w / sqrt(6).
TEST(ModelErrors, AreSlopesBySpreadsAndFactorsOnEachMeter) {
  Sloped model;
  const ModelErrorSizes sizes{.parameter_share = 0.5, .cooling_level = 0.1, .heating_level = 0.2};
  const auto errors =
      model_errors(model, kParameters, spreads_of(kParameters, sizes), kServices, sizes);
  ASSERT_EQ(errors.size(), 4u);
  const double flow_sd = 1.0 / std::sqrt(6.0);
  EXPECT_NEAR(errors[0](0), 0.5 * flow_sd, 1e-9);
  EXPECT_NEAR(errors[0](2), 0.5 * 3.0 * flow_sd, 1e-9);
  EXPECT_NEAR(errors[0](3), 0.0, 1e-9);
  const double people_sd = 3.0 / std::sqrt(6.0);
  EXPECT_NEAR(errors[1](4), 0.5 * 4.0 * 3.0 * people_sd, 1e-9);
  EXPECT_NEAR(errors[2](1), 0.1 * 104.0, 1e-9);
  EXPECT_EQ(errors[2](4), 0.0);
  EXPECT_NEAR(errors[3](5), 0.2 * 68.0, 1e-9);
}

TEST(ModelErrors, ThereAreNoneOfSizeZero) {
  Sloped model;
  EXPECT_TRUE(model_errors(model, kParameters, std::vector{0.0, 0.0}, kServices, {}).empty());
}

TEST(LeadingMonths, AreTheFirstOfEachOutput) {
  const Eigen::VectorXd error = Eigen::VectorXd::LinSpaced(6, 1.0, 6.0);
  const Eigen::VectorXd leading = leading_months(error, 3, 2);
  EXPECT_EQ(leading, (Eigen::VectorXd(4) << 1.0, 2.0, 4.0, 5.0).finished());
}

}  // namespace
}  // namespace recald::assessment::model_errors_test
