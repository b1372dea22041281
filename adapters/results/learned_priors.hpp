/// Priors that a portfolio's calibrations teach, from their documents (calibration.json).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/parameter.hpp"

namespace recald::results {

struct LearnedPrior {
  std::string name;
  std::string unit;
  Prior own;                     ///< Of the building, before anything was learned.
  std::optional<Prior> learned;  ///< Within the ends of `own`; absent: nothing was learned.
  int sites;                     ///< Whose calibrations could be used for it.
  int informative;               ///< Of those that said something beyond their priors.
  std::string sentence;          ///< What was learned of what, or why nothing was.
};

/// What the portfolio says of each parameter of one building.
///
/// Used are converged calibrations of `model` with the library's prior of the parameter. One whose
/// prior has a source of its own is left out: it may have been learned here, and would be learned
/// twice. So is one that is neither triangular nor uniform, whose numbers a document does not have.
/// @param documents  Contents of calibration.json, one a site, without the building itself.
/// @param building   Its parameters with the library's priors; decides order, units and scale.
/// @param model      "epc", "hourly", …: as the documents say it. Each model has errors of its own,
///                   and what it learns is good for itself alone.
/// @return one for each parameter of the building. Members that are missing or of another type
///         leave a document out.
[[nodiscard]] std::vector<LearnedPrior> learned_priors(std::span<const nlohmann::json> documents,
                                                       std::span<const Parameter> building,
                                                       std::string_view model);

/// The parameters of one document, with their priors; those without a usable prior are left out.
[[nodiscard]] std::vector<Parameter> parameters_of(const nlohmann::json& document);

/// To paste behind a `[[model]]`: every parameter, because a list of them replaces the default one;
/// `prior` and `source` where something was learned.
/// @param month  Of the source: "2026-11".
[[nodiscard]] std::string site_file_lines(std::span<const LearnedPrior> priors,
                                          std::string_view month);

}  // namespace recald::results
