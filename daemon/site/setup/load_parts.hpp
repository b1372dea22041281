/// Which rows or columns of an export are parts of one load: tariffs, phases.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

struct FoundLoad {
  std::vector<std::size_t> parts;  ///< Two or more meters.
  std::string name;                ///< Of the load, as the parts have it in common.
  std::string because;
};

/// Meters whose names differ in a tariff or a phase alone, and whose readings agree: of two tariffs
/// no more than one has energy in an interval, unless they are registers, and the phases are all
/// there. Parts whose sum is a meter too are no load of their own. Import and export never are one.
[[nodiscard]] std::vector<FoundLoad> find_loads(std::span<const SurveyedMeter> meters);

/// Puts the parts of a load together as one meter, in the place of the first.
void join_loads(std::span<const FoundLoad> loads, std::vector<SurveyedMeter>& meters);

}  // namespace recald::daemon
