#include "core/diagnosis/naming/expected_changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::expected_changes_test {
namespace {

constexpr std::array kFree{"occupancy_density", "outdoor_airflow", "heating_setpoint"};

/// A year whose building differs from its drawings in two parameters.
class FittedSite : public ::testing::Test {
 protected:
  FittedSite() {
    const std::array truth{1.4 * site_.nominal.use.occupancy_person_m2,
                           0.7 * site_.nominal.air->outdoor_air_m3_s,
                           site_.nominal.set_points.heating_occupied_C};
    predictor_.parts_kW(truth);
    site_.measured_kW = predictor_.hours_kW();
  }

  SiteProblem site_ = testing::sample_problem(kFree, 12);
  Predictor predictor_{site_};
};

TEST_F(FittedSite, FindsTheBuildingThatWasMeasured) {
  const SignatureReader reader(site_);
  const SignatureFit fit = fit_signatures(site_, reader, predictor_);
  ASSERT_EQ(fit.theta.size(), 3u);
  // The priors hold back a little.
  EXPECT_NEAR(fit.theta[0], 1.4 * site_.nominal.use.occupancy_person_m2,
              0.2 * site_.nominal.use.occupancy_person_m2);
  EXPECT_NEAR(fit.theta[1], 0.7 * site_.nominal.air->outdoor_air_m3_s,
              0.1 * site_.nominal.air->outdoor_air_m3_s);
  EXPECT_NEAR(fit.theta[2], site_.nominal.set_points.heating_occupied_C, 0.2);
  double before = 0.0;
  double after = 0.0;
  for (Eigen::Index i = 0; i < fit.measured.size(); ++i) {
    if (!std::isfinite(fit.measured[i] - fit.nominal[i] - fit.fitted[i])) continue;
    before += std::pow(fit.measured[i] - fit.nominal[i], 2);
    after += std::pow(fit.measured[i] - fit.fitted[i], 2);
  }
  EXPECT_LT(after, 0.02 * before);
}

TEST_F(FittedSite, AParametersSlopeIsWhatMovingItDoes) {
  const SignatureReader reader(site_);
  const SignatureFit fit = fit_signatures(site_, reader, predictor_);
  std::vector<double> theta = fit.theta;
  theta[1] *= 1.02;
  predictor_.parts_kW(theta);
  const Eigen::MatrixXd moved = reader.read(predictor_.hours_kW());
  const Eigen::Map<const Eigen::VectorXd> there(moved.data(), moved.size());
  const Eigen::VectorXd change = there - fit.fitted;
  // In the same direction, whatever a score is worth.
  double along = 0.0, slopes = 0.0, changes = 0.0;
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    if (!std::isfinite(change[i])) continue;
    along += change[i] * fit.jacobian(i, 1);
    slopes += std::pow(fit.jacobian(i, 1), 2);
    changes += change[i] * change[i];
  }
  EXPECT_GT(along / std::sqrt(slopes * changes), 0.9);
}

TEST_F(FittedSite, EachCandidateChangesWhatItsRunChanges) {
  const SignatureReader reader(site_);
  const SignatureFit fit = fit_signatures(site_, reader, predictor_);
  const CandidateList list = list_candidates(site_);
  std::map<std::string, int> shapes;
  const int days = site_.drivers->hours.back().day_index + 1;
  int dated = 0;
  expect_changes(site_, reader, fit, list.candidates, predictor_,
                 [&](const ExpectedChange& expected) {
                   ++shapes[expected.candidate->key(site_)];
                   EXPECT_EQ(expected.change.size(), fit.measured.size());
                   if (expected.candidate->begins) {
                     ++dated;
                     EXPECT_GT(expected.from_day, 0);
                   } else {
                     EXPECT_EQ(expected.from_day, 0);
                     EXPECT_EQ(expected.to_day, days);
                   }
                 });
  EXPECT_EQ(shapes.size(), list.candidates.size());
  EXPECT_GT(dated, 20);

  // A run with the effect, read by itself, against what was told without one.
  const auto weekends = std::ranges::find_if(list.candidates, [](const Candidate& candidate) {
    return candidate.effect->id == "weekend_operation";
  });
  ASSERT_NE(weekends, list.candidates.end());
  bool compared = false;
  expect_changes(site_, reader, fit, {*weekends}, predictor_, [&](const ExpectedChange& expected) {
    if (compared) return;
    compared = true;
    const auto alteration = weekends->effect->bind(site_.facts(), expected.values, weekends->meter);
    Predictor other{site_};
    other.parts_kW(fit.theta, alteration.get());
    const Eigen::MatrixXd with = reader.read(other.hours_kW());
    const Eigen::MatrixXd without = reader.read(fit.hours_kW);
    double most = 0.0;
    for (Eigen::Index i = 0; i < with.size(); ++i) {
      const double change = with.data()[i] - without.data()[i];
      if (!std::isfinite(change)) continue;
      EXPECT_NEAR(expected.change[i], change, 1e-9);
      most = std::max(most, std::abs(change));
    }
    EXPECT_GT(most, 0.01);
  });
  EXPECT_TRUE(compared);
}

// One run for all dates, and for what may begin or not.
TEST_F(FittedSite, DatesCostNoRunAndAreThoseOfTheirOwnSpans) {
  const SignatureReader reader(site_);
  const SignatureFit fit = fit_signatures(site_, reader, predictor_);
  std::vector<Candidate> dated;
  for (const Candidate& candidate : list_candidates(site_).candidates) {
    if (candidate.effect->id == "after_hours" || candidate.effect->id == "vacancy") {
      dated.push_back(candidate);
    }
  }
  ASSERT_EQ(dated.size(), 3u) << "late stops from the start or from a date; an empty floor";
  std::vector<ExpectedChange> told;
  const int runs = predictor_.runs();
  expect_changes(site_, reader, fit, dated, predictor_,
                 [&](const ExpectedChange& expected) { told.push_back(expected); });
  EXPECT_EQ(predictor_.runs() - runs, 4) << "three late stops and one empty floor";
  const int days = site_.drivers->hours.back().day_index + 1;
  EXPECT_TRUE(std::ranges::any_of(
      told, [&](const ExpectedChange& expected) { return expected.to_day < days; }));
  SpanReader spans(reader, fit.hours_kW);
  double most = 0.0;
  for (const ExpectedChange& expected : told) {
    const Candidate& candidate = *expected.candidate;
    predictor_.parts_kW(fit.theta,
                        candidate.effect->bind(site_.facts(), expected.values, -1).get());
    spans.take(predictor_.hours_kW());
    const Eigen::MatrixXd change = spans.change(expected.from_day, expected.to_day);
    for (Eigen::Index i = 0; i < change.size(); ++i) {
      if (!std::isfinite(change.data()[i])) continue;
      ASSERT_NEAR(expected.change[i], change.data()[i], 1e-9)
          << candidate.effect->id << " from " << expected.from_day << " to " << expected.to_day;
      most = std::max(most, std::abs(change.data()[i]));
    }
  }
  EXPECT_GT(most, 0.05);
}

}  // namespace
}  // namespace recald::diagnosis::expected_changes_test
