#include "adapters/doe/days_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::doe::days_file_test {
namespace {

using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;

metering::Day day(unsigned of_month) {
  return std::chrono::year{2021} / 1 / std::chrono::day{of_month};
}

DesignFolder two_runs(const std::filesystem::path& folder) {
  DesignFolder design;
  design.folder = folder;
  design.runs = {4, 7};
  design.output_names = {"heat_daily_kWh", "heat_peak_kW"};
  return design;
}

/// Three days of two outputs.
DesignDays three_days() {
  DesignDays days{{day(1), day(2), day(5)}, Eigen::MatrixXd(2, 6)};
  days.values << 1.0, 2.0, 3.5, 10.0, 20.0, 30.0, 1e-7, 123456.0, -4.0, 0.0, 0.25, 99.0;
  return days;
}

std::string read_error(const TemporaryFolder& folder, const std::string& text) {
  write_text(folder / "doe_days.csv", text);
  const auto days = read_design_days(two_runs(folder.path()));
  return days ? "" : days.error().message;
}

TEST(DaysFile, IsReadBackToFiveDigits) {
  const TemporaryFolder folder;
  const DesignFolder design = two_runs(folder.path());
  const DesignDays written = three_days();
  ASSERT_TRUE(
      write_design_days(folder.path(), design.runs, design.output_names, written).has_value());
  const auto read = read_design_days(design);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->days, written.days);
  EXPECT_TRUE(read->values.isApprox(written.values, 5e-5)) << read->values;
  EXPECT_EQ(read->values(0, 2), 3.5);
  EXPECT_EQ(read->values(1, 0), 1e-7);
}

TEST(DaysFile, OrderDoesNotMatterAndRunsSetAsideAreSkipped) {
  const TemporaryFolder folder;
  write_text(folder / "doe_days.csv",
             "run,heat_peak_kW,day,heat_daily_kWh\n"
             "7,4,2021-01-02,40\n9,0,2021-01-02,0\n7,3,2021-01-01,30\n"
             "4,2,2021-01-02,20\n4,1,2021-01-01,10\n");
  const auto read = read_design_days(two_runs(folder.path()));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->values, (Eigen::MatrixXd(2, 4) << 10, 20, 1, 2, 30, 40, 3, 4).finished());
}

TEST(DaysFile, SaysWhatIsWrongWithIt) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_design_days(two_runs(folder.path())).error().code, ErrorCode::not_found);
  const std::string head = "run,day,heat_daily_kWh,heat_peak_kW\n";
  EXPECT_THAT(read_error(folder, "run,day,heat_daily_kWh\n"), HasSubstr("'heat_peak_kW'"));
  EXPECT_THAT(read_error(folder, head + "4,2021-02-30,1,1\n"), HasSubstr(":2: '2021-02-30'"));
  EXPECT_THAT(read_error(folder, head + "4,2021-01-01,1,\n"), HasSubstr("is blank"));
  EXPECT_THAT(read_error(folder, head + "4,2021-01-01,1,1\n4,2021-01-01,1,1\n"),
              HasSubstr(":3: run 4 has 2021-01-01 twice"));
  EXPECT_THAT(read_error(folder, head + "4,2021-01-01,1,1\n"),
              HasSubstr("run 7 has 0 days, not the 1 of run 4"));
  EXPECT_THAT(read_error(folder, head + "4,2021-01-01,1,1\n7,2021-01-02,1,1\n"),
              HasSubstr("run 7 has 1 days"));
  EXPECT_THAT(read_error(folder, head), HasSubstr("run 4 has 0 days"));
}

TEST(DaysFile, ACutFileIsRefused) {
  const TemporaryFolder folder;
  const DesignFolder design = two_runs(folder.path());
  ASSERT_TRUE(
      write_design_days(folder.path(), design.runs, design.output_names, three_days()).has_value());
  const std::string whole = read_text(folder / "doe_days.csv");
  for (std::size_t length = 0; length < whole.size(); ++length) {
    SCOPED_TRACE(length);
    EXPECT_NE(read_error(folder, whole.substr(0, length)), "");
  }
}

}  // namespace
}  // namespace recald::doe::days_file_test
