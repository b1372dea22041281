#include "core/design/model_runs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "tests/support/in_threads.hpp"

namespace recald::design::model_runs_test {
namespace {

using ::testing::HasSubstr;

/// Output k in month i is theta_k + i, NaN in the last month when theta_0 exceeds `limit`.
class StepModel final : public MonthlyModel {
 public:
  explicit StepModel(double limit) : limit_(limit) {}
  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<StepModel>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 2; }
  [[nodiscard]] int output_count() const override { return 2; }
  [[nodiscard]] int month_count() const override { return 3; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    for (std::size_t i = 0; i < 6; ++i) outputs[i] = theta[i / 3] + static_cast<double>(i % 3);
    if (theta[0] > limit_) outputs[5] = std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double limit_;
};

std::vector<Parameter> parameters() {
  return {{"a", "kW", {0.0, 50.0, 100.0}}, {"b", "K", {-100.0, -50.0, 0.0}}};
}

Eigen::MatrixXd rows(int count) {
  Eigen::MatrixXd theta(count, 2);
  for (int i = 0; i < count; ++i) theta.row(i) << i, -i;
  return theta;
}

TEST(ModelRuns, EachRowIsTheModelThere) {
  for (const int count : {0, 1, 5, 100}) {
    for (const ForEachIndex& executor :
         {ForEachIndex(for_each_index_serially), ForEachIndex(recald::testing::in_threads)}) {
      const auto outputs = run_model(StepModel(1e9), parameters(), rows(count), executor, {});
      ASSERT_TRUE(outputs.has_value());
      ASSERT_EQ(outputs->rows(), count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const auto x = static_cast<double>(i);
        Eigen::RowVectorXd expected(6);
        expected << x, x + 1, x + 2, -x, -x + 1, -x + 2;
        EXPECT_EQ(outputs->row(i), expected);
      }
    }
  }
}

TEST(ModelRuns, AValueThatIsNotFiniteNamesItsPlaceAndItsParameters) {
  const auto outputs =
      run_model(StepModel(41.0), parameters(), rows(100), for_each_index_serially, {});
  ASSERT_FALSE(outputs.has_value());
  EXPECT_EQ(outputs.error().code, ErrorCode::not_finite);
  EXPECT_THAT(outputs.error().message, HasSubstr("output 2, month 3"));
  EXPECT_THAT(outputs.error().message, HasSubstr("at a = 42 kW, b = -42 K"));
}

TEST(ModelRuns, StopsWhenToldAtAnyRun) {
  for (int stop_at = 1; stop_at <= 30; ++stop_at) {
    int calls = 0;
    const auto outputs = run_model(StepModel(1e9), parameters(), rows(30), for_each_index_serially,
                                   [&](int done, int total) {
                                     EXPECT_EQ(done, ++calls);
                                     EXPECT_EQ(total, 30);
                                     return calls < stop_at;
                                   });
    ASSERT_FALSE(outputs.has_value());
    EXPECT_EQ(outputs.error().code, ErrorCode::cancelled);
    EXPECT_EQ(calls, stop_at) << "nothing runs after the stop";
  }
}

}  // namespace
}  // namespace recald::design::model_runs_test
