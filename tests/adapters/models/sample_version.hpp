/// A version with two effects that uses every field and every kind of prior.
#pragma once

#include "core/diagnosis/model_version.hpp"

namespace recald::testing {

inline diagnosis::AddedEffect night_setback() {
  using std::chrono::year;
  return {.effect = "night_setback_missing",
          .title = "Night set-back missing",
          .meter = "",
          .from = {},
          .to = {},
          .physics = "theta_set,unocc = theta_set,occ - (1 - f) dT  [K]",
          .parameters = {{.name = "share",
                          .unit = "-",
                          .prior = UniformPrior{0.0, 1.0},
                          .mean = 0.8,
                          .sd = 0.1,
                          .q05 = 0.65,
                          .q50 = 0.81,
                          .q95 = 0.95,
                          .draws = {0.7, 1.0 / 3.0, 0.9}},
                         {.name = "slope",
                          .unit = "K/h",
                          .prior = LogNormalPrior{2.0, 0.5},
                          .mean = 2.1,
                          .sd = 0.4,
                          .q05 = 1.5,
                          .q50 = 2.0,
                          .q95 = 2.9,
                          .draws = {2.0, 2.1, 1e-300}}},
          .log_evidence_gain = 14.26,
          .probability = 0.93,
          .rivals = {{"damper_stuck_open", 0.05}, {"none", 0.02}},
          .impacts = {{"electricity", 310.0}, {"district_heat", 5200.5}},
          .months_used = {year{2020} / 11, year{2020} / 12, year{2021} / 1}};
}

inline diagnosis::AddedEffect heat_meter_scale() {
  using std::chrono::year;
  return {.effect = "meter_scale",
          .title = "Meter's factor wrong",
          .meter = "district_heat",
          .from = year{2020} / 12 / 5,
          .to = year{2021} / 1 / 20,
          .physics = "y = k y_true, k [-]",
          .parameters = {{.name = "factor",
                          .unit = "-",
                          .prior = TruncatedNormalPrior{1.0, 0.2, 0.0},
                          .mean = 1.1,
                          .sd = 0.01,
                          .q05 = 1.08,
                          .q50 = 1.1,
                          .q95 = 1.12,
                          .draws = {1.1}},
                         {.name = "day",
                          .unit = "d",
                          .prior = Prior{0.0, 100.0, 365.0},
                          .mean = 120.0,
                          .sd = 2.0,
                          .q05 = 117.0,
                          .q50 = 120.0,
                          .q95 = 123.0,
                          .draws = {120.5}}},
          .log_evidence_gain = 6.5,
          .probability = 0.85,
          .months_used = {year{2020} / 12}};
}

/// @param parent  As `ModelStore::save` takes it.
inline diagnosis::ModelVersion sample_version(std::string parent,
                                              std::vector<diagnosis::AddedEffect> effects,
                                              std::string created_at = "2021-03-01T05:00:00Z") {
  return {.version = "",
          .parent = std::move(parent),
          .site_id = "depot",
          .created_at = std::move(created_at),
          .author = diagnosis::VersionAuthor::automatic,
          .status = diagnosis::VersionStatus::proposed,
          .data_revision = "0123456789abcdef",
          .catalogue_version = "0.1.0",
          .effects = std::move(effects)};
}

}  // namespace recald::testing
