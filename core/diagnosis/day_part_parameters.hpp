/// Parameters that day parts can inform beyond those that a site lists, and their priors in a
/// diagnosis.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/model/building.hpp"
#include "core/model/parameter.hpp"
#include "core/model/prior.hpp"

namespace recald::diagnosis {

/// Names of those that such a building has.
[[nodiscard]] std::vector<std::string_view> day_part_parameters(const model::Building& nominal);

/// Where drawings may be wrong by a factor the prior is log-normal about them, wider than the
/// library's range: a diagnosis must not mistake a wrong number in the site file for an effect.
/// @return nothing where the library's prior will do, or the drawings say 0.
[[nodiscard]] std::optional<Prior> wide_prior(std::string_view name,
                                              const model::Building& nominal);

/// (parameters) scores. Where the middle of the priors leads astray: rooms that are cool at night
/// either have closets or little mass, and from the one no small step leads to the other.
[[nodiscard]] Eigen::VectorXd second_start_of(std::span<const Parameter> parameters);

}  // namespace recald::diagnosis
