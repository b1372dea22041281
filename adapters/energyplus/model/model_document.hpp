/// An EnergyPlus model as epJSON, and the places in it that a parameter changes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/change_kind.hpp"
#include "core/result.hpp"

namespace recald::energyplus {

using Json = nlohmann::ordered_json;

/// {"Lights": {"Lights of the core": {"watts_per_floor_area": 10.8, …}, …}, …}
struct ModelDocument {
  Json objects;
  std::string version;  ///< "25.2", of its Version object.
};

/// @return not_found, io_failed; malformed: no JSON, or no epJSON.
[[nodiscard]] Result<ModelDocument> read_epjson(const std::filesystem::path& file);

/// @param name  Stands in messages.
[[nodiscard]] Result<ModelDocument> parse_epjson(std::string_view text, std::string_view name);

using model::ChangeKind;

/// What the change applies to, where the model writes a quantity down in another way.
enum class Sense : std::uint8_t {
  direct,
  reciprocal,  ///< Floor area per person, for people per area.
  complement,  ///< Emissivity of an opaque pane, for reflectance: one is 1 minus the other.
};

/// Where a pattern leads.
struct Target {
  std::string pattern;
  std::vector<Json::json_pointer>
      fields;  ///< Each a number; at least one. Their count is for people.
  Sense sense = Sense::direct;
  double most = std::numeric_limits<double>::infinity();  ///< A field is cut there: absorptances.
};

/// "Lights/*/watts_per_floor_area": a type of object, the names of objects, a field. '*' stands for
/// any text and '?' for one character; letter case does not matter. A field within a list is
/// reached by its place from 0 or by '*', which passes over text beside numbers:
/// "Schedule:Compact/Heating/data/*/field".
/// @return malformed: not such a pattern; not_found: nothing is there, with the nearest name;
///         invalid_value: what is there is no number (an autosized flow).
[[nodiscard]] Result<Target> find_target(const ModelDocument& model, std::string_view pattern);

/// Whatever is where the pattern leads, numbers or not; maybe nothing.
[[nodiscard]] std::vector<Json::json_pointer> find_fields(const Json& objects,
                                                          std::string_view pattern);

/// Changes each field of the target. @pre the target was found in such a document.
void apply(const Target& target, ChangeKind change, double value, Json& objects);

}  // namespace recald::energyplus
