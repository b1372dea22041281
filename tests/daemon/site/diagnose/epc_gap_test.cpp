#include "daemon/site/diagnose/epc_gap.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "daemon/commands/open_site.hpp"
#include "daemon/site/model/diagnosis_input.hpp"
#include "tests/daemon/depot_year.hpp"
#include "tests/daemon/modelled_readings.hpp"

namespace recald::daemon {
namespace {

using diagnosis::Addition;
using diagnosis::Candidate;
using diagnosis::SiteProblem;
using recald::testing::edited;
using recald::testing::sample_site;
using recald::testing::write_text;

/// The depot with meters that say what the hourly model gives.
class EpcGapTest : public ::testing::Test {
 protected:
  EpcGapTest() {
    // Some heat at all hours: a meter that stands at zero all summer is not believed.
    recald::testing::write_depot_year(
        folder_.path(),
        edited(sample_site(), "efficiency = 0.95", "efficiency = 0.95\nbase_heat_kW = 4"));
    open();
  }

  void open() {
    std::ostringstream ignored;
    auto opened = open_modelled_site(folder_ / "site.toml", Console{ignored, ignored, false},
                                     ModelKind::hourly);
    if (!opened) throw std::runtime_error(ignored.str());
    modelled_ = std::make_unique<ModelledSite>(std::move(*opened));
    auto problem = make_site_problem(modelled_->site.config, modelled_->site.calendar,
                                     modelled_->recording, modelled_->weather);
    if (!problem) throw std::runtime_error(problem.error().message);
    problem_ = std::make_unique<SiteProblem>(std::move(*problem));
  }

  [[nodiscard]] Addition trap_leak(double kW) const {
    for (const Candidate& candidate : diagnosis::list_candidates(*problem_).candidates) {
      if (candidate.key(*problem_) != "steam_trap_leak") continue;
      return {.candidate = candidate,
              .eta = {kW},
              .eta_sd = {0.1},
              .draws = {{kW}},
              .probability = 0.99,
              .evidence_gain = 30.0,
              .monthly_kWh = {},
              .effect_kW = {}};
    }
    throw std::logic_error("the depot has a heat meter");
  }

  /// Writes what the hourly model gives into the readings and opens the site again.
  void heat_with(double leak_kW) {
    const Addition truth = trap_leak(leak_kW);
    const auto effect = diagnosis::alteration_of(truth.candidate, problem_->facts(), truth.eta);
    recald::testing::write_modelled_readings(folder_.path(), *problem_, effect.get());
    open();
  }

  [[nodiscard]] Result<diagnosis::MonthlyVote> gap(std::vector<Addition> added) const {
    return epc_gap(modelled_->site.config, modelled_->site.calendar, modelled_->recording,
                   modelled_->weather, *problem_, added);
  }

  recald::testing::TemporaryFolder folder_;
  std::unique_ptr<ModelledSite> modelled_;
  std::unique_ptr<SiteProblem> problem_;
};

TEST_F(EpcGapTest, AnEffectThatIsThereClosesTheGap) {
  heat_with(3.0);
  const auto found = gap({trap_leak(3.0)});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_EQ(found->gap.model, ModelKind::epc);
  EXPECT_EQ(found->gap.outputs,
            (std::vector<std::string>{"electricity_daily_kWh", "district_heat_daily_kWh"}));
  EXPECT_GE(found->months_shown, 3);
  EXPECT_LT(found->gap.after[1].cvrmse, found->gap.before[1].cvrmse);
  EXPECT_GT(found->gap.after[1].log_score, found->gap.before[1].log_score);
  EXPECT_GT(found->total.sum, 0.0);
  EXPECT_TRUE(found->has_vote());
  EXPECT_TRUE(found->agrees());
  EXPECT_LE(found->gap.change[1].cvrmse.low, found->gap.change[1].cvrmse.high);
  EXPECT_LT(found->gap.change[1].cvrmse.low, 0.0);
}

TEST_F(EpcGapTest, AnEffectThatIsNotThereDoesNot) {
  heat_with(0.0);
  const auto found = gap({trap_leak(3.0)});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_FALSE(found->agrees());
  EXPECT_GT(found->gap.after[1].cvrmse, found->gap.before[1].cvrmse);
}

TEST_F(EpcGapTest, WithoutAdditionsNothingChanges) {
  const auto found = gap({});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_EQ(found->total.sum, 0.0);
  EXPECT_EQ(found->gap.after[1].cvrmse, found->gap.before[1].cvrmse);
  EXPECT_TRUE(std::isnan(found->gap.after[1].discrepancy_share));
}

// Silence is no consent: what has no figure to judge by says so.
TEST_F(EpcGapTest, WithoutFiguresInTheMonthsShownItHasNoVote) {
  for (MeterRecord& record : modelled_->recording.meters) {
    for (std::size_t i = 0; i < problem_->month_roles.size(); ++i) {
      if (problem_->month_roles[i] != diagnosis::Role::show) continue;
      std::erase_if(record.figures, [&](const metering::MonthlyFigure& figure) {
        return figure.month == problem_->drivers->months[i];
      });
    }
  }
  const auto found = gap({trap_leak(3.0)});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_FALSE(found->has_vote());
  EXPECT_TRUE(std::isnan(found->gap.change[1].cvrmse.low));
}

// The hourly model tells its chiller from lights and plugs.
TEST_F(EpcGapTest, ASiteWithAChillerOfItsOwnIsJudgedToo) {
  modelled_->site.config.building->chiller_cop = 3.0;
  const auto found = gap({});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_EQ(found->gap.after[1].cvrmse, found->gap.before[1].cvrmse);
}

TEST_F(EpcGapTest, TooFewMonthsToJudgeByIsExplained) {
  std::ranges::replace(problem_->month_roles, diagnosis::Role::show, diagnosis::Role::fit);
  const auto refused = gap({});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::not_enough_data);
}

}  // namespace
}  // namespace recald::daemon
