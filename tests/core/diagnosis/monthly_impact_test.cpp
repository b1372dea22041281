#include "core/diagnosis/evidence/monthly_impact.hpp"

#include <gtest/gtest.h>

#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::monthly_impact_test {
namespace {

// Ten kW from the first of March on, for sixty days, in a year of data: a month of it is a month of
// ten kW and not a sixth of that.
TEST(MonthlyImpact, OfADatedEffectIsOverItsMonthsOnly) {
  constexpr std::array kParameters{"outdoor_airflow"};
  const SiteProblem site = testing::sample_problem(kParameters, 12);
  Eigen::ArrayXXd effect_kW = Eigen::ArrayXXd::Zero(site.day_parts.count(), 3);
  for (Eigen::Index i = 0; i < effect_kW.rows(); ++i) {
    const double day = site.day_parts.parts[static_cast<std::size_t>(i)].time_h / 24.0;
    if (day >= 59.0 && day < 119.0) effect_kW(i, 1) = 10.0;
  }
  constexpr double kMonth_h = 8760.0 / 12.0;
  Candidate candidate{};
  const auto undated = monthly_impact_kWh(site, candidate, {}, effect_kW);
  EXPECT_NEAR(undated[1], 10.0 * 60.0 * 24.0 / 12.0, 20.0);
  candidate.begins = candidate.ends = true;
  const std::vector<double> dates{59.0, 119.0};
  const auto dated = monthly_impact_kWh(site, candidate, dates, effect_kW);
  EXPECT_EQ(dated[0], 0.0);
  EXPECT_NEAR(dated[1], 10.0 * kMonth_h, 20.0);
}

}  // namespace
}  // namespace recald::diagnosis::monthly_impact_test
