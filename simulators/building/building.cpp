#include "simulators/building/building.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

using namespace drawings;

constexpr AirState kInitialAir{22.0, 0.007};
constexpr double kDesignDensity_kg_m3 = 1.15;

/// Even air handlers serve offices, odd ones laboratories, two a storey.
bool serves_offices(std::size_t air_handler) { return air_handler % 2 == 0; }

AirHandler make_air_handler(const Truth& truth, std::size_t index) {
  const bool office = serves_offices(index);
  const double supply_kg_s =
      kDesignDensity_kg_m3 * (office ? office_supply_m3_s : core_supply_m3_s);
  const CoolingCoil coil{
      .capacity_W = truth.coil_scale * 1000.0 * (office ? office_coil_kW : laboratory_coil_kW),
      .design_flow_kg_s = supply_kg_s,
      .design_bypass_factor = office ? 0.10 : 0.07,
      .lowest_apparatus_dew_point_C = 8.5};
  const Fan fan{.design_W = truth.fan_scale * 1000.0 * (office ? office_fan_kW : laboratory_fan_kW),
                .idle_share = 0.12,
                .exponent = truth.fan_exponent,
                .share_in_airstream = office ? 0.70 : 0.60};
  const AirHandlerDesign design{.supply_kg_s = supply_kg_s,
                                .outdoor_kg_s = kDesignDensity_kg_m3 * truth.outdoor_m3_s[index],
                                .supply_C = truth.supply_C[index],
                                .supply_reset_K = office ? truth.office_supply_reset_K : 0.0,
                                .preheat_W = office ? 60e3 : 160e3,
                                .coil = coil,
                                .fan = fan,
                                .economiser_limit_C = std::nullopt};
  std::vector<BoxDesign> boxes;
  for (std::size_t side = office ? south : laboratory; side <= (office ? west : equipment);
       ++side) {
    const double min_share = truth.box_minimum_scale * (office               ? office_min_share
                                                        : side == laboratory ? laboratory_min_share
                                                                             : equipment_min_share);
    const double max_kg_s = kDesignDensity_kg_m3 * zone_supply_m3_s[side];
    boxes.push_back({max_kg_s, min_share, 13'000.0 * max_kg_s});
  }
  return AirHandler(design, std::move(boxes));
}

}  // namespace

Building::Building(const Truth& truth, std::uint64_t seed)
    : truth_(truth),
      envelope_(truth, kInitialAir),
      people_(truth.occupancy_density_person_m2, stream_of(seed, Stream::people)),
      internal_loads_(truth, stream_of(seed, Stream::loads)),
      services_(truth, stream_of(seed, Stream::hot_water)) {
  for (std::size_t i = 0; i < drawings::air_handlers; ++i) {
    air_handlers_.push_back(make_air_handler(truth, i));
  }
}

void Building::begin_day(metering::Day day) {
  today_ = day;
  today_kind_ = day_kind(day);
  people_.begin_day(day);
  internal_loads_.begin_day();
}

AirHandlerCommand Building::command_office(std::size_t storey, const Clock& clock) {
  const bool workday = clock.kind == DayKind::workday;
  const bool saturday = clock.kind == DayKind::saturday && truth_.saturday_operation;
  const double from_h = workday ? truth_.occupied_from_h : 8.0;
  const double to_h = workday ? truth_.occupied_to_h : 14.0;
  if (workday || saturday) {
    night_cycle_[storey] = night_cycle_[storey] && clock.hour < from_h - 1.0;
    if (clock.hour >= from_h && clock.hour < to_h) return {AirHandlerMode::ventilate, 1.0, 1.0};
    if (clock.hour >= from_h - 1.0 && clock.hour < from_h) {
      return {AirHandlerMode::recirculate, 0.0, 1.0};
    }
  }
  double coldest_C = 100.0;
  double warmest_C = -100.0;
  for (std::size_t side = south; side <= west; ++side) {
    const double felt_C = zones()[storey * zones_per_storey + side].operative_C();
    coldest_C = std::min(coldest_C, felt_C);
    warmest_C = std::max(warmest_C, felt_C);
  }
  const double hysteresis_K = night_cycle_[storey] ? 1.2 : 0.0;
  night_cycle_[storey] = coldest_C < truth_.office_night_heating_C + hysteresis_K ||
                         warmest_C > truth_.office_night_cooling_C - hysteresis_K;
  if (night_cycle_[storey]) return {AirHandlerMode::recirculate, 0.0, 1.0};
  return {AirHandlerMode::off, 0.0, 1.0};
}

AirHandlerCommand Building::command_laboratory(const Clock& clock) const {
  const bool day = clock.kind == DayKind::workday && clock.hour >= truth_.occupied_from_h &&
                   clock.hour < truth_.occupied_to_h;
  const double share = day ? 1.0 : truth_.laboratory_night_share;
  return {AirHandlerMode::ventilate, share, share};
}

void Building::run_air_handlers(const Outdoors& outdoors, const Clock& clock) {
  load_.cooling_W = load_.heating_W = load_.fans_W = 0.0;
  for (std::size_t index = 0; index < drawings::air_handlers; ++index) {
    const std::size_t storey = index / 2;
    const bool office = serves_offices(index);
    const AirHandlerCommand command =
        office ? command_office(storey, clock) : command_laboratory(clock);
    if (office) pressurised_[storey] = command.mode == AirHandlerMode::ventilate;
    const bool night = office && night_cycle_[storey];
    const std::size_t first = storey * zones_per_storey + (office ? south : laboratory);
    const std::size_t count = office ? 4 : 2;
    std::array<BoxDemand, 4> demands{};
    for (std::size_t box = 0; box < count; ++box) {
      const Zone& zone = zones()[first + box];
      const double offset_K = truth_.thermostat_offset_K[first + box];
      demands[box] = {
          zone.air(), zone.operative_C(),
          (night ? truth_.office_night_cooling_C - 1.0 : truth_.cooling_setpoint_C) + offset_K,
          (night ? truth_.office_night_heating_C + 1.0 : truth_.heating_setpoint_C) + offset_K,
          truth_.thermostat_band_K};
    }
    work_[index] = air_handlers_[index].advance(command, std::span(demands.data(), count),
                                                outdoors.air, outdoors.pressure_Pa, kStep_s);
    for (std::size_t box = 0; box < count; ++box) {
      zone_loads_[first + box].supply_kg_s = air_handlers_[index].supplies()[box].kg_s;
      zone_loads_[first + box].supply = air_handlers_[index].supplies()[box].air;
    }
    load_.cooling_W += work_[index].cooling_W;
    load_.heating_W += work_[index].preheat_W + work_[index].reheat_W;
    load_.fans_W += work_[index].fan_W;
  }
}

void Building::add_gains(const Clock& clock, const Outdoors& outdoors) {
  constexpr double lights_radiant = 0.55;
  constexpr double plugs_radiant = 0.30;
  constexpr double people_radiant = 0.50;
  const auto& effects = envelope_.expose(outdoors, pressurised_);
  const auto& powers =
      internal_loads_.advance(people_, clock.minute_of_day, clock.kind == DayKind::workday);
  load_.lights_and_plugs_W = 0.0;
  people_present_ = 0;
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
    const int present = people_.present(zone, clock.minute_of_day);
    const double people_W = present * sensible_W_person;
    const double lights_W = truth_.zone_heat_share * powers[zone].lights_W;
    const double plugs_W = truth_.zone_heat_share * powers[zone].plugs_W;
    ZoneLoads& loads = zone_loads_[zone];
    loads.radiant_W = lights_radiant * lights_W + plugs_radiant * plugs_W +
                      people_radiant * people_W + effects[zone].transmitted_sun_W;
    loads.convective_W = (1.0 - lights_radiant) * lights_W + (1.0 - plugs_radiant) * plugs_W +
                         (1.0 - people_radiant) * people_W;
    loads.moisture_kg_s = present * latent_W_person / kEvaporation_J_kg;
    loads.infiltration_kg_s = effects[zone].infiltration_kg_s;
    loads.outdoor = outdoors.air;
    load_.lights_and_plugs_W += powers[zone].lights_W + powers[zone].plugs_W;
    people_present_ += present;
  }
  load_.people_share =
      people_.assigned() > 0 ? static_cast<double>(people_present_) / people_.assigned() : 0.0;
  constexpr double dusk_sine = -0.05;  // lamps switch when the sun is 3 degrees below the horizon
  load_.dark = outdoors.sun.up < dusk_sine;
}

void Building::exchange_through_doors() {
  constexpr double exchange_per_door_kg_s = 0.12;
  for (ZoneLoads& loads : zone_loads_) loads.exchange_W = loads.exchange_moisture_kg_s = 0.0;
  for (std::size_t storey = 0; storey < storeys; ++storey) {
    const std::size_t centre = storey * zones_per_storey + laboratory;
    for (const std::size_t side : {south, north, east, west, equipment}) {
      const std::size_t room = storey * zones_per_storey + side;
      const AirState& inner = zones()[centre].air();
      const AirState& outer = zones()[room].air();
      const double heat_W =
          exchange_per_door_kg_s * kDryAirHeat_J_kgK * (inner.temperature_C - outer.temperature_C);
      const double moisture_kg_s =
          exchange_per_door_kg_s * (inner.humidity_kg_kg - outer.humidity_kg_kg);
      zone_loads_[room].exchange_W += heat_W;
      zone_loads_[room].exchange_moisture_kg_s += moisture_kg_s;
      zone_loads_[centre].exchange_W -= heat_W;
      zone_loads_[centre].exchange_moisture_kg_s -= moisture_kg_s;
    }
  }
}

void Building::advance_zones() {
  heat_imbalance_J_ = 0.0;
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
    Zone& room = envelope_.zones()[zone];
    heat_imbalance_J_ += room.stored_J();
    const ZoneHeat heat = room.advance(zone_loads_[zone], kStep_s);
    heat_imbalance_J_ += heat.gains_J + heat.supply_J + heat.infiltration_J - room.stored_J();
  }
  heat_imbalance_J_ += envelope_.exposed_heat_W() * kStep_s;
}

UtilityPower Building::advance(const Outdoors& outdoors, const metering::LocalTime& local) {
  if (today_ != local.date) begin_day(local.date);
  const Clock clock{today_kind_, local.minute_of_day, local.minute_of_day / 60.0};
  run_air_handlers(outdoors, clock);
  add_gains(clock, outdoors);
  exchange_through_doors();
  advance_zones();
  return services_.advance(load_);
}

}  // namespace recald::simulators
