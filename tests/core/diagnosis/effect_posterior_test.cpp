#include "core/diagnosis/effect_posterior.hpp"

#include <gtest/gtest.h>

namespace recald::diagnosis {
namespace {

// As R's quantile(c(4, 1, 3, 2), c(0.05, 0.5, 0.95)), which is type 7 as in calibration.json.
TEST(EffectPosterior, HasTheQuantilesOfACalibration) {
  const Prior prior = Prior::make(UniformPrior{0.0, 10.0}).value();
  const Addition addition{.candidate = {.parameters = {{"power", "kW", prior, 0.0}}},
                          .eta = {2.0},
                          .eta_sd = {1.0},
                          .draws = {{4.0}, {1.0}, {3.0}, {2.0}},
                          .probability = 0.9,
                          .evidence_gain = 5.0};
  const ParameterPosterior posterior = posterior_of(addition).at(0);
  EXPECT_DOUBLE_EQ(posterior.q05, 1.15);
  EXPECT_DOUBLE_EQ(posterior.q50, 2.5);
  EXPECT_DOUBLE_EQ(posterior.q95, 3.85);
  EXPECT_EQ(posterior.mode, 2.0);
}

}  // namespace
}  // namespace recald::diagnosis
