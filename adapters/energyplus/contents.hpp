/// What a model reports and what in it could be varied: the content of `recald engine show`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/energyplus/known_parameters.hpp"
#include "adapters/energyplus/model/model_document.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

/// A meter of energy that the model has.
struct ReportedMeter {
  std::string name;                 ///< "InteriorLights:Electricity:Zone:CORE"
  std::string resource;             ///< "Electricity", "EnergyTransfer"
  std::string end_use;              ///< "InteriorLights"; empty: all.
  std::string where;                ///< "Zone:CORE", "Facility"; empty: all.
  std::optional<double> total_kWh;  ///< Over the run, where the run reported this meter.
};

/// Makes a run tell which meters there are, and give the total of those that matter: call it on
/// what `prepare_objects` left. A run of a day is enough for the names.
void ask_for_meters(Json& objects);

/// @param folder  Of a finished run that was asked.
/// @return the meters: of the whole building first, then end uses and their parts, then what
/// belongs to
///         a part of the building; not_found: the run did not tell; as `read_meters`.
[[nodiscard]] Result<std::vector<ReportedMeter>> what_is_reported(
    const std::filesystem::path& folder);

/// A number that objects of a type have.
struct VariableField {
  std::string pattern;  ///< "Lights/*/watts_per_floor_area"
  std::size_t objects;  ///< How many have the number; others may be autosized.
  double smallest;
  double largest;
};

/// The numbers of loads, constructions, and plant; not geometry, schedules, sizing, curves, or how
/// the simulation is done. In the document's order of types.
[[nodiscard]] std::vector<VariableField> what_could_be_varied(const ModelDocument& model);

/// Lines for a site file: the library's name and prior.
[[nodiscard]] std::string paste_lines(const KnownParameter& parameter);

/// Lines for a site file: a factor on the numbers, from 0.9 to 1.1 for want of knowledge.
[[nodiscard]] std::string paste_lines(const VariableField& field);

}  // namespace recald::energyplus
