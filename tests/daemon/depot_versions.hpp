/// Model versions of the depot, as if a diagnosis had found what its drawings lack.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "adapters/models/model_store.hpp"

namespace recald::testing {

/// Known from these months to lie between 0.6 and 0.8.
inline diagnosis::AddedEffect half_missing_setback(std::vector<metering::Month> months_used) {
  diagnosis::EffectParameterRecord share{.name = "missing_share",
                                         .unit = "share of the set-back",
                                         .prior = UniformPrior{0.0, 1.0},
                                         .mean = 0.7,
                                         .sd = 0.06,
                                         .q05 = 0.61,
                                         .q50 = 0.7,
                                         .q95 = 0.79,
                                         .draws = {}};
  for (int i = 0; i < 60; ++i) share.draws.push_back(0.6 + 0.2 * ((i * 37) % 60 + 0.5) / 60.0);
  return {.effect = "night_setback_missing",
          .title = "Night set-back missing",
          .meter = "",
          .from = {},
          .to = {},
          .physics = "",
          .parameters = {share},
          .log_evidence_gain = 20.0,
          .probability = 0.97,
          .rivals = {},
          .impacts = {},
          .months_used = std::move(months_used)};
}

/// @return the version's name. @pre the site's id is "depot"
inline std::string put_in_force(const diagnosis::AddedEffect& effect,
                                const std::filesystem::path& site) {
  const models::ModelStore store{site, "depot"};
  const auto saved = store.save({.version = "",
                                 .parent = "drawings",
                                 .site_id = "depot",
                                 .created_at = "2022-01-03T05:00:00Z",
                                 .data_revision = "0123456789abcdef",
                                 .catalogue_version = "0.1.0",
                                 .effects = {effect}});
  EXPECT_TRUE(saved.has_value()) << saved.error().message;
  EXPECT_TRUE(store.activate(saved->version, "2022-01-04T00:00:00Z").has_value());
  return saved->version;
}

}  // namespace recald::testing
