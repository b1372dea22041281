#include "simulators/scenario/archetypes.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "simulators/climate/normals.hpp"
#include "simulators/scenario/rooms_by_use.hpp"
#include "simulators/scenario/sizing.hpp"

namespace recald::simulators {
namespace {

struct Constructions {
  double wall_u_W_m2K, roof_u_W_m2K, window_u_W_m2K, ground_u_W_m2K, shgc;
  std::optional<double> economiser_limit_C;
};

/// As codes of the 2000s require; economisers where ASHRAE 90.1 requires them.
Constructions constructions_for(ClimateKind climate) {
  switch (climate) {
    case ClimateKind::hot_humid:
      return {0.50, 0.30, 2.6, 0.40, 0.30, std::nullopt};
    case ClimateKind::hot_dry:
      return {0.50, 0.28, 2.6, 0.40, 0.28, 24.0};
    case ClimateKind::mixed:
      return {0.42, 0.26, 2.2, 0.35, 0.38, 18.0};
    case ClimateKind::cold:
      return {0.34, 0.20, 1.9, 0.30, 0.42, 21.0};
    case ClimateKind::marine:
      return {0.40, 0.24, 2.1, 0.35, 0.40, 24.0};
  }
  return {};
}

void place_in(Drawings& drawings, ClimateKind climate) {
  const City& city = comparable_city(climate);
  const double mean_C = annual_mean(normals_of(climate).dry_bulb_C);
  const Constructions built = constructions_for(climate);
  drawings.climate = climate;
  drawings.place = city.place;
  drawings.time_zone = city.time_zone;
  drawings.wall_u_W_m2K = built.wall_u_W_m2K;
  drawings.roof_u_W_m2K = built.roof_u_W_m2K;
  drawings.window_u_W_m2K = built.window_u_W_m2K;
  drawings.ground_u_W_m2K = built.ground_u_W_m2K;
  drawings.window_shgc = built.shgc;
  drawings.economiser_limit_C = built.economiser_limit_C;
  drawings.mains_C = in_steps(std::clamp(mean_C, 8.0, 24.0), 0.5);
  drawings.ground_C = in_steps(std::clamp(mean_C + 2.0, 9.0, 24.0), 0.5);
}

/// Differences from the 2000s, as factors.
struct Epoch {
  double wall_u, roof_u, window_u, ground_u, shgc, leakage, lighting, cop;
  double boiler_efficiency;
};

/// After ASHRAE 90.1-1989 (post-1980 reference buildings of DOE) and 90.1-2013 against 90.1-2004.
void date_back(Drawings& drawings, Vintage vintage) {
  if (vintage == Vintage::of_2000s) return;
  const Epoch epoch = vintage == Vintage::of_1980s
                          ? Epoch{1.6, 1.7, 1.5, 1.4, 1.4, 1.6, 1.35, 0.82, 0.80}
                          : Epoch{0.75, 0.75, 0.8, 0.85, 0.85, 0.65, 0.65, 1.12, 0.91};
  const auto scale = [](double& value, double factor, double per_unit) {
    value = std::round(factor * value * per_unit) / per_unit;
  };
  scale(drawings.wall_u_W_m2K, epoch.wall_u, 100.0);
  scale(drawings.roof_u_W_m2K, epoch.roof_u, 100.0);
  scale(drawings.window_u_W_m2K, epoch.window_u, 10.0);
  scale(drawings.ground_u_W_m2K, epoch.ground_u, 100.0);
  scale(drawings.window_shgc, epoch.shgc, 100.0);
  scale(drawings.leakage_cm2_m2, epoch.leakage, 10.0);
  for (RoomUse* rooms :
       {&drawings.perimeter_rooms, &drawings.core_rooms, &drawings.special_rooms}) {
    scale(rooms->lighting_W_m2, epoch.lighting, 10.0);
  }
  scale(drawings.chiller_cop, epoch.cop, 10.0);
  scale(drawings.heat_pump_cop, epoch.cop, 10.0);
  if (drawings.heating != HeatingPlant::boiler) return;
  drawings.heating_efficiency = epoch.boiler_efficiency;
}

std::string_view cooling_in_words(const Drawings& drawings) {
  switch (drawings.cooling) {
    case CoolingPlant::district:
      return "chilled water from the district";
    case CoolingPlant::chiller:
      return "an own chiller behind a chilled-water meter";
    case CoolingPlant::packaged:
      return "packaged cooling units without a meter of their own";
  }
  return "";
}

std::string_view services_in_words(const Drawings& drawings) {
  switch (drawings.heating) {
    case HeatingPlant::district_steam:
      return "steam from the district";
    case HeatingPlant::district_water:
      return "hot water from the district";
    case HeatingPlant::boiler:
      return "a gas boiler";
    case HeatingPlant::heat_pump:
      return "an air-source heat pump";
  }
  return "";
}

void describe(Drawings& drawings) {
  const std::string_view use = to_string(drawings.use);
  drawings.id = std::string(use);
  drawings.name = std::string(use);
  drawings.name.front() = static_cast<char>(std::toupper(drawings.name.front()));
  drawings.description = fmt::format(
      "{} building: {} storey{} of {} m by {} m, air handlers for the rooms along the facades and "
      "for the core (variable air volume, reheat), {}, {}, electricity from the utility.",
      drawings.name, drawings.storeys, drawings.storeys == 1 ? "" : "s", drawings.length_m,
      drawings.width_m, cooling_in_words(drawings), services_in_words(drawings));
}

}  // namespace

Brief typical_brief(Use use) {
  Brief brief{.use = use};
  const auto own = [&](CoolingPlant cooling) {
    brief.cooling = cooling;
    brief.heating = HeatingPlant::boiler;
  };
  const auto built = [&](std::size_t storeys, double length_m, double width_m, double windows) {
    brief.storeys = storeys;
    brief.length_m = length_m;
    brief.width_m = width_m;
    brief.window_share = windows;
  };
  switch (use) {
    case Use::laboratory:
      brief.climate = ClimateKind::hot_humid;
      built(3, 65.0, 40.0, 0.35);
      break;
    case Use::office:
    case Use::school:
      break;
    case Use::shop:
      own(CoolingPlant::packaged);
      built(1, 75.0, 45.0, 0.10);
      brief.heavy = false;
      break;
    case Use::hotel:
      own(CoolingPlant::chiller);
      built(6, 55.0, 18.0, 0.30);
      break;
    case Use::clinic:
      own(CoolingPlant::chiller);
      built(3, 50.0, 34.0, 0.28);
      break;
    case Use::warehouse:
      own(CoolingPlant::packaged);
      built(1, 100.0, 50.0, 0.03);
      brief.heavy = false;
      break;
    case Use::restaurant:
      own(CoolingPlant::packaged);
      built(1, 30.0, 18.0, 0.25);
      break;
    case Use::gym:
      own(CoolingPlant::packaged);
      built(1, 48.0, 30.0, 0.20);
      brief.heavy = false;
      break;
  }
  return brief;
}

Drawings draw_up(const Brief& brief) {
  Drawings drawings;
  drawings.use = drawings.calendar = brief.use;
  drawings.storeys = brief.storeys;
  drawings.length_m = brief.length_m;
  drawings.width_m = brief.width_m;
  drawings.storey_height_m = brief.use == Use::laboratory ? 4.2 : 3.8;
  drawings.perimeter_depth_m = std::min(6.0, 0.3 * brief.width_m);
  drawings.window_share = brief.window_share;
  drawings.skylight_share = brief.skylight_share;
  drawings.heavy = brief.heavy;
  drawings.cooling = brief.cooling;
  drawings.heating = brief.heating;
  // Anything that runs, loses heat or keeps people away unknown to the drawings would be
  // a hidden effect.
  drawings.saturday_operation = false;
  drawings.attendance_follows_season = false;
  drawings.heating_efficiency = brief.heating == HeatingPlant::boiler ? 0.86 : 0.97;
  // Small outdoor units are less efficient than a chiller with a tower.
  if (brief.cooling == CoolingPlant::packaged) drawings.chiller_cop = 3.3;
  furnish(drawings);
  place_in(drawings, brief.climate);
  date_back(drawings, brief.vintage);
  describe(drawings);
  size_services(drawings);
  return drawings;
}

}  // namespace recald::simulators
