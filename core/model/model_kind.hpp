/// The kinds of model that can be calibrated: one table for the command line, the site file,
/// results and the code that creates models.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace recald {

enum class ModelKind : std::uint8_t {
  epc,         ///< Monthly quasi-steady state.
  hourly,      ///< Zones hour by hour, with air handlers and plant.
  metamodel,   ///< What another model's runs say.
  energyplus,  ///< A client's EnergyPlus model, through a meta-model of its runs.
};

struct ModelKindFacts {
  ModelKind kind;
  std::string_view name;  ///< In files and on the command line.
  bool is_of_building;    ///< Needs only a site's [building].
  bool has_peaks;         ///< Predicts a month's peak as well as its daily average.
};

inline constexpr auto kModelKinds = std::to_array<ModelKindFacts>({
    {ModelKind::epc, "epc", true, false},
    {ModelKind::hourly, "hourly", true, true},
    {ModelKind::metamodel, "metamodel", false, false},
    {ModelKind::energyplus, "energyplus", false, true},
});

[[nodiscard]] constexpr const ModelKindFacts& facts_of(ModelKind kind) {
  return kModelKinds[static_cast<std::size_t>(kind)];
}

[[nodiscard]] constexpr std::string_view name_of(ModelKind kind) { return facts_of(kind).name; }

/// @return nothing for an unknown name.
[[nodiscard]] constexpr std::optional<ModelKind> find_model_kind(std::string_view name) {
  const auto* const found = std::ranges::find(kModelKinds, name, &ModelKindFacts::name);
  return found == kModelKinds.end() ? std::nullopt : std::optional{found->kind};
}

/// The names of all kinds, or of those that need only a site's building.
[[nodiscard]] inline std::vector<std::string_view> model_kind_names(bool of_building_alone) {
  std::vector<std::string_view> names;
  for (const ModelKindFacts& facts : kModelKinds) {
    if (facts.is_of_building || !of_building_alone) names.push_back(facts.name);
  }
  return names;
}

}  // namespace recald
