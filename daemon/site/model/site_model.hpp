/// The model used to calibrate a site, for any of its months: monthly or hourly, with the effects
/// of the version in force.
#pragma once

#include <memory>
#include <vector>

#include "core/diagnosis/model_effects.hpp"
#include "core/model/epc/prepare.hpp"
#include "core/model/monthly_model.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

[[nodiscard]] bool is_hourly(const SiteConfig& site);

/// What all models of a site share, whatever the months.
struct SiteModelParts {
  std::vector<const model::ParameterDefinition*> definitions;  ///< (q) for θ.
  std::vector<model::MeterMap> maps;                           ///< (m) for the model's outputs.
  model::ElectricLoads loads;
  std::shared_ptr<const diagnosis::ModelEffects> effects;  ///< Null: none.
  std::vector<diagnosis::MonthlyEffect> monthly;  ///< Of `effects`; empty for an hourly model.
};

/// @param months  If there are effects, all of these must be months of the effects' site.
/// @return models of θ, then η, that give daily averages of the meters; an hourly model alternates
///         them with peaks. Or not_enough_data from the weather.
[[nodiscard]] Result<ModelFactory> model_of(const SiteConfig& site, const SiteModelParts& parts,
                                            const std::vector<metering::Month>& months,
                                            const model::epc::Place& place);

}  // namespace recald::daemon
