#include "core/calibration/samplers/samplers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/calibration/posterior/diagnostics.hpp"
#include "tests/core/calibration/chain_checks.hpp"
#include "tests/core/calibration/sampling_targets.hpp"

namespace recald::calibration {
namespace {

using ::testing::HasSubstr;

TEST(Samplers, AllAreFoundByTheirNames) {
  std::set<std::string_view> names;
  for (const Sampler& sampler : samplers()) {
    names.insert(sampler.name);
    EXPECT_EQ(find_sampler(sampler.name).value(), &sampler);
  }
  EXPECT_EQ(names, (std::set<std::string_view>{"nuts", "dram", "smc", "seed_rwm"}));
}

TEST(Samplers, AnUnknownNameIsExplained) {
  const auto unknown = find_sampler("nutz");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().code, ErrorCode::not_found);
  EXPECT_EQ(unknown.error().message,
            "there is no sampler 'nutz'; choose nuts, dram, smc or seed_rwm; did you mean nuts?");
  EXPECT_THAT(find_sampler("gibbs-within-slice").error().message, Not(HasSubstr("did you mean")));
}

// The defaults are chosen for a posterior of thirteen dimensions: four chains pass the gate. The
// seed's own numbers are kept as they are and need not.
TEST(Samplers, DefaultsPassTheGate) {
  for (const Sampler& sampler : samplers()) {
    SCOPED_TRACE(sampler.name);
    SkewNormal target(13);
    const auto chains = run_chains(sampler.run, target, sampler.defaults, 101);
    EXPECT_EQ(chains.front().statistics.gradient_evaluations > 0, sampler.uses_gradient);
    EXPECT_EQ(std::isfinite(chains.front().statistics.log_evidence), sampler.is_population);
    EXPECT_EQ(sampler.defaults.burn_in == 0, sampler.is_population);
    if (sampler.name == "seed_rwm") continue;
    for (Eigen::Index j = 0; j < 13; ++j) {
      const Diagnostics d = diagnose(coordinate(chains, j));
      EXPECT_LE(d.rhat, 1.01) << j;
      EXPECT_GE(d.ess_bulk, 400.0) << j;
      EXPECT_GE(d.ess_tail, 400.0) << j;
    }
  }
}

}  // namespace
}  // namespace recald::calibration
