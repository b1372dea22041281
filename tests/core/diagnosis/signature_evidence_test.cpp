#include "core/diagnosis/naming/signature_evidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/absent.hpp"
#include "core/random/rng.hpp"
#include "tests/support/sample_problem.hpp"

namespace recald::diagnosis::signature_evidence_test {
namespace {

constexpr std::array kFree{"occupancy_density", "outdoor_airflow", "heating_setpoint"};

/// Models that err by 2 % of what is there, everywhere by itself.
SignatureNull plain_null() {
  const auto entries = static_cast<Eigen::Index>(signature_names().size() * kSignatureMeters);
  return {.spread = Eigen::VectorXd::Constant(entries, 0.02),
          .patterns = Eigen::MatrixXd(entries, 0),
          .own = Eigen::VectorXd::Ones(entries)};
}

/// A building that differs from its drawings in two parameters, and in what a test adds.
class Evidence : public ::testing::Test {
 protected:
  void measure(const char* effect, const std::vector<double>& values, int meter = -1) {
    std::unique_ptr<model::hourly::Alteration> hidden;
    if (effect != nullptr) hidden = find_effect(effect)->bind(site_.facts(), values, meter);
    predictor_.parts_kW(truth_, hidden.get());
    site_.measured_kW = predictor_.hours_kW();
    Rng rng{11};
    for (double& kW : site_.measured_kW.reshaped()) kW *= 1.0 + 0.05 * rng.normal();
  }

  [[nodiscard]] SignatureEvidence evidence() {
    candidates_ = list_candidates(site_).candidates;
    return evidence_of(site_, candidates_, plain_null(), predictor_);
  }

  SiteProblem site_ = testing::sample_problem(kFree, 12);
  Predictor predictor_{site_};
  const std::vector<double> truth_{1.3 * site_.nominal.use.occupancy_person_m2,
                                   0.8 * site_.nominal.air->outdoor_air_m3_s,
                                   site_.nominal.set_points.heating_occupied_C};
  std::vector<Candidate> candidates_;
};

const EffectEvidence& strongest(const SignatureEvidence& evidence) {
  return *std::ranges::max_element(evidence.effects, {}, &EffectEvidence::log_gain);
}

TEST_F(Evidence, ComesFirstForWhatIsHiddenWithItsSize) {
  const Effect& leak = *find_effect("steam_trap_leak");
  const double typical = leak.parameters(site_.facts())[0].prior.mean();
  measure("steam_trap_leak", {1.5 * typical});
  const SignatureEvidence found = evidence();
  const EffectEvidence& first = strongest(found);
  EXPECT_EQ(first.shape.candidate->effect->id, "steam_trap_leak");
  EXPECT_GT(first.log_gain, 10.0);
  EXPECT_TRUE(first.is_fitted);
  EXPECT_FALSE(first.is_wrong_sign);
  EXPECT_LT(first.misfit, 0.5 * found.misfit);
  ASSERT_FALSE(first.values.empty());
  EXPECT_NEAR(first.values[0], 1.5 * typical, 0.15 * typical);
}

TEST_F(Evidence, SaysByWhichSignaturesAnEffectShows) {
  measure("steam_trap_leak", {30.0});
  const std::vector<EffectSign> signs = strongest(evidence()).signs;
  ASSERT_FALSE(signs.empty());
  EXPECT_LE(signs.size(), 3u);
  std::set<std::string> kinds;
  for (const EffectSign& sign : signs) {
    const std::string& name = signature_names()[sign.signature];
    EXPECT_EQ(sign.meter, SignatureMeter::heat) << name;  // Steam, which is lost all year.
    EXPECT_GT(sign.without, 0.02) << name;
    EXPECT_LT(std::abs(sign.with), 0.5 * sign.without) << name;
    EXPECT_TRUE(kinds.insert(name.substr(0, name.rfind(','))).second) << name;
  }
}

TEST_F(Evidence, IsWeakWhereNothingIsHidden) {
  measure(nullptr, {});
  const SignatureEvidence found = evidence();
  EXPECT_LT(strongest(found).log_gain, 4.0) << strongest(found).shape.candidate->effect->id;
  EXPECT_LT(found.misfit, 1.5 * found.count);
  // The parameters are found: both above or below where the drawings have them.
  EXPECT_GT(found.scores[0], 0.2);
  EXPECT_LT(found.scores[1], -0.2);
}

TEST_F(Evidence, SpeaksOnceOfEachEffectThatMetersCouldShow) {
  measure(nullptr, {});
  const SignatureEvidence found = evidence();
  std::set<std::string_view> ids;
  for (const EffectEvidence& e : found.effects) {
    EXPECT_TRUE(ids.insert(e.shape.candidate->effect->id).second);
    EXPECT_EQ(e.values.size(), e.shape.candidate->parameters.size());
    EXPECT_GT(e.visibility, 0.0);
    if (e.is_fitted) continue;
    EXPECT_LE(e.log_gain, 0.0);
    EXPECT_EQ(e.misfit, found.misfit);
  }
  EXPECT_GT(ids.size(), 20u);
  EXPECT_FALSE(ids.contains("stuck_meter"));
}

TEST_F(Evidence, OfAClockIsFoundThoughItIsNotLinear) {
  measure("clock_offset", {2.0}, 0);
  const EffectEvidence first = strongest(evidence());
  EXPECT_EQ(first.shape.candidate->effect->id, "clock_offset");
  EXPECT_TRUE(first.is_fitted);
}

class Search : public Evidence {
 protected:
  Search() {
    measure("steam_trap_leak", {20.0});
    const Eigen::MatrixXd read = reader_.read(site_.measured_kW);
    measured_ = Eigen::Map<const Eigen::VectorXd>(read.data(), read.size());
  }

  const SignatureReader reader_{site_};
  const SignatureNull null_ = plain_null();
  Eigen::VectorXd measured_;
};

// It stops where another round would gain less than half a nat.
TEST_F(Search, SettlesWhereNoNeighbourCostsMuchLess) {
  SignatureSearch search(site_, reader_, null_, predictor_, measured_, measured_);
  const SignaturePoint start = search.base_at(Eigen::Vector3d(1.5, 1.5, -1.5));
  const SignaturePoint mode = search.settled(start, nullptr);
  EXPECT_LT(mode.cost, start.cost - 1.0);
  for (Eigen::Index j = 0; j < 3; ++j) {
    for (const double step : {-0.4, 0.4}) {
      Eigen::VectorXd scores = search.scores_of(mode);
      scores[j] += step;
      EXPECT_GT(search.base_at(scores).cost, mode.cost - 0.5) << j << ' ' << step;
    }
  }
}

TEST_F(Search, AnEffectIsFittedTogetherWithTheParameters) {
  SignatureSearch search(site_, reader_, null_, predictor_, measured_, measured_);
  const SignaturePoint base = search.settled(search.base_at(Eigen::VectorXd::Zero(3)), nullptr);
  const auto candidates = list_candidates(site_).candidates;
  const auto leak = std::ranges::find(candidates, std::string{"steam_trap_leak"},
                                      [&](const Candidate& c) { return c.key(site_); });
  ASSERT_NE(leak, candidates.end());
  const EffectShape shape{.candidate = &*leak, .values = {5.0}};
  ASSERT_TRUE(shape.has_amount());
  const Eigen::VectorXd change = search.metric().whiten(
      search.modelled((Eigen::VectorXd(4) << base.at, 0.0).finished(), &shape) -
      search.modelled(base.at, nullptr));
  const SignaturePoint both = search.settled(search.with_effect(base, shape, 1.0, change), &shape);
  EXPECT_LT(both.cost, base.cost - 10.0);
  EXPECT_NEAR(shape.with_factor(std::exp(both.at[3]))[0], 20.0, 2.0);
  EXPECT_LT(search.log_narrowing(both), 0.0);  // the data say more of it than the prior
  EXPECT_EQ(search.log_narrowing(base), 0.0);
}

TEST_F(Search, WeighsDataAgainstPriorsByHowWellTheyFit) {
  SignatureSearch search(site_, reader_, null_, predictor_, measured_, measured_);
  SignaturePoint point = search.base_at(Eigen::VectorXd::Zero(3));
  const double step = 1e-4 * point.misfit;
  // The weight is twice the slope of the cost by the squared residual.
  EXPECT_NEAR(search.log_ratio(point.misfit + step, point.misfit) / step,
              0.5 * search.weight_of(point), 1e-3 * search.weight_of(point));
  const double loose = search.weight_of(point);
  point.misfit *= 4.0;
  EXPECT_LT(search.weight_of(point), loose);
}

}  // namespace
}  // namespace recald::diagnosis::signature_evidence_test
