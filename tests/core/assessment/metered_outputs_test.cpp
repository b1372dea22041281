#include "core/assessment/metered_outputs.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::assessment {
namespace {

using metering::Month;
using std::chrono::year;

metering::MonthlyFigure figure_of(Month month, double daily_kWh, bool usable) {
  metering::MonthlyFigure figure{};
  figure.month = month;
  figure.daily_average_kWh = daily_kWh;
  figure.daily_average_variance_kWh2 = 4.0;
  figure.peak = metering::PeakDemand{.kW = 9.0, .start = {}, .could_be_exceeded = false};
  figure.usable = usable;
  return figure;
}

// January is sound, February has too few readings, March counts in another unit, April was never
// read.
TEST(MeteredOutputs, HaveOnlyWhatMayBeCalibratedAgainst) {
  const std::string id = "gas";
  std::vector<Month> months;
  for (unsigned month = 1; month <= 4; ++month) {
    months.emplace_back(year{2019}, std::chrono::month{month});
  }
  const std::vector figures{figure_of(months[0], 100.0, true), figure_of(months[1], 80.0, false),
                            figure_of(months[2], 3000.0, true)};
  const std::vector<metering::LevelChange> changes{{.kind = metering::LevelChangeKind::scale,
                                                    .since = months[2],
                                                    .back_since = {},
                                                    .ratio = 30.0,
                                                    .factor = 30.0,
                                                    .z = 60.0,
                                                    .words = {}}};

  const auto daily = daily_output({id, 3, metering::Utility::steam, figures, changes}, months);
  const auto peak = peak_output({id, 3, metering::Utility::steam, figures, changes}, months);

  EXPECT_EQ(daily.name, "gas_daily_kWh");
  EXPECT_EQ(peak.name, "gas_peak_kW");
  EXPECT_EQ(daily.meter, 3U);
  ASSERT_EQ(daily.measured.size(), 4U);
  EXPECT_EQ(daily.measured[0], 100.0);
  EXPECT_EQ(daily.extra_variances[0], 4.0);
  EXPECT_EQ(peak.measured[0], 9.0);
  EXPECT_EQ(peak.extra_variances[0], 0.0);
  for (std::size_t i = 1; i < 4; ++i) {
    SCOPED_TRACE(i);
    EXPECT_TRUE(std::isnan(daily.measured[i]));
    EXPECT_TRUE(std::isnan(peak.measured[i]));
    EXPECT_EQ(daily.extra_variances[i], 0.0);
  }
}

// A level that changed is the building's own: it stays.
TEST(MeteredOutputs, KeepAMonthOfAnotherLevel) {
  const std::string id = "gas";
  const Month month{year{2019}, std::chrono::January};
  const std::vector figures{figure_of(month, 100.0, true)};
  const std::vector<metering::LevelChange> changes{{.kind = metering::LevelChangeKind::level,
                                                    .since = month,
                                                    .back_since = {},
                                                    .ratio = 1.3,
                                                    .factor = 1.3,
                                                    .z = 5.0,
                                                    .words = {}}};
  EXPECT_EQ(
      daily_output({id, 0, metering::Utility::steam, figures, changes}, {month}).measured.front(),
      100.0);
}

}  // namespace
}  // namespace recald::assessment
