#include "daemon/site/diagnose/proposed_version.hpp"

#include <gtest/gtest.h>

namespace recald::daemon {
namespace {

bool may(std::vector<diagnosis::AddedEffect> effects) {
  diagnosis::ModelVersion version;
  version.effects = std::move(effects);
  return may_apply_itself(version);
}

diagnosis::AddedEffect added(const char* effect, double probability) {
  return {.effect = effect, .log_evidence_gain = 20.0, .probability = probability};
}

TEST(ProposedVersion, AppliesItselfOnlyForSureFaultsOfMetersAndSchedules) {
  EXPECT_TRUE(may({added("scale_fault", 0.95)}));
  EXPECT_TRUE(may({added("scale_fault", 0.97), added("weekend_operation", 0.99)}));
  EXPECT_FALSE(may({added("weekend_operation", 0.94)}));
  EXPECT_FALSE(may({added("economiser_failed", 0.99)}));  // somebody should look at a building
  EXPECT_FALSE(may({added("scale_fault", 0.99), added("economiser_failed", 0.99)}));
  EXPECT_FALSE(may({added("of a later version", 0.99)}));
  EXPECT_FALSE(may({}));
}

}  // namespace
}  // namespace recald::daemon
