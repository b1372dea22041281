/// The model that a site is calibrated with, of any of its months: monthly or hourly, with the
/// effects of the version in force.
#pragma once

#include <memory>
#include <vector>

#include "core/model/epc/prepare.hpp"
#include "core/model/monthly_model.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/model/model_effects.hpp"

namespace recald::daemon {

[[nodiscard]] bool is_hourly(const SiteConfig& site);

/// What all models of a site have in common, whatever the months.
struct SiteModelParts {
  std::vector<const model::ParameterDefinition*> definitions;  ///< (q) of θ.
  std::vector<model::MeterMap> maps;                           ///< (m) of the model's outputs.
  model::ElectricLoads loads;
  std::shared_ptr<const ModelEffects> effects;    ///< Null: none.
  std::vector<diagnosis::MonthlyEffect> monthly;  ///< Of `effects`; empty for an hourly model.
};

/// @param months  All of them among those of the effects' site, where there are effects.
/// @return models of θ, then η: daily averages of the meters, and their peaks in turn with them
///         where the model is hourly; not_enough_data from the weather.
[[nodiscard]] Result<ModelFactory> model_of(const SiteConfig& site, const SiteModelParts& parts,
                                            const std::vector<metering::Month>& months,
                                            const model::epc::Place& place);

}  // namespace recald::daemon
