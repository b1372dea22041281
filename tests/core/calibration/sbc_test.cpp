// A short simulation-based calibration of both ways; the full one is a long study.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/core/calibration/sbc_cases.hpp"

namespace recald::calibration::sbc_test {
namespace {

/// Every quantity's ranks even, every interval's coverage within four binomial standard errors:
/// three would be passed by chance in one of a dozen such families of intervals.
void expect_calibrated(const SbcResult& result) {
  EXPECT_EQ(result.failed, 0);
  const double n = result.replicates;
  double worst = 1.0;
  for (const SbcQuantity& quantity : result.quantities) {
    SCOPED_TRACE(quantity.name);
    worst = std::min(worst, quantity.p_value());
    // One in a thousand for the family of all quantities.
    EXPECT_GT(quantity.p_value(), 1e-3 / static_cast<double>(result.quantities.size()));
    for (std::size_t level = 0; level < kSbcLevels.size(); ++level) {
      const double p = kSbcLevels[level];
      EXPECT_NEAR(quantity.inside[level], p * n, 4.0 * std::sqrt(n * p * (1.0 - p)))
          << "of " << n << " at " << p;
    }
  }
  std::printf("smallest p %.3f, smallest ESS %.0f, unconverged %d, replaced %d of %d\n", worst,
              result.smallest_ess, result.unconverged, result.replaced, result.replicates);
}

SamplingOptions short_chains(std::string_view sampler, int iterations, int burn_in) {
  SamplingOptions options;
  options.sampler = find_sampler(sampler).value();
  options.iterations = iterations;
  options.burn_in = burn_in;
  options.doublings_max = 0;
  options.chains = 2;
  options.gate = {.rhat_max = 1.05, .ess_min = 100.0, .mcse_share_max = 0.2};
  return options;
}

TEST(SimulationBasedCalibration, OfTheMetamodelPath) {
  OwnedSbcCase c = metamodel_case(2, 12, 2, /*gaps=*/false);
  c.sbc.sampling = short_chains("nuts", 500, 150);
  c.sbc.draws = 39;
  expect_calibrated(run_sbc(c.sbc, 240, 1, for_each_index_serially));
}

TEST(SimulationBasedCalibration, OfTheMetamodelPathWithGaps) {
  OwnedSbcCase c = metamodel_case(2, 10, 1, /*gaps=*/true);
  c.sbc.sampling = short_chains("nuts", 500, 150);
  c.sbc.draws = 39;
  expect_calibrated(run_sbc(c.sbc, 200, 1001, for_each_index_serially));
}

TEST(SimulationBasedCalibration, OfTheEpcPath) {
  OwnedSbcCase c = epc_case(6, 1);
  c.sbc.sampling = short_chains("dram", 4000, 1000);
  c.sbc.draws = 39;
  expect_calibrated(run_sbc(c.sbc, 40, 2001, for_each_index_serially));
}

TEST(SimulationBasedCalibration, OfTheDefault) {
  OwnedSbcCase c = emulated_epc_case(12, 1, /*data_from_model=*/false);
  c.sbc.sampling = short_chains("nuts", 500, 150);
  c.sbc.draws = 39;
  expect_calibrated(run_sbc(c.sbc, 100, 3001, for_each_index_serially));
}

// The test of the tests: a likelihood that believes in twice the noise there is makes intervals too
// wide, and the ranks have to say so.
TEST(SimulationBasedCalibration, SeesAPosteriorThatIsTooWide) {
  OwnedSbcCase c = metamodel_case(1, 12, 1, /*gaps=*/false);
  c.sbc.sampling = short_chains("nuts", 300, 100);
  SbcResult result;
  result.quantities = {{.name = "p1"}};
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SbcReplicate replicate = run_replicate(c.sbc, seed);
    const double mean = replicate.draws.col(0).mean();
    replicate.draws.col(0) = mean + 2.0 * (replicate.draws.col(0).array() - mean);
    count_replicate(replicate, result);
  }
  EXPECT_LT(result.quantities[0].p_value(), 1e-3);
}

}  // namespace
}  // namespace recald::calibration::sbc_test
