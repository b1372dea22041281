#include "simulators/energyplus/templated_building.hpp"

#include <algorithm>
#include <cmath>

#include "simulators/building/calendar.hpp"

namespace recald::simulators::energyplus {
namespace {

/// What a group of rooms is used for, by floor area.
struct GroupUse {
  double person_m2;
  double lighting_W_m2;
  double plugs_W_m2;
  double standing;  ///< Of the plugs, always on.
  double people;    ///< Of them, in proportion to the people.
  double working;   ///< Of them, while people work.
  bool lit_while_open;
  bool runs_always;
  double outdoor_m3_s_m2;
  double least_share;  ///< Of the supply air.
};

/// Sums of floor-area shares of one kind of room.
void add_rooms(GroupUse& use, const Drawings& drawings, const RoomUse& rooms, double share) {
  use.person_m2 += share * drawings.occupancy_person_m2 * rooms.crowding;
  use.lighting_W_m2 += share * rooms.lighting_W_m2;
  const double plugs_W_m2 = share * rooms.plugs_W_m2;
  use.plugs_W_m2 += plugs_W_m2;
  use.standing += plugs_W_m2 * rooms.plugs_standing_share;
  use.people += plugs_W_m2 * rooms.plugs_people_share;
  use.working += plugs_W_m2 * rooms.plugs_working_share;
  use.lit_while_open |= rooms.lit_while_open;
}

GroupUse use_of(const Drawings& drawings, const std::string& group) {
  const double outer_share = drawings.perimeter_floor_share();
  const double special_share = (1.0 - outer_share) * drawings.special_share_of_core;
  const double core_share = 1.0 - outer_share - special_share;
  const bool has_outer = group != "Core";
  const bool has_core = group != "Perimeter";
  const double whole = (has_outer ? outer_share : 0.0) + (has_core ? 1.0 - outer_share : 0.0);
  GroupUse use{};
  if (has_outer) add_rooms(use, drawings, drawings.perimeter_rooms, outer_share / whole);
  if (has_core) {
    add_rooms(use, drawings, drawings.core_rooms, core_share / whole);
    add_rooms(use, drawings, drawings.special_rooms, special_share / whole);
  }
  use.standing /= use.plugs_W_m2;
  use.people /= use.plugs_W_m2;
  use.working /= use.plugs_W_m2;
  use.runs_always = has_core ? drawings.core_runs_always : drawings.perimeter_runs_always;
  const double outdoor_m3_s = (has_outer ? drawings.perimeter_air.outdoor_m3_s : 0.0) +
                              (has_core ? drawings.core_air.outdoor_m3_s : 0.0);
  use.outdoor_m3_s_m2 = outdoor_m3_s / (whole * drawings.storey_m2());
  use.least_share = has_core ? drawings.core_min_share : drawings.perimeter_min_share;
  return use;
}

/// The same hours on all days on which the building is open.
WeeklyShares while_open(const Drawings& drawings, double from_h, double to_h, double within,
                        double outside) {
  WeeklyShares shares{};
  shares.workday.fill(outside);
  shares.saturday.fill(outside);
  shares.sunday.fill(outside);
  const auto open = [&](HourlyShares& day, DayKind kind) {
    if (!is_open(drawings.open_days, kind)) return;
    for (std::size_t hour = 0; hour < day.size(); ++hour) {
      const auto begin_h = static_cast<double>(hour);
      if (begin_h >= std::floor(from_h) && begin_h < std::ceil(to_h)) day[hour] = within;
    }
  };
  open(shares.workday, DayKind::workday);
  open(shares.saturday, DayKind::saturday);
  open(shares.sunday, DayKind::sunday);
  return shares;
}

WeeklyShares presence_of(const Drawings& drawings) {
  return {drawings.presence_workday, drawings.presence_saturday, drawings.presence_sunday};
}

/// `of(presence, working)` by hour.
template <class Function>
WeeklyShares shares_of(const Drawings& drawings, const Function& of) {
  const WeeklyShares presence = presence_of(drawings);
  const WeeklyShares working =
      while_open(drawings, drawings.working_from_h, drawings.working_to_h, 1.0, 0.0);
  WeeklyShares shares{};
  for (std::size_t hour = 0; hour < shares.workday.size(); ++hour) {
    shares.workday[hour] = of(presence.workday[hour], working.workday[hour]);
    shares.saturday[hour] = of(presence.saturday[hour], working.saturday[hour]);
    shares.sunday[hour] = of(presence.sunday[hour], working.sunday[hour]);
  }
  return shares;
}

void add_use(Json& model, const Drawings& drawings, const RoomGroup& group, const GroupUse& use) {
  constexpr double kLeftLit = 0.06;
  constexpr double kLitWhileOpen = 0.95;
  add_weekly(model, group.name + " presence", presence_of(drawings));
  add_weekly(
      model, group.name + " lights on", shares_of(drawings, [&](double presence, double working) {
        const double lit = use.lit_while_open ? kLitWhileOpen * working
                                              : (1.0 - kLeftLit) * std::min(1.1 * presence, 1.0);
        return std::max(lit, kLeftLit);
      }));
  add_weekly(model, group.name + " equipment on",
             shares_of(drawings, [&](double presence, double working) {
               return std::min(use.standing + use.people * presence + use.working * working, 1.0);
             }));
  add_loads(model, {.of = group.name,
                    .rooms = group.room_names(),
                    .people_person_m2 = use.person_m2,
                    .lighting_W_m2 = use.lighting_W_m2,
                    .equipment_W_m2 = use.plugs_W_m2});
}

/// When the air of a group runs, when it takes outdoor air, and what its thermostats keep.
void add_operation(Json& model, const Drawings& drawings, const std::string& group,
                   bool runs_always) {
  constexpr double kWarmUp_h = 1.0;
  const double from_h = drawings.occupied_from_h;
  const double to_h = drawings.occupied_to_h;
  const auto add = [&](const char* of, double begin_h, double open, double closed) {
    return add_weekly(model, group + of,
                      while_open(drawings, begin_h, to_h, open, runs_always ? open : closed),
                      ColdDesignDay::working);
  };
  add(" fans run", from_h, 1.0, 0.0);
  add(" outdoor air", from_h + kWarmUp_h, 1.0, 0.0);
  model["HVACTemplate:Thermostat"][group] = {
      {"heating_setpoint_schedule_name",
       add(" heating set-point", from_h, drawings.heating_setpoint_C, drawings.night_heating_C)},
      {"cooling_setpoint_schedule_name",
       add(" cooling set-point", from_h, drawings.cooling_setpoint_C, drawings.night_cooling_C)}};
}

void add_economiser(Json& system, const Drawings& drawings, const char* limit) {
  if (!drawings.economiser_limit_C) return;
  system["economizer_type"] = "FixedDryBulb";
  system[limit] = *drawings.economiser_limit_C;
}

/// The template of a zone, without what its system adds.
Json zone_of(const Room& room, const RoomGroup& group, const GroupUse& use) {
  return {{"zone_name", room.name},
          {"template_thermostat_name", group.name},
          {"outdoor_air_method", "Flow/Area"},
          {"outdoor_air_flow_rate_per_zone_floor_area", use.outdoor_m3_s_m2}};
}

struct Group {
  const RoomGroup& rooms;
  const GroupUse& use;
};

void add_central_air(Json& model, const Drawings& drawings, const Group& group, bool packaged) {
  const std::string& name = group.rooms.name;
  const std::string air = name + " air";
  Json system{{"system_availability_schedule_name", name + " fans run"},
              {"supply_fan_delta_pressure", 1000.0},
              {"cooling_coil_design_setpoint", drawings.supply_C},
              {"minimum_outdoor_air_schedule_name", name + " outdoor air"},
              {"supply_fan_part_load_power_coefficients", "ASHRAE90.1-2004AppendixG"},
              {"night_cycle_control", "CycleOnAny"},
              {"cooling_coil_setpoint_schedule_name",
               add_constant(model, name + " supply temperature", drawings.supply_C)}};
  add_economiser(system, drawings,
                 packaged ? "economizer_maximum_limit_dry_bulb_temperature"
                          : "economizer_upper_temperature_limit");
  if (packaged) {
    system["cooling_coil_type"] = "TwoSpeedDX";
    system["cooling_coil_gross_rated_cop"] = std::min(drawings.chiller_cop, 3.6);
  } else {
    system["heating_coil_type"] = "HotWater";
    system["heating_coil_design_setpoint"] = 10.0;
  }
  model[packaged ? "HVACTemplate:System:PackagedVAV" : "HVACTemplate:System:VAV"][air] = system;
  for (const Room& room : group.rooms.rooms) {
    Json zone = zone_of(room, group.rooms, group.use);
    zone["template_vav_system_name"] = air;
    zone["constant_minimum_air_flow_fraction"] = group.use.least_share;
    zone["reheat_coil_type"] = "HotWater";
    zone["damper_heating_action"] = "Normal";
    model["HVACTemplate:Zone:VAV"][room.name + " box"] = zone;
  }
}

void add_room_units(Json& model, const Drawings& drawings, const Group& group, AirSystem system) {
  const std::string& name = group.rooms.name;
  const std::string cycling = name + " fans run";
  for (const Room& room : group.rooms.rooms) {
    Json zone = zone_of(room, group.rooms, group.use);
    switch (system) {
      case AirSystem::fan_coils:
        zone["outdoor_air_schedule_name"] = name + " outdoor air";
        zone["capacity_control_method"] = "ConstantFanVariableFlow";
        model["HVACTemplate:Zone:FanCoil"][room.name + " fan coil"] = zone;
        break;
      case AirSystem::outdoor_air_units:
        zone["dedicated_outdoor_air_system_name"] = "Outdoor air";
        zone["capacity_control_method"] = "ConstantFanVariableFlow";
        model["HVACTemplate:Zone:FanCoil"][room.name + " fan coil"] = zone;
        break;
      case AirSystem::packaged_rooms: {
        const bool burns = drawings.heating == HeatingPlant::boiler;
        Json unit{{"control_zone_or_thermostat_location_name", room.name},
                  {"supply_fan_operating_mode_schedule_name", cycling},
                  {"dx_cooling_coil_gross_rated_cop", std::min(drawings.chiller_cop, 3.8)},
                  {"cooling_design_supply_air_temperature", drawings.supply_C},
                  {"heating_design_supply_air_temperature", 50.0},
                  {"heating_coil_type", burns ? "Gas" : "HotWater"},
                  {"minimum_outdoor_air_schedule_name", name + " outdoor air"}};
        if (burns) unit["gas_heating_coil_efficiency"] = drawings.heating_efficiency;
        add_economiser(unit, drawings, "economizer_maximum_limit_dry_bulb_temperature");
        model["HVACTemplate:System:UnitarySystem"][room.name + " unit"] = unit;
        zone["template_unitary_system_name"] = room.name + " unit";
        model["HVACTemplate:Zone:Unitary"][room.name + " zone"] = zone;
        break;
      }
      case AirSystem::water_loop:
        zone["supply_fan_operating_mode_schedule_name"] = cycling;
        model["HVACTemplate:Zone:WaterToAirHeatPump"][room.name + " heat pump"] = zone;
        break;
      case AirSystem::room_heat_pumps:
        zone["supply_fan_operating_mode_schedule_name"] = cycling;
        zone["heat_pump_heating_coil_gross_rated_cop"] = drawings.heat_pump_cop;
        model["HVACTemplate:Zone:PTHP"][room.name + " heat pump"] = zone;
        break;
      case AirSystem::refrigerant_flow:
        zone["template_vrf_system_name"] = "Outdoor unit";
        for (const char* size : {"cooling_coil_gross_rated_total_capacity",
                                 "cooling_coil_gross_rated_sensible_heat_ratio",
                                 "heat_pump_heating_coil_gross_rated_capacity"}) {
          zone[size] = "Autosize";  // the conversion loses what is left to its default
        }
        zone["supply_fan_operating_mode_schedule_name"] = cycling;
        model["HVACTemplate:Zone:VRF"][room.name + " cassette"] = zone;
        break;
      default:
        zone["outdoor_air_method"] = "DetailedSpecification";
        zone["design_specification_outdoor_air_object_name"] = name + " outdoor air";
        model["DesignSpecification:OutdoorAir"][name + " outdoor air"] = {
            {"outdoor_air_method", "Flow/Area"},
            {"outdoor_air_flow_per_zone_floor_area", group.use.outdoor_m3_s_m2},
            {"outdoor_air_schedule_name", name + " outdoor air"}};
        model["HVACTemplate:Zone:IdealLoadsAirSystem"][room.name + " air"] = zone;
        break;
    }
  }
}

void add_chilled_water(Json& model, const Drawings& drawings) {
  model["HVACTemplate:Plant:ChilledWaterLoop"]["Chilled water"] = {
      {"chilled_water_design_setpoint", 6.7},
      {"chilled_water_pump_configuration", "ConstantPrimaryVariableSecondary"}};
  // ExpandObjects refuses a plant without its last fields.
  Json chiller{{"nominal_cop", drawings.chiller_cop},
               {"leaving_chilled_water_lower_temperature_limit", 5.0}};
  constexpr double kWaterCooled = 4.0;  // Better than this only behind a tower.
  if (drawings.cooling == CoolingPlant::district) {
    chiller["chiller_type"] = "DistrictChilledWater";
  } else if (drawings.chiller_cop >= kWaterCooled) {
    chiller["chiller_type"] = "ElectricScrewChiller";
    model["HVACTemplate:Plant:Tower"]["Tower"] = {{"tower_type", "TwoSpeed"},
                                                  {"template_plant_loop_type", "ChilledWater"}};
  } else {
    chiller["chiller_type"] = "ElectricReciprocatingChiller";
    chiller["condenser_type"] = "AirCooled";
  }
  model["HVACTemplate:Plant:Chiller"]["Chiller"] = chiller;
}

Json boiler_of(const Drawings& drawings) {
  Json boiler{{"water_outlet_upper_temperature_limit", 99.0}};
  if (drawings.heating == HeatingPlant::district_steam ||
      drawings.heating == HeatingPlant::district_water) {
    boiler["boiler_type"] = "DistrictHotWater";
    return boiler;
  }
  boiler["boiler_type"] = "HotWaterBoiler";
  boiler["efficiency"] = std::min(drawings.heating_efficiency, 0.95);
  boiler["fuel_type"] = "NaturalGas";
  return boiler;
}

void add_hot_water(Json& model, const Drawings& drawings) {
  model["HVACTemplate:Plant:HotWaterLoop"]["Hot water"] = {
      {"hot_water_design_setpoint", 75.0}, {"hot_water_pump_configuration", "VariableFlow"}};
  model["HVACTemplate:Plant:Boiler"]["Boiler"] = boiler_of(drawings);
}

void add_mixed_water(Json& model, const Drawings& drawings) {
  model["HVACTemplate:Plant:MixedWaterLoop"]["Loop"] = {
      {"water_pump_configuration", "VariableFlow"}};
  Json boiler = boiler_of(drawings);
  boiler["template_plant_loop_type"] = "MixedWater";
  model["HVACTemplate:Plant:Boiler"]["Boiler"] = boiler;
  model["HVACTemplate:Plant:Tower"]["Tower"] = {{"tower_type", "SingleSpeed"},
                                                {"template_plant_loop_type", "MixedWater"}};
}

void add_outdoor_air_system(Json& model, const Drawings& drawings, const std::string& group) {
  model["HVACTemplate:System:DedicatedOutdoorAir"]["Outdoor air"] = {
      {"system_availability_schedule_name", group + " outdoor air"},
      {"cooling_coil_type", "ChilledWater"},
      {"heating_coil_type", "HotWater"},
      {"heat_recovery_type", drawings.heavy ? "Sensible" : "None"}};
}

void add_outdoor_unit(Json& model, const Drawings& drawings, const RoomGroup& group) {
  model["HVACTemplate:System:VRF"]["Outdoor unit"] = {
      {"gross_rated_heating_cop", drawings.heat_pump_cop},
      {"master_thermostat_priority_control_type", "LoadPriority"},
      {"zone_name_for_master_thermostat_location", group.rooms.front().name}};
}

void add_plants(Json& model, const TemplatedBuilding& building,
                const std::vector<RoomGroup>& groups) {
  const Drawings& drawings = building.drawings;
  switch (building.system) {
    case AirSystem::vav_reheat:
    case AirSystem::fan_coils:
      add_chilled_water(model, drawings);
      add_hot_water(model, drawings);
      break;
    case AirSystem::outdoor_air_units:
      add_chilled_water(model, drawings);
      add_hot_water(model, drawings);
      add_outdoor_air_system(model, drawings, groups.front().name);
      break;
    case AirSystem::packaged_vav:
      add_hot_water(model, drawings);
      break;
    case AirSystem::packaged_rooms:
      if (drawings.heating != HeatingPlant::boiler) add_hot_water(model, drawings);
      break;
    case AirSystem::water_loop:
      add_mixed_water(model, drawings);
      break;
    case AirSystem::refrigerant_flow:
      add_outdoor_unit(model, drawings, groups.front());
      break;
    case AirSystem::room_heat_pumps:
    case AirSystem::ideal_district:
      break;
  }
}

/// By resistances: what films and the layers with mass leave to insulation.
Envelope envelope_of(const Drawings& drawings) {
  constexpr double kWall_m2K_W = 0.42;
  constexpr double kRoof_m2K_W = 0.33;
  constexpr double kGround_m2K_W = 0.26;
  const auto insulation = [](double u_W_m2K, double rest_m2K_W) {
    return std::max(1.0 / u_W_m2K - rest_m2K_W, 0.05);
  };
  return {.wall_insulation_m2K_W = insulation(drawings.wall_u_W_m2K, kWall_m2K_W),
          .roof_insulation_m2K_W = insulation(drawings.roof_u_W_m2K, kRoof_m2K_W),
          .ground_insulation_m2K_W = insulation(drawings.ground_u_W_m2K, kGround_m2K_W),
          .window_u_W_m2K = drawings.window_u_W_m2K,
          .window_shgc = drawings.window_shgc * (1.0 - drawings.window_frame_share),
          .wall_solar_absorptance = drawings.wall_absorptance,
          .roof_solar_absorptance = drawings.roof_absorptance};
}

void add_light_constructions(Json& model) {
  constexpr double kBoard_m = 0.03;
  model["Material"]["Block"]["thickness"] = kBoard_m;
  model["Material"]["Concrete"]["thickness"] = 2.0 * kBoard_m;
}

double infiltration_m3_s_m2(const Drawings& drawings) {
  // An opening of 1 cm² a m² passes this at 4 m/s, as the models of leakage area have it.
  constexpr double kPerLeakage = 1.6e-4;
  return kPerLeakage * drawings.leakage_cm2_m2;
}

}  // namespace

std::string_view to_string(AirSystem system) {
  switch (system) {
    case AirSystem::vav_reheat:
      return "vav_reheat";
    case AirSystem::fan_coils:
      return "fan_coils";
    case AirSystem::packaged_rooms:
      return "packaged_rooms";
    case AirSystem::water_loop:
      return "water_loop";
    case AirSystem::ideal_district:
      return "ideal_district";
    case AirSystem::packaged_vav:
      return "packaged_vav";
    case AirSystem::outdoor_air_units:
      return "outdoor_air_units";
    case AirSystem::room_heat_pumps:
      return "room_heat_pumps";
    case AirSystem::refrigerant_flow:
      break;
  }
  return "refrigerant_flow";
}

Json templated_model(const TemplatedBuilding& building) {
  const Drawings& drawings = building.drawings;
  Json model = empty_model(drawings.id, drawings.ground_C);
  for (const char* sizing : {"do_zone_sizing_calculation", "do_system_sizing_calculation",
                             "do_plant_sizing_calculation"}) {
    model["SimulationControl"]["Control"][sizing] = "Yes";
  }
  add_constructions(model, envelope_of(drawings));
  if (!drawings.heavy) add_light_constructions(model);
  const std::vector<RoomGroup> groups = rooms_of(building.shape, drawings);
  std::vector<std::string> all;
  for (const RoomGroup& group : groups) {
    const GroupUse use = use_of(drawings, group.name);
    for (const Room& room : group.rooms) {
      add_room(model, room);
      all.push_back(room.name);
    }
    add_use(model, drawings, group, use);
    add_operation(model, drawings, group.name, use.runs_always);
    if (building.system == AirSystem::vav_reheat || building.system == AirSystem::packaged_vav) {
      add_central_air(model, drawings, {group, use}, building.system == AirSystem::packaged_vav);
    } else {
      add_room_units(model, drawings, {group, use}, building.system);
    }
  }
  add_infiltration(model, "Building", all, infiltration_m3_s_m2(drawings));
  add_plants(model, building, groups);
  model["Exterior:Lights"]["Outside"] = {{"schedule_name", add_constant(model, "Always", 1.0)},
                                         {"design_level", 1000.0 * drawings.exterior_kW},
                                         {"control_option", "AstronomicalClock"}};
  return model;
}

void add_design_days(Json& model, const DesignHours& hours) {
  model["Site:Location"]["Here"] = {{"latitude", hours.place.latitude_deg},
                                    {"longitude", hours.place.longitude_deg},
                                    {"time_zone", hours.zone_h},
                                    {"elevation", hours.place.altitude_m}};
  const auto add = [&](const char* name, int month, const char* day_type, double dry_C,
                       double range_K, double wet_C, double clearness) {
    model["SizingPeriod:DesignDay"][name] = {{"month", month},
                                             {"day_of_month", 21},
                                             {"day_type", day_type},
                                             {"maximum_dry_bulb_temperature", dry_C},
                                             {"daily_dry_bulb_temperature_range", range_K},
                                             {"humidity_condition_type", "WetBulb"},
                                             {"wetbulb_or_dewpoint_at_maximum_dry_bulb", wet_C},
                                             {"barometric_pressure", hours.pressure_Pa},
                                             {"wind_speed", 4.0},
                                             {"wind_direction", 0.0},
                                             {"solar_model_indicator", "ASHRAEClearSky"},
                                             {"sky_clearness", clearness}};
  };
  const bool is_south = hours.place.latitude_deg < 0.0;
  constexpr double kSummerRange_K = 10.0;
  add("Cold day", is_south ? 7 : 1, "WinterDesignDay", hours.heating_C, 0.0, hours.heating_C, 0.0);
  add("Hot day", is_south ? 1 : 7, "SummerDesignDay", hours.cooling_C, kSummerRange_K,
      hours.cooling_wet_bulb_C, 1.0);
}

}  // namespace recald::simulators::energyplus
