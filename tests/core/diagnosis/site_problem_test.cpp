#include "core/diagnosis/site_problem.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::site_problem_test {
namespace {

TEST(SiteProblem, WithoutShownMonthsHasNoReadingsInThem) {
  constexpr std::array kFree{"occupancy_density"};
  const SiteProblem site = testing::sample_problem(kFree, 12);
  const SiteProblem masked = without_shown_months(site);
  int shown = 0;
  for (std::size_t i = 0; i < site.roles.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const DayPart& part = site.day_parts.parts[i];
    const bool is_shown = site.roles[i] == Role::show;
    shown += is_shown ? 1 : 0;
    EXPECT_EQ(masked.measured_parts_kW.row(row).isNaN().all(), is_shown);
    EXPECT_EQ(masked.measured_kW.middleRows(part.first_hour, part.hours).isNaN().any(), is_shown);
  }
  EXPECT_GT(shown, 0);
}

}  // namespace
}  // namespace recald::diagnosis::site_problem_test
