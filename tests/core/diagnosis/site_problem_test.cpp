#include "core/diagnosis/evidence/site_problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

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

/// Mean modelled minus measured electricity of the day parts that count, by kind of day and part.
double largest_mean_gap_kW(const SiteProblem& site, const Eigen::ArrayXXd& parts_kW) {
  std::array<std::array<double, 6>, model::kDayTypes> sums{};
  std::array<std::array<int, 6>, model::kDayTypes> counts{};
  for (std::size_t i = 0; i < site.roles.size(); ++i) {
    if (site.roles[i] == Role::show) continue;
    const DayPart& part = site.day_parts.parts[i];
    const auto row = static_cast<Eigen::Index>(i);
    const auto day = static_cast<std::size_t>(part.day);
    const auto of = static_cast<std::size_t>(part.part);
    sums[day][of] += part.hours * (parts_kW(row, 0) - site.measured_parts_kW(row, 0));
    counts[day][of] += part.hours;
  }
  double largest = 0.0;
  for (std::size_t day = 0; day < model::kDayTypes; ++day) {
    for (std::size_t of = 0; of < 6; ++of) {
      largest = std::max(largest, std::abs(sums[day][of] / counts[day][of]));
    }
  }
  return largest;
}

class Profile : public ::testing::Test {
 protected:
  Profile() {
    const auto candidates = list_candidates(site_).candidates;
    weekends_ = *std::ranges::find_if(candidates, [](const Candidate& c) {
      return c.effect->id == "weekend_operation" && !c.begins;
    });
  }
  [[nodiscard]] std::unique_ptr<model::hourly::Alteration> weekends(double share) const {
    return alteration_of(weekends_, site_.facts(), std::vector{share, share});
  }

  SiteProblem site_ = testing::sample_problem(kFree, 14);
  Candidate weekends_;

 private:
  static constexpr std::array kFree{"cooling_setpoint"};
};

// Fans that ran on weekends are among lights and plugs, until the model knows them.
TEST_F(Profile, IsReadWithThePlantOfTheRun) {
  Predictor predictor{site_};
  const std::vector theta{24.0};
  const Eigen::ArrayXXd with_kW = predictor.parts_kW(theta, weekends(1.0).get());
  const Eigen::ArrayXXd with_hours_kW = predictor.hours_kW();
  const Eigen::ArrayXXd without_kW = predictor.parts_kW(theta);
  EXPECT_LT(largest_mean_gap_kW(site_, with_kW), 1e-9);
  EXPECT_LT(largest_mean_gap_kW(site_, without_kW), 1e-9);
  // Chilled water and steam are as they are.
  Eigen::ArrayXXd plain = with_kW;
  site_.day_parts.average_into(with_hours_kW, plain);
  EXPECT_TRUE((plain.rightCols(2) == with_kW.rightCols(2)).all());
  EXPECT_GT(largest_mean_gap_kW(site_, plain), 1.0);
}

TEST_F(Profile, DoesNotReadMonthsOfTheFinalCheck) {
  const std::vector theta{24.0};
  const Eigen::ArrayXXd was = Predictor{site_}.parts_kW(theta);
  for (std::size_t i = 0; i < site_.roles.size(); ++i) {
    const DayPart& part = site_.day_parts.parts[i];
    if (site_.roles[i] == Role::show) {
      site_.measured_kW.middleRows(part.first_hour, part.hours) += 50.0;
    }
  }
  EXPECT_TRUE((Predictor{site_}.parts_kW(theta) == was).all());
}

// Lights and plugs end at zero, however much the plant is said to use.
TEST_F(Profile, HasNothingNegative) {
  site_.measured_kW.col(0) *= 1e-6;
  Predictor predictor{site_};
  const Eigen::ArrayXXd& parts_kW = predictor.parts_kW(std::vector{24.0});
  EXPECT_GT(parts_kW.col(0).minCoeff(), -1e-9);
  EXPECT_GT(parts_kW.col(0).maxCoeff(), 1.0) << "fans and pumps stay";
}

TEST_F(Profile, StaysWhereAnEffectIsToldFromNone) {
  Predictor predictor{site_};
  const std::vector theta{24.0};
  const Eigen::ArrayXXd change_kW = predictor.change_kW(theta, *weekends(1.0));
  double weekend_kWh = 0.0;
  for (Eigen::Index i = 0; i < change_kW.rows(); ++i) {
    const DayPart& part = site_.day_parts.parts[static_cast<std::size_t>(i)];
    if (part.day != model::DayType::workday) weekend_kWh += part.hours * change_kW(i, 0);
  }
  EXPECT_GT(weekend_kWh, 100.0);
}

}  // namespace
}  // namespace recald::diagnosis::site_problem_test
