#include "simulators/footprint/showcase.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace recald::simulators {
namespace {

struct Exhibit {
  std::string_view effect;
  ShowBuilding building;
};

/// Effects that need weather or people that the plain office in the mixed climate does not have.
constexpr std::array kExhibits{
    Exhibit{"cooking", ShowBuilding::office_with_boiler},  // gas
    Exhibit{"deep_drying", ShowBuilding::office_in_hot_humid},
    Exhibit{"ground_coupling", ShowBuilding::office_in_cold},
    Exhibit{"humidifier", ShowBuilding::office_in_cold},
    Exhibit{"irrigation_pumps", ShowBuilding::office_in_hot_dry},
    Exhibit{"night_purge", ShowBuilding::office_in_hot_dry},
    Exhibit{"open_windows", ShowBuilding::office_in_marine},
    Exhibit{"semester_calendar", ShowBuilding::laboratory},
    Exhibit{"snow_melting", ShowBuilding::office_in_cold},
    Exhibit{"stack_infiltration", ShowBuilding::office_in_cold},
    Exhibit{"swimming_pool", ShowBuilding::school},
};

Brief brief_of(ShowBuilding building) {
  switch (building) {
    case ShowBuilding::office:
      return {};
    case ShowBuilding::office_with_chiller:
      return {.cooling = CoolingPlant::chiller};
    case ShowBuilding::office_with_heat_pump:
      return {.heating = HeatingPlant::heat_pump};
    case ShowBuilding::office_with_boiler:
      return {.heating = HeatingPlant::boiler};
    case ShowBuilding::office_with_skylight:
      return {.climate = ClimateKind::cold, .skylight_share = 0.3};
    case ShowBuilding::office_in_cold:
      return {.climate = ClimateKind::cold};
    case ShowBuilding::office_in_hot_dry:
      return {.climate = ClimateKind::hot_dry};
    case ShowBuilding::office_in_hot_humid:
      return {.climate = ClimateKind::hot_humid};
    case ShowBuilding::office_in_marine:
      return {.climate = ClimateKind::marine};
    case ShowBuilding::laboratory:
      return {.use = Use::laboratory};
    case ShowBuilding::school:
      return {.use = Use::school};
    case ShowBuilding::shop:
      return typical_brief(Use::shop);
    case ShowBuilding::hotel:
      return typical_brief(Use::hotel);
    case ShowBuilding::clinic:
      return typical_brief(Use::clinic);
    case ShowBuilding::warehouse:
      return typical_brief(Use::warehouse);
    case ShowBuilding::restaurant:
      return typical_brief(Use::restaurant);
    case ShowBuilding::gym:
      return typical_brief(Use::gym);
  }
  return {};
}

std::string_view heating_in_words(HeatingPlant heating) {
  switch (heating) {
    case HeatingPlant::district_steam:
      return "district steam";
    case HeatingPlant::district_water:
      return "district hot water";
    case HeatingPlant::boiler:
      return "gas boiler";
    case HeatingPlant::heat_pump:
      return "heat pump";
  }
  return "";
}

}  // namespace

ShowBuilding show_building_of(const EffectKind& kind) {
  if (kind.needs.skylight) return ShowBuilding::office_with_skylight;
  if (kind.needs.heat_pump) return ShowBuilding::office_with_heat_pump;
  if (kind.needs.own_chiller) return ShowBuilding::office_with_chiller;
  if (kind.needs.fuel) return ShowBuilding::office_with_boiler;
  if (kind.needs.economiser) return ShowBuilding::office_in_marine;
  const auto exhibit = std::ranges::find(kExhibits, kind.id, &Exhibit::effect);
  return exhibit == kExhibits.end() ? ShowBuilding::office : exhibit->building;
}

Scenario show_scenario(ShowBuilding building) {
  return {.drawings = draw_up(brief_of(building)),
          .period = {.start_year = kShowYear, .years = 1},
          .step = kInterval,
          .care = MeterCare::perfect,
          .effects = {},
          .decoys = {}};
}

HiddenChoice show_choice(const EffectKind& kind) {
  using namespace std::chrono;
  constexpr year shown{kShowYear};
  HiddenChoice choice{&kind, kind.strength.typical, {}, {}, {}};
  if (kind.dated) choice.from = shown / April / 1;
  if (kind.id == "vacancy") {  // people come back
    choice.from = shown / February / 1;
    choice.to = shown / October / 31;
  }
  if (kind.of_one_meter) choice.meter = Utility::electricity;
  return choice;
}

std::string describe_scenario(const Scenario& scenario) {
  const Drawings& drawings = scenario.drawings;
  std::string use(to_string(drawings.use));
  use.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(use.front())));
  return fmt::format("{}, {:.0f} m², {} climate, {}, {}{}, {}", use, drawings.floor_area_m2(),
                     name_of(drawings.climate),
                     drawings.cooling == CoolingPlant::district  ? "district cooling"
                     : drawings.cooling == CoolingPlant::chiller ? "own chiller"
                                                                 : "packaged cooling",
                     heating_in_words(drawings.heating),
                     drawings.skylight_share > 0.0 ? ", skylight" : "", scenario.period.start_year);
}

}  // namespace recald::simulators
