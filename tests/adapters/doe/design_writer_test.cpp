#include "adapters/doe/design_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/temporary_folder.hpp"

namespace recald::doe {
namespace {

using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;

DesignMonth month(const char* text) { return *DesignMonth::parse(text); }

/// Two parameters, four runs, two months and one that validates.
DesignPlan sample_plan() {
  DesignPlan plan;
  plan.parameters = {{"t_cool", "degC", Prior(20.0, 24.0, 28.0)},
                     {"people", "person/m2", Prior(LogNormalPrior{0.05, 0.5})}};
  plan.theta.resize(4, 2);
  plan.theta << 21.0, 0.1, 22.0, 1.0 / 30.0, 23.0, 0.03, 24.0, 0.02;
  plan.output_names = {"heat_daily_kWh", "power_daily_kWh"};
  plan.months = {month("2021-01"), month("2021-02")};
  plan.inputs.months = {month("2021-01"), month("2021-02"), month("2021-03")};
  plan.inputs.names = {"drybulb"};
  plan.inputs.values.resize(3, 1);
  plan.inputs.values << 1.0, 3.5, 9.0;
  plan.measurements.months = plan.inputs.months;
  plan.measurements.names = plan.output_names;
  plan.measurements.values.resize(3, 2);
  plan.measurements.values << 400.0, 100.0, 390.5, std::numeric_limits<double>::quiet_NaN(), 300.0,
      90.0;
  plan.fingerprint = "abc";
  return plan;
}

Eigen::RowVectorXd run_of(const DesignPlan& plan, Eigen::Index i) {
  const double t = plan.theta(i, 0);
  const double p = plan.theta(i, 1);
  Eigen::RowVectorXd outputs(4);
  outputs << t / 3.0, t + 1.0, p / 7.0, p + 1.0;
  return outputs;
}

void run(const DesignPlan& plan, Eigen::Index i, DesignRunsSoFar& runs) {
  runs.outputs.row(i) = run_of(plan, i);
  runs.done[static_cast<std::size_t>(i)] = true;
}

TEST(DesignWriter, ANewDesignIsReadBackToTheLastBit) {
  const TemporaryFolder folder;
  const DesignPlan plan = sample_plan();
  auto runs = open_design(folder / "new/design", plan);
  ASSERT_TRUE(runs) << runs.error().message;
  EXPECT_EQ(runs->done_count(), 0);
  for (Eigen::Index i = 0; i < 4; ++i) run(plan, i, *runs);
  ASSERT_TRUE(write_outputs(folder / "new/design", plan, *runs));

  const auto design = read_design_folder(folder / "new/design");
  ASSERT_TRUE(design) << design.error().message;
  EXPECT_EQ(design->theta, plan.theta);
  EXPECT_EQ(design->outputs, runs->outputs);
  EXPECT_EQ(design->parameters[1].prior, plan.parameters[1].prior);
  EXPECT_EQ(design->inputs.values, plan.inputs.values);
  EXPECT_THAT(design->notes, ::testing::IsEmpty());
  const auto measured = read_measurements(folder / "new/design/measurements.csv", *design);
  ASSERT_TRUE(measured) << measured.error().message;
  EXPECT_EQ(measured->table.values(1, 0), 390.5);
  EXPECT_TRUE(std::isnan(measured->table.values(1, 1)));
  EXPECT_EQ(measured->table.values(2, 1), 90.0);
}

TEST(DesignWriter, TakesUpWhereItStoppedAndEndsWithTheSameBytes) {
  const TemporaryFolder folder;
  const DesignPlan plan = sample_plan();
  auto runs = open_design(folder / "once", plan);
  ASSERT_TRUE(runs);
  for (Eigen::Index i = 0; i < 4; ++i) run(plan, i, *runs);
  ASSERT_TRUE(write_outputs(folder / "once", plan, *runs));

  auto first = open_design(folder / "twice", plan);
  ASSERT_TRUE(first);
  run(plan, 0, *first);
  run(plan, 2, *first);
  ASSERT_TRUE(write_outputs(folder / "twice", plan, *first));
  auto second = open_design(folder / "twice", plan);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->done, (std::vector<bool>{true, false, true, false}));
  EXPECT_EQ(second->outputs.row(2), run_of(plan, 2));
  run(plan, 1, *second);
  run(plan, 3, *second);
  ASSERT_TRUE(write_outputs(folder / "twice", plan, *second));
  for (const char* file : {"priors.csv", "doe_inputs.csv", "doe_outputs.csv", "inputs.csv",
                           "measurements.csv", "design.json"}) {
    EXPECT_EQ(read_text(folder / "once" / file), read_text(folder / "twice" / file)) << file;
  }
}

TEST(DesignWriter, ARunThatTheFileLostIsRunAgain) {
  const TemporaryFolder folder;
  const DesignPlan plan = sample_plan();
  auto runs = open_design(folder.path(), plan);
  run(plan, 0, *runs);
  run(plan, 1, *runs);
  ASSERT_TRUE(write_outputs(folder.path(), plan, *runs));
  std::string text = read_text(folder / "doe_outputs.csv");
  text.erase(text.rfind('\n', text.size() - 2) + 1);  // the last row: half of run 2
  write_text(folder / "doe_outputs.csv", text);
  const auto again = open_design(folder.path(), plan);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->done, (std::vector<bool>{true, false, false, false}));
}

class OtherDesign : public ::testing::Test {
 protected:
  OtherDesign() { EXPECT_TRUE(open_design(folder_.path(), sample_plan())); }

  std::string refusal(const DesignPlan& plan) {
    const std::string before = read_text(folder_ / "priors.csv");
    const auto runs = open_design(folder_.path(), plan);
    if (runs) return "accepted";
    EXPECT_EQ(runs.error().code, ErrorCode::invalid_value);
    EXPECT_EQ(read_text(folder_ / "priors.csv"), before);  // left alone
    std::string message = runs.error().message;
    const std::string path = folder_.path().string();
    return message.replace(message.find(path), path.size(), "DIR");
  }

  TemporaryFolder folder_;
};

TEST_F(OtherDesign, IsRefusedWithWhatDiffers) {
  DesignPlan plan = sample_plan();
  plan.parameters[0].prior = Prior(20.0, 25.0, 28.0);
  EXPECT_EQ(
      refusal(plan),
      "'DIR' holds a design that was made for other priors; delete it, or give another --out");
  plan = sample_plan();
  plan.theta(3, 1) += 1e-12;
  EXPECT_EQ(refusal(plan),
            "'DIR' holds a design that has other runs: by another seed or number, by --priors or "
            "--corners, or by another version; delete it, or "
            "give another --out");
  plan = sample_plan();
  plan.fingerprint = "abd";
  EXPECT_EQ(refusal(plan),
            "'DIR' holds a design that was made from another site file, other readings or weather, "
            "or by another version; delete it, or give another --out");
  std::filesystem::remove(folder_ / "design.json");
  EXPECT_EQ(refusal(sample_plan()),
            "'DIR' holds a design that was not made by recald doe; delete it, or give another "
            "--out");
}

TEST_F(OtherDesign, OutputsOfAnotherDesignAreRefused) {
  const auto fault = [&](const char* text) {
    write_text(folder_ / "doe_outputs.csv", text);
    const auto runs = open_design(folder_.path(), sample_plan());
    return runs ? std::string{"accepted"} : runs.error().message;
  };
  EXPECT_THAT(fault("run,month,heat_daily_kWh\n"),
              ::testing::EndsWith("doe_outputs.csv':1: the columns are not those of this design"));
  const std::string head = "run,month,heat_daily_kWh,power_daily_kWh\n";
  EXPECT_THAT(fault((head + "9,2021-01,1,2\n").c_str()),
              ::testing::EndsWith("doe_outputs.csv':2: this is no run of this design; delete the "
                                  "file to run all of them again"));
  EXPECT_THAT(fault((head + "1,2021-02,1,2\n").c_str()), ::testing::HasSubstr("no run of this"));
}

}  // namespace
}  // namespace recald::doe
