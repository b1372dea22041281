/// Exports of the same meters, one after the other: a portal gives a year at a time.
#pragma once

#include <vector>

#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

/// Puts exports together that are read the same way, have the same meters, and follow each other in
/// time. What two have in common, a day at the seam, does not keep them apart.
/// @param exports  In any order.
/// @return in the order of their earliest files' places in the list, each with its files in order
///         of time.
[[nodiscard]] std::vector<SurveyedExport> joined_exports(std::vector<SurveyedExport> exports);

}  // namespace recald::daemon
