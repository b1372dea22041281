#include "adapters/doe/folder_engine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::doe {
namespace {

using ::testing::HasSubstr;

/// One output, two months: the sum of the parameters, and twice it. Counts its runs.
class CountingEngine final : public Engine {
 public:
  Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& theta, const ForEachIndex&,
                              const Observer&) override {
    runs += static_cast<int>(theta.rows());
    Eigen::MatrixXd outputs(theta.rows(), 2);
    outputs.col(0) = theta.rowwise().sum();
    outputs.col(1) = 2.0 * outputs.col(0);
    return outputs;
  }
  int runs = 0;
};

class FolderEngineTest : public ::testing::Test {
 protected:
  FolderEngineTest() {
    plan_.parameters = {{"a", "-", UniformPrior{0.0, 1.0}}, {"b", "-", UniformPrior{0.0, 1.0}}};
    plan_.theta.resize(45, 2);
    for (Eigen::Index i = 0; i < 45; ++i) plan_.theta.row(i) << 0.01 * double(i), 0.5;
    plan_.output_names = {"steam_daily_kWh"};
    plan_.months = {*DesignMonth::parse("2021-01"), *DesignMonth::parse("2021-02")};
    plan_.inputs = {plan_.months, {"dry_bulb_C"}, Eigen::MatrixXd::Constant(2, 1, 5.0)};
    plan_.measurements = {plan_.months, plan_.output_names, Eigen::MatrixXd::Constant(2, 1, 1.0)};
    plan_.fingerprint = "of a test";
  }
  [[nodiscard]] FolderEngine open(Engine* behind) {
    auto engine = FolderEngine::open(folder_ / "design", plan_, behind);
    if (!engine) throw std::runtime_error(engine.error().message);
    return std::move(*engine);
  }

  recald::testing::TemporaryFolder folder_;
  DesignPlan plan_;
  CountingEngine behind_;
};

TEST_F(FolderEngineTest, RunsWhatIsMissingAndNothingTwice) {
  FolderEngine first = open(&behind_);
  const Eigen::MatrixXd some = plan_.theta.topRows(25);
  ASSERT_TRUE(first.run(some, for_each_index_serially, {}).has_value());
  EXPECT_EQ(behind_.runs, 25);

  FolderEngine again = open(&behind_);
  EXPECT_EQ(again.done_count(), 25);
  const auto all = again.run(plan_.theta, for_each_index_serially, {});
  ASSERT_TRUE(all.has_value()) << all.error().message;
  EXPECT_EQ(behind_.runs, 45);
  CountingEngine reference;
  EXPECT_TRUE(
      all->isApprox(reference.run(plan_.theta, for_each_index_serially, {}).value(), 1e-12));
}

TEST_F(FolderEngineTest, AFolderThatIsWholeNeedsNoEngineBehindIt) {
  ASSERT_TRUE(open(&behind_).run(plan_.theta, for_each_index_serially, {}).has_value());
  FolderEngine alone = open(nullptr);
  const auto rows = alone.run(plan_.theta.bottomRows(2), for_each_index_serially, {});
  ASSERT_TRUE(rows.has_value()) << rows.error().message;
  EXPECT_NEAR((*rows)(1, 1), 2.0 * (0.44 + 0.5), 1e-12);
}

TEST_F(FolderEngineTest, SaysWhichRunsItDoesNotHave) {
  FolderEngine alone = open(nullptr);
  const auto missing = alone.run(plan_.theta, for_each_index_serially, {});
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  const auto other = alone.run(Eigen::MatrixXd::Constant(1, 2, 0.9), for_each_index_serially, {});
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().code, ErrorCode::invalid_value);
  EXPECT_THAT(other.error().message, HasSubstr("a = 0.9"));
}

TEST_F(FolderEngineTest, WhatWasRunBeforeAStopIsKept) {
  FolderEngine stopped = open(&behind_);
  const auto run =
      stopped.run(plan_.theta, for_each_index_serially, [](int done, int) { return done < 20; });
  ASSERT_FALSE(run.has_value());
  EXPECT_EQ(run.error().code, ErrorCode::cancelled);
  EXPECT_EQ(open(nullptr).done_count(), 20);
}

}  // namespace
}  // namespace recald::doe
