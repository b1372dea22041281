// One synthetic case of the seed's size whose density is stated to the last constant and whose
// values at fixed points were computed independently. Skipped where the data is absent.

#include "tests/core/calibration/seedcase.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/calibration/diagnostics.hpp"
#include "core/calibration/draws.hpp"
#include "core/calibration/seed_rwm.hpp"

namespace recald::calibration {
namespace {

using nlohmann::json;

class SeedcaseTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(seedcase_folder() / "metamodel.csv")) {
      GTEST_SKIP() << "no " << seedcase_folder() << "; set RECALD_DATA to the folder of the data";
    }
    seedcase_ = read_seedcase();
  }

  [[nodiscard]] Posterior posterior(const HyperPrior& prior, double peak_weight = 1.0) const {
    PosteriorData data = seedcase_.data;
    data.weights[1] = peak_weight;
    return Posterior::make(*seedcase_.model, seedcase_.parameters, data, prior).value();
  }

  Seedcase seedcase_;
};

const HyperPrior kScaled{"scaled", {10.0, 0.0084}, {10.0, 0.00084}, {1.0, 0.3}};
const HyperPrior kWide{"wide", {10.0, 0.3}, {10.0, 0.03}, {1.0, 0.3}};

Hyperparameters hyper_of(const json& point) {
  Hyperparameters hyper{point["lambda_delta"], point["lambda_eps"], Eigen::VectorXd(5)};
  for (Eigen::Index s = 0; s < 5; ++s) {
    hyper.beta(s) = -4.0 * std::log(point["rho"][static_cast<std::size_t>(s)].get<double>());
  }
  return hyper;
}

void expect_close(double actual, const json& expected) {
  EXPECT_NEAR(actual, expected.get<double>(),
              1e-9 * std::max(1.0, std::abs(expected.get<double>())));
}

TEST_F(SeedcaseTest, LogDensityAndItsPartsAtFixedPoints) {
  for (const HyperPrior& prior : {kScaled, kWide}) {
    const auto file =
        json::parse(std::ifstream(seedcase_folder() / ("logpost_points_" + prior.name + ".json")));
    Posterior p = posterior(prior);
    ASSERT_EQ(p.point_count(), 48);
    ASSERT_EQ(file["points"].size(), 8u);
    for (const json& point : file["points"]) {
      SCOPED_TRACE(prior.name + " " + point.dump());
      const auto theta = point["t"].get<std::vector<double>>();
      const LogDensityTerms terms = p.terms(theta, hyper_of(point)).value();
      expect_close(terms.log_likelihood, point["loglik"]);
      expect_close(terms.theta, point["triangular"]);
      expect_close(terms.discrepancy_precision, point["gamma_delta"]);
      expect_close(terms.error_precision, point["gamma_eps"]);
      expect_close(terms.rho, point["beta_rho"]);
      expect_close(terms.sum(), point["logpost"]);
    }
    EXPECT_EQ(p.jitter_count(), 0);
  }
}

TEST_F(SeedcaseTest, PooledVarianceOfTheDesign) {
  EXPECT_NEAR(seedcase_.pooled_variance, 0.02786, 5e-6);
}

// A vanishing weight of the peaks leaves the likelihood of the daily values plus a constant.
TEST_F(SeedcaseTest, AVanishingWeightRemovesThePeaks) {
  Posterior both = posterior(kScaled, 1e-8);
  PosteriorData daily = seedcase_.data;
  daily.points.resize(24);
  daily.values = daily.values.head(24).eval();
  daily.extra_variances = daily.extra_variances.head(24).eval();
  daily.common_errors.resize(24, 0);
  Posterior alone = Posterior::make(*seedcase_.model, seedcase_.parameters, daily, kScaled).value();
  Rng rng(1);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXd theta(6);
    Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(5)};
    both.to_natural(both.draw_start(rng), theta, hyper);
    ASSERT_TRUE(both.set_hyperparameters(hyper));
    const double with = both.log_likelihood({theta.data(), 6}).value();
    hyper.beta.conservativeResize(4);
    ASSERT_TRUE(alone.set_hyperparameters(hyper));
    const double difference = with - alone.log_likelihood({theta.data(), 6}).value();
    low = std::min(low, difference);
    high = std::max(high, difference);
  }
  EXPECT_LT(high - low, 1e-5);
}

// The long-run reference (Stan's NUTS, 100 000 draws) within four combined standard errors.
TEST_F(SeedcaseTest, RandomWalkReproducesTheReferencePosterior) {
  const Posterior prototype = posterior(kScaled);
  std::vector<ChainDraws> chains;
  for (std::uint64_t k = 0; k < 4; ++k) {
    Posterior p(prototype);
    Rng rng(2026, k);
    chains.push_back(to_natural_units(seed_rwm(p, {}, rng).value(), p));
  }
  auto summaries = summarise_parameters(seedcase_.parameters, chains, for_each_index_serially);
  const auto hyper = summarise_hyperparameters(
      kScaled, hyperparameter_names({"drybulb", "rh", "winddir", "windspeed"}, true), chains,
      for_each_index_serially);
  summaries.insert(summaries.end(), hyper.begin(), hyper.end());
  const auto reference =
      json::parse(std::ifstream(seedcase_folder() / "reference_posterior_scaled.json"));
  for (const Summary& s : summaries) {
    SCOPED_TRACE(s.name);
    const json& r = reference["parameters"][s.name];
    const double mcse = std::hypot(s.mcse, r["mcse_mean"].get<double>());
    std::printf(
        "%-16s mean %10.5g (reference %10.5g, %+.1f se)  sd %9.4g (%9.4g)  R-hat %.4f  ESS %5.0f "
        "%5.0f\n",
        s.name.c_str(), s.mean, r["mean"].get<double>(), (s.mean - r["mean"].get<double>()) / mcse,
        s.sd, r["sd"].get<double>(), s.rhat, s.ess_bulk, s.ess_tail);
    EXPECT_NEAR(s.mean, r["mean"].get<double>(), 4.0 * mcse);
  }
}

}  // namespace
}  // namespace recald::calibration
