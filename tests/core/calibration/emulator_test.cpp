#include "core/calibration/posterior/emulator.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/design/latin_hypercube.hpp"
#include "core/design/model_runs.hpp"
#include "core/random/rng.hpp"

namespace recald::calibration::emulator_test {
namespace {

/// Two outputs of two months: the first is a polynomial of second degree, the second bends more.
class Bent final : public MonthlyModel {
 public:
  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<Bent>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 2; }
  [[nodiscard]] int output_count() const override { return 2; }
  [[nodiscard]] int month_count() const override { return 2; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    outputs[0] = 3.0 + 2.0 * theta[0] - theta[1] + 0.5 * theta[0] * theta[1];
    outputs[1] = 40.0 - theta[0] * theta[0];
    outputs[2] = 100.0 * std::exp(0.4 * theta[0]);
    outputs[3] = 100.0 / (1.0 + 0.1 * theta[1]);
  }
};

const std::vector<Parameter> kParameters{{"flow", "m3/s", {1.0, 2.0, 4.0}},
                                         {"people", "-", {0.0, 5.0, 8.0}}};

Eigen::MatrixXd runs(int count, std::uint64_t seed) {
  Rng rng{seed, 0};
  return design::latin_hypercube(kParameters, count, rng);
}

Result<Emulator> emulate_bent(const Eigen::MatrixXd& theta) {
  return emulate(theta, *design::run_model(Bent{}, kParameters, theta, for_each_index_serially, {}),
                 2, 2);
}

TEST(Emulator, IsExactWhereTheModelIsAPolynomial) {
  auto made = emulate_bent(runs(60, 1));
  ASSERT_TRUE(made.has_value()) << made.error().message;
  std::vector<double> outputs(4);
  made->model.evaluate(std::vector{1.5, 3.0}, outputs);
  EXPECT_NEAR(outputs[0], 3.0 + 3.0 - 3.0 + 2.25, 1e-9);
  EXPECT_NEAR(outputs[1], 40.0 - 2.25, 1e-9);
  EXPECT_LT(made->error_sd(0), 1e-9);
  EXPECT_LT(made->error_sd(1), 1e-9);
}

// What it says of its own error is what fresh runs find.
TEST(Emulator, KnowsItsError) {
  auto made = emulate_bent(runs(100, 1));
  ASSERT_TRUE(made.has_value());
  const Eigen::MatrixXd fresh = runs(400, 2);
  const auto truth = design::run_model(Bent{}, kParameters, fresh, for_each_index_serially, {});
  const auto said = design::run_model(made->model, kParameters, fresh, for_each_index_serially, {});
  for (const Eigen::Index row : {2, 3}) {
    const double found = std::sqrt((*said - *truth).col(row).squaredNorm() / 400.0);
    EXPECT_GT(made->error_sd(row), 0.0);
    EXPECT_NEAR(found / made->error_sd(row), 1.0, 0.3) << row;
  }
}

TEST(Emulator, NeedsRuns) {
  const auto made = emulate_bent(runs(11, 1));
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, ErrorCode::not_enough_data);
  EXPECT_THAT(made.error().message, ::testing::HasSubstr("6 coefficients"));
}

}  // namespace
}  // namespace recald::calibration::emulator_test
