/// The building in which an effect is shown: one that has what it needs, in weather that
/// makes it visible.
#pragma once

#include <string>

#include "simulators/scenario/archetypes.hpp"
#include "simulators/scenario/scenario.hpp"

namespace recald::simulators {

inline constexpr std::uint64_t kShowSeed = 1;
inline constexpr int kShowYear = 2022;

enum class ShowBuilding : std::size_t {
  office,  ///< Mixed climate, all services from the district; used unless another fits better.
  office_with_chiller,
  office_with_heat_pump,
  office_with_boiler,
  office_with_skylight,
  office_in_cold,
  office_in_hot_dry,
  office_in_hot_humid,
  office_in_marine,
  laboratory,
  school,
  shop,
  hotel,
  clinic,
  warehouse,
  restaurant,
  gym,
};
inline constexpr std::size_t kShowBuildings = 17;

[[nodiscard]] ShowBuilding show_building_of(const EffectKind& kind);

/// One year of 15-minute steps, nothing hidden.
[[nodiscard]] Scenario show_scenario(ShowBuilding building);

/// Typical strength, with dates and a meter if the kind needs them.
[[nodiscard]] HiddenChoice show_choice(const EffectKind& kind);

/// "Office, 7200 m², mixed climate, district cooling, district hot water, 2022".
[[nodiscard]] std::string describe_scenario(const Scenario& scenario);

}  // namespace recald::simulators
