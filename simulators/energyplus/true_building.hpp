/// A building as it is: a little different from its drawings in everything, with people whose days
/// differ.
#pragma once

#include <map>
#include <string>

#include "simulators/energyplus/building_year.hpp"

namespace recald::simulators::energyplus {

/// By name: factors on what the drawings say, or kelvins and hours added (`_K`, `_h`).
using TrueParameters = std::map<std::string, double>;

[[nodiscard]] TrueParameters draw_true_parameters(std::uint64_t seed);

/// Makes a year of the drawings a year of the building.
void make_true(BuildingYear& building, const TrueParameters& parameters);

/// How many come, when, and what they leave on, from day to day. The same seed and year give the
/// same days.
void follow_habits(BuildingYear& building, const TrueParameters& parameters, std::uint64_t seed);

}  // namespace recald::simulators::energyplus
