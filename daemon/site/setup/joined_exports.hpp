/// Exports of the same meters, one after the other: a portal gives a year at a time.
#pragma once

#include <vector>

#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

/// Puts exports together that are read the same way and have the same meters: one after the other
/// in time, or over times that several have, where most values are the same. What differs there was
/// corrected by the later file.
/// @param exports  In any order.
/// @return in the order of their earliest files' places in the list, each with its files in order
///         of their ends: where several have an interval, the last one counts.
[[nodiscard]] std::vector<SurveyedExport> joined_exports(std::vector<SurveyedExport> exports);

}  // namespace recald::daemon
