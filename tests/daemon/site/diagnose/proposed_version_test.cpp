#include "daemon/site/diagnose/proposed_version.hpp"

#include <gtest/gtest.h>

namespace recald::daemon {
namespace {

bool may(std::vector<diagnosis::AddedEffect> effects,
         const models::VersionList& known = {.active = std::string{diagnosis::kBaseVersion}}) {
  diagnosis::ModelVersion version;
  version.effects = std::move(effects);
  return may_apply_itself(version, known);
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

// What somebody took back stays so until somebody puts it in force again.
TEST(ProposedVersion, DoesNotUndoWhatSomebodyTookBack) {
  models::VersionList known{.active = std::string{diagnosis::kBaseVersion}};
  diagnosis::ModelVersion before;
  before.effects = {added("scale_fault", 0.96)};
  before.status = diagnosis::VersionStatus::reverted;
  known.versions = {before};
  EXPECT_FALSE(may({added("scale_fault", 0.99)}, known));
  EXPECT_TRUE(may({added("weekend_operation", 0.99)}, known));
  known.active = "4f2a";  // changed while the diagnosis ran
  EXPECT_FALSE(may({added("weekend_operation", 0.99)}, known));
}

}  // namespace
}  // namespace recald::daemon
