/// Parameters that day parts can inform in addition to those that a site lists, and their
/// priors in a diagnosis.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/model/building.hpp"
#include "core/model/parameter.hpp"
#include "core/model/prior.hpp"

namespace recald::diagnosis {

/// Names of those that apply to this building.
[[nodiscard]] std::vector<std::string_view> day_part_parameters(const model::Building& nominal);

/// If drawings may be wrong by a factor, the prior is log-normal around their value and wider
/// than the library's range, because a diagnosis must not mistake a wrong number in the site
/// file for an effect.
/// @return nothing if the library's prior is sufficient, if the building cannot have it, or if the
///         drawings say 0 and mean it.
[[nodiscard]] std::optional<Prior> wide_prior(std::string_view name,
                                              const model::Building& nominal);

}  // namespace recald::diagnosis
