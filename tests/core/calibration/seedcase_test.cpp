// One synthetic case of the seed's size whose density is stated to the last constant and whose
// values at fixed points were computed independently. Skipped where the data is absent.

#include "tests/core/calibration/seedcase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "core/calibration/posterior/diagnostics.hpp"
#include "core/calibration/sampling.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::calibration::seedcase_test {
namespace {

using nlohmann::json;

class SeedcaseTest : public ::testing::Test {
 protected:
  void SetUp() override { seedcase_ = read_seedcase(); }

  [[nodiscard]] Posterior posterior(const HyperPrior& prior, double peak_weight = 1.0) const {
    PosteriorData data = seedcase_.data;
    data.weights[1] = peak_weight;
    return Posterior::make(*seedcase_.model, seedcase_.parameters, data, prior).value();
  }

  Seedcase seedcase_;
};

/// One quantity of the comparison, (draws x chains).
struct Quantity {
  std::string name;
  Eigen::MatrixXd draws;
};

std::vector<Quantity> quantities(const SampledPosterior& sampled) {
  std::vector<Quantity> list;
  const auto add = [&](const std::string& name, const auto& column_of) {
    Eigen::MatrixXd draws(sampled.report.kept, static_cast<Eigen::Index>(sampled.chains.size()));
    for (std::size_t k = 0; k < sampled.chains.size(); ++k) {
      draws.col(static_cast<Eigen::Index>(k)) = column_of(sampled.chains[k]);
    }
    list.push_back({name, draws});
  };
  for (std::size_t j = 0; j < sampled.parameters.size(); ++j) {
    add(sampled.parameters[j].name,
        [&](const ChainDraws& c) { return c.theta.col(static_cast<Eigen::Index>(j)); });
  }
  add("lambda_delta", [](const ChainDraws& c) { return c.discrepancy_precision; });
  add("lambda_eps", [](const ChainDraws& c) { return c.error_precision; });
  for (std::size_t s = 2; s < sampled.hyperparameters.size(); ++s) {
    add(sampled.hyperparameters[s].name,
        [&](const ChainDraws& c) { return c.beta.col(static_cast<Eigen::Index>(s) - 2); });
  }
  return list;
}

/// Half the distance of the quantiles that bracket the p-quantile by one standard error of p
/// (Vehtari et al. 2021, section 4.4).
double quantile_mcse(const Eigen::MatrixXd& draws, double p) {
  Eigen::VectorXd sorted = draws.reshaped();
  std::sort(sorted.begin(), sorted.end());
  const double quantile = quantile_of_sorted(sorted, p);
  const double ess = diagnose((draws.array() <= quantile).cast<double>().matrix()).ess_bulk;
  const boost::math::beta_distribution<> of_p(ess * p + 1.0, ess * (1.0 - p) + 1.0);
  return 0.5 * (quantile_of_sorted(sorted, boost::math::quantile(of_p, 0.8413)) -
                quantile_of_sorted(sorted, boost::math::quantile(of_p, 0.1587)));
}

void compare(const Eigen::MatrixXd& draws, const Diagnostics& d, const json& reference) {
  const auto near = [&](const char* what, double value, double mcse) {
    const double expected = reference[what].get<double>();
    const double of_reference = reference[std::string("mcse_") + what].get<double>();
    EXPECT_NEAR(value, expected, 4.0 * std::hypot(mcse, of_reference)) << what;
  };
  near("mean", draws.mean(), d.mcse);
  const Eigen::MatrixXd squares = (draws.array() - draws.mean()).square();
  const double sd = std::sqrt(squares.mean());
  near("sd", sd, 0.5 * diagnose(squares).mcse / sd);
  Eigen::VectorXd sorted = draws.reshaped();
  std::sort(sorted.begin(), sorted.end());
  near("q05", quantile_of_sorted(sorted, 0.05), quantile_mcse(draws, 0.05));
  near("q50", quantile_of_sorted(sorted, 0.50), quantile_mcse(draws, 0.50));
  near("q95", quantile_of_sorted(sorted, 0.95), quantile_mcse(draws, 0.95));
}

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

// The long-run reference (Stan's NUTS, 100 000 draws): every mean, sd and quantile of all thirteen
// quantities within four combined standard errors.
class ReferencePosterior : public SeedcaseTest,
                           public ::testing::WithParamInterface<std::tuple<const char*, bool>> {};

TEST_P(ReferencePosterior, IsReproduced) {
  const auto [sampler, scaled] = GetParam();
  const HyperPrior& prior = scaled ? kScaled : kWide;
  SamplingOptions options;
  if (*sampler != '\0') options.sampler = find_sampler(sampler).value();
  const auto sampled = sample_posterior(posterior(prior), {"drybulb", "rh", "winddir", "windspeed"},
                                        options, {.seed = 2026});
  ASSERT_TRUE(sampled.has_value()) << sampled.error().message;
  const auto reference = json::parse(
      std::ifstream(seedcase_folder() / ("reference_posterior_" + prior.name + ".json")));
  double least_ess = std::numeric_limits<double>::infinity();
  for (const Quantity& quantity : quantities(*sampled)) {
    SCOPED_TRACE(quantity.name);
    const Diagnostics d = diagnose(quantity.draws);
    least_ess = std::min(least_ess, d.ess_bulk);
    // Four standard errors mean something only where the error is known: below 400 effective draws
    // it is not, and the gate has said so.
    if (d.ess_bulk < 400.0) continue;
    compare(quantity.draws, d, reference["parameters"][quantity.name]);
  }
  std::printf("%-9s %-6s smallest bulk ESS %6.0f of %d, doublings %d, %s\n",
              *sampler ? sampler : "default", prior.name.c_str(), least_ess,
              sampled->report.kept * static_cast<int>(sampled->chains.size()),
              sampled->report.doublings, sampled->converged ? "converged" : "not converged");
  EXPECT_TRUE(sampled->converged);
}

INSTANTIATE_TEST_SUITE_P(
    BySampler, ReferencePosterior,
    ::testing::Combine(::testing::Values("", "nuts", "dram", "smc", "seed_rwm"), ::testing::Bool()),
    [](const auto& given) {
      const std::string name = std::get<0>(given.param);
      return (name.empty() ? "left_to_itself" : name) +
             (std::get<1>(given.param) ? "_scaled" : "_wide");
    });

}  // namespace
}  // namespace recald::calibration::seedcase_test
