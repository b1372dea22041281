/// What was once said of a month stays as it was said.
#include <gmock/gmock.h>

#include <array>
#include <limits>

#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::sqlite::forecast_table_test {
namespace {

using std::chrono::sys_days;
using std::chrono::year;
using ::testing::SizeIs;

StoredForecast january(double mean, double measured) {
  return {.output = "main_daily_kWh",
          .month = year{2026} / std::chrono::January,
          .model_version = "epc-1",
          .data_revision = "abc",
          .made = sys_days{year{2026} / 2 / 2},
          .mean = mean,
          .sd = 5.0,
          .q05 = mean - 8.0,
          .q50 = mean,
          .q95 = mean + 8.0,
          .measured = measured,
          .pit = 0.25,
          .standardised = -0.67,
          .log_score = -2.5,
          .crps = 1.5};
}

class ForecastTable : public ::testing::Test {
 protected:
  std::vector<StoredForecast> after(const StoredForecast& one) {
    const auto added = store_.add_forecasts(std::array{one});
    EXPECT_TRUE(added.has_value()) << added.error().message;
    return store_.forecasts().value();
  }

  recald::testing::TemporaryFolder folder_;
  SqliteStore store_ = SqliteStore::open(folder_ / "site.db").value();
};

TEST_F(ForecastTable, EveryPartIsKept) {
  const auto kept = after(january(100.0, 97.0));
  ASSERT_THAT(kept, SizeIs(1));
  EXPECT_EQ(kept[0].output, "main_daily_kWh");
  EXPECT_EQ(kept[0].month, year{2026} / std::chrono::January);
  EXPECT_EQ(kept[0].revision, 0);
  EXPECT_EQ(kept[0].model_version, "epc-1");
  EXPECT_EQ(kept[0].data_revision, "abc");
  EXPECT_EQ(kept[0].made, sys_days{year{2026} / 2 / 2});
  EXPECT_EQ(kept[0].mean, 100.0);
  EXPECT_EQ(kept[0].sd, 5.0);
  EXPECT_EQ(kept[0].q05, 92.0);
  EXPECT_EQ(kept[0].q50, 100.0);
  EXPECT_EQ(kept[0].q95, 108.0);
  EXPECT_EQ(kept[0].measured, 97.0);
  EXPECT_EQ(kept[0].pit, 0.25);
  EXPECT_EQ(kept[0].standardised, -0.67);
  EXPECT_EQ(kept[0].log_score, -2.5);
  EXPECT_EQ(kept[0].crps, 1.5);
}

TEST_F(ForecastTable, WhatIsNoNumberIsLeftOutAndStopsNothing) {
  StoredForecast broken = january(100.0, 97.0);
  broken.log_score = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(store_.add_forecasts(std::array{broken, january(99.0, 96.0)}));
  const auto kept = store_.forecasts().value();
  ASSERT_THAT(kept, SizeIs(1));
  EXPECT_EQ(kept[0].mean, 99.0);
}

TEST_F(ForecastTable, WhatWasSaidIsNotSaidAgainOtherwise) {
  after(january(100.0, 97.0));
  const auto kept = after(january(98.0, 97.0));  // wiser after the event
  ASSERT_THAT(kept, SizeIs(1));
  EXPECT_EQ(kept[0].mean, 100.0);
}

TEST_F(ForecastTable, LateDataAndAnotherModelAddRevisions) {
  after(january(100.0, 97.0));
  after(january(99.0, 103.0));
  StoredForecast other = january(101.0, 103.0);
  other.model_version = "epc-2";
  const auto kept = after(other);
  ASSERT_THAT(kept, SizeIs(3));
  EXPECT_EQ(kept[0].mean, 100.0);
  EXPECT_EQ(kept[1].revision, 1);
  EXPECT_EQ(kept[1].measured, 103.0);
  EXPECT_EQ(kept[2].revision, 2);
  EXPECT_EQ(kept[2].model_version, "epc-2");
}

}  // namespace
}  // namespace recald::sqlite::forecast_table_test
