#include "simulators/building/building.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr AirState kInitialAir{22.0, 0.007};
constexpr double kDesignDensity_kg_m3 = 1.15;
constexpr RunningHours kNever{24.0, 0.0};

/// Two air handlers per storey: even ones serve the perimeter, odd ones the core.
bool serves_perimeter(std::size_t air_handler) { return air_handler % 2 == 0; }

std::size_t first_side(std::size_t air_handler) {
  return serves_perimeter(air_handler) ? south : core;
}
std::size_t last_side(std::size_t air_handler) {
  return serves_perimeter(air_handler) ? west : special;
}

AirHandlerDesign design_of(const Truth& truth, std::size_t index, double supply_kg_s) {
  const Drawings& drawings = truth.drawings;
  const bool perimeter = serves_perimeter(index);
  const AirHandlerPlate& plate = perimeter ? drawings.perimeter_air : drawings.core_air;
  const bool scheduled = !drawings.runs_always(perimeter);
  return {.supply_kg_s = supply_kg_s,
          .outdoor_kg_s = kDesignDensity_kg_m3 * truth.outdoor_m3_s[index],
          .supply_C = truth.supply_C[index],
          .supply_reset_K = scheduled ? truth.supply_reset_K : 0.0,
          .preheat_W = 1000.0 * plate.preheat_kW,
          .coil = {.capacity_W = truth.coil_scale * 1000.0 * plate.coil_kW,
                   .design_flow_kg_s = supply_kg_s,
                   .design_bypass_factor = plate.coil_bypass_factor,
                   .lowest_apparatus_dew_point_C = 8.5},
          .fan = {.design_W = truth.fan_scale * 1000.0 * plate.fan_kW,
                  .idle_share = 0.12,
                  .exponent = truth.fan_exponent,
                  .share_in_airstream = plate.fan_share_in_airstream},
          .economiser_limit_C = drawings.economiser_limit_C};
}

AirHandler make_air_handler(const Truth& truth, std::size_t index) {
  const Drawings& drawings = truth.drawings;
  const double supply_kg_s =
      kDesignDensity_kg_m3 *
      (serves_perimeter(index) ? drawings.perimeter_supply_m3_s() : drawings.core_supply_m3_s());
  std::vector<BoxDesign> boxes;
  for (std::size_t side = first_side(index); side <= last_side(index); ++side) {
    const double max_kg_s = kDesignDensity_kg_m3 * drawings.zone_supply_m3_s[side];
    boxes.push_back(
        {max_kg_s, truth.box_minimum_scale * drawings.min_share(side), 13'000.0 * max_kg_s});
  }
  return AirHandler(design_of(truth, index, supply_kg_s), std::move(boxes));
}

Truth rebuilt(Truth truth, const HiddenEffects& effects) {
  for (const auto& effect : effects) effect->build(truth);
  return truth;
}

}  // namespace

Building::Building(Truth truth, std::chrono::seconds step, std::uint64_t seed,
                   HiddenEffects effects)
    : truth_(rebuilt(std::move(truth), effects)),
      step_s_(static_cast<double>(step.count())),
      calendar_(truth_.drawings.calendar),
      envelope_(truth_, kInitialAir),
      people_(truth_, stream_of(seed, Stream::people)),
      internal_loads_(truth_, step_s_, stream_of(seed, Stream::loads)),
      plant_(truth_, step_s_, stream_of(seed, Stream::hot_water)),
      effects_(std::move(effects)),
      night_cycle_(truth_.drawings.air_handlers(), false),
      pressurised_(truth_.drawings.storeys_simulated(), 0.0),
      zone_loads_(truth_.drawings.zones()),
      work_(truth_.drawings.air_handlers()),
      zone_imbalance_J_(truth_.drawings.zones(), 0.0) {
  for (std::size_t i = 0; i < truth_.drawings.air_handlers(); ++i) {
    air_handlers_.push_back(make_air_handler(truth_, i));
  }
}

void Building::begin_day(metering::Day day) {
  today_ = day;
  day_kind_ = calendar_.kind_of(day);
  const bool saturday = day_kind_ == DayKind::saturday && truth_.saturday_operation;
  timetable_ = {.kind = day_kind_,
                .air = is_open(truth_.drawings.open_days, day_kind_)
                           ? RunningHours{truth_.occupied_from_h, truth_.occupied_to_h}
                       : saturday ? RunningHours{8.0, 14.0}
                                  : kNever};
  for (const auto& effect : effects_) effect->plan(day, timetable_);
  const double season =
      truth_.drawings.attendance_follows_season ? calendar_.season_attendance(day) : 1.0;
  people_.begin_day(day, day_kind_, season, timetable_.attendance);
  internal_loads_.begin_day();
}

bool Building::runs_by_timetable(double hour) const {
  return hour >= timetable_.air.from_h && hour < timetable_.air.to_h;
}

Moment Building::moment(const Outdoors& outdoors, metering::Instant instant,
                        const metering::LocalTime& local) const {
  return {instant,
          local,
          day_kind_,
          outdoors,
          step_s_,
          load_.people_share,
          runs_by_timetable(local.minute_of_day / 60.0)};
}

Operation Building::as_built() const {
  Operation operation{};
  operation.rooms.cooling_C = truth_.cooling_setpoint_C;
  operation.rooms.heating_C = truth_.heating_setpoint_C;
  operation.rooms.night_cooling_C = truth_.night_cooling_C;
  operation.rooms.night_heating_C = truth_.night_heating_C;
  return operation;
}

AirHandlerCommand Building::command_scheduled(std::size_t air_handler, const Moment& now,
                                              const Operation& operation) {
  const RunningHours& hours = timetable_.air;
  const double warm_up_from_h = hours.from_h - timetable_.warm_up_h;
  if (hours.to_h > hours.from_h) {
    if (now.hour() >= warm_up_from_h && now.hour() < hours.to_h) night_cycle_[air_handler] = false;
    if (now.air_runs) return {AirHandlerMode::ventilate, 1.0, 1.0, 1.0, operation.air};
    if (now.hour() >= warm_up_from_h && now.hour() < hours.from_h) {
      return {AirHandlerMode::recirculate, 0.0, 1.0, 1.0, operation.air};
    }
  }
  return command_at_night(air_handler, now, operation);
}

AirHandlerCommand Building::command_at_night(std::size_t air_handler, const Moment& now,
                                             const Operation& operation) {
  const AirOperation& air = operation.air;
  double coldest_C = 100.0;
  double warmest_C = -100.0;
  const std::size_t first_zone = air_handler / 2 * kZonesPerStorey;
  for (std::size_t side = first_side(air_handler); side <= last_side(air_handler); ++side) {
    const double felt_C = zones()[first_zone + side].operative_C();
    coldest_C = std::min(coldest_C, felt_C);
    warmest_C = std::max(warmest_C, felt_C);
  }
  const double hysteresis_K = night_cycle_[air_handler] ? 1.2 : 0.0;
  night_cycle_[air_handler] = coldest_C < operation.rooms.night_heating_C + hysteresis_K ||
                              warmest_C > operation.rooms.night_cooling_C - hysteresis_K;
  if (night_cycle_[air_handler]) return {AirHandlerMode::recirculate, 0.0, 1.0, 1.0, air};
  if (air.night_run_share > 0.0) {
    return {AirHandlerMode::ventilate, 1.0, 1.0, air.night_run_share, air};
  }
  const bool worth_it = warmest_C > now.outdoors.air.temperature_C + 2.0;
  if (air.purge_share > 0.0 && worth_it && coldest_C > operation.rooms.heating_C) {
    return {AirHandlerMode::purge, 1.0, 1.0, air.purge_share, air};
  }
  return {AirHandlerMode::off, 0.0, 1.0, 1.0, air};
}

AirHandlerCommand Building::command_always(const Moment& now, const Operation& operation) const {
  const bool day = is_open(truth_.drawings.open_days, now.day_kind) && now.air_runs;
  const double share = day ? 1.0 : std::max(truth_.core_night_share, operation.air.night_run_share);
  return {AirHandlerMode::ventilate, share, share, 1.0, operation.air};
}

void Building::run_air_handler(std::size_t index, const Moment& now, const Operation& operation) {
  const RoomOperation& rooms = operation.rooms;
  const std::size_t storey = index / 2;
  const bool scheduled = !truth_.drawings.runs_always(serves_perimeter(index));
  const AirHandlerCommand command =
      scheduled ? command_scheduled(index, now, operation) : command_always(now, operation);
  if (serves_perimeter(index)) {
    pressurised_[storey] = command.mode == AirHandlerMode::ventilate ? command.run_share : 0.0;
  }
  const bool night = scheduled && (night_cycle_[index] || command.run_share < 1.0);
  const std::size_t first = storey * kZonesPerStorey + first_side(index);
  const std::size_t count = last_side(index) - first_side(index) + 1;
  std::array<BoxDemand, 4> demands{};
  for (std::size_t box = 0; box < count; ++box) {
    const Zone& zone = zones()[first + box];
    const double offset_K = truth_.thermostat_offset_K[first + box];
    demands[box] = {
        zone.air(), zone.operative_C(),
        (night ? std::max(rooms.night_cooling_C - 1.0, rooms.cooling_C) : rooms.cooling_C) +
            offset_K,
        (night ? std::min(rooms.night_heating_C + 1.0, rooms.heating_C) : rooms.heating_C) +
            offset_K,
        truth_.thermostat_band_K};
  }
  work_[index] = air_handlers_[index].advance(command, std::span(demands.data(), count),
                                              now.outdoors.air, now.outdoors.pressure_Pa, step_s_);
  for (std::size_t box = 0; box < count; ++box) {
    zone_loads_[first + box].supply_kg_s = air_handlers_[index].supplies()[box].kg_s;
    zone_loads_[first + box].supply = air_handlers_[index].supplies()[box].air;
  }
}

void Building::run_air_handlers(const Moment& now, const Operation& operation) {
  load_.cooling_W = load_.heating_W = load_.fans_W = 0.0;
  for (std::size_t index = 0; index < air_handlers_.size(); ++index) {
    run_air_handler(index, now, operation);
    const double weight = truth_.drawings.storey_weight(index / 2);
    load_.cooling_W += weight * work_[index].cooling_W;
    load_.heating_W +=
        weight * (work_[index].preheat_W + work_[index].reheat_W + work_[index].humidifier_W);
    load_.fans_W += weight * work_[index].fan_W;
  }
}

void Building::add_gains(const Moment& now, const Operation& operation) {
  constexpr double lights_radiant = 0.55;
  constexpr double plugs_radiant = 0.30;
  constexpr double people_radiant = 0.50;
  const Drawings& drawings = truth_.drawings;
  const RoomOperation& rooms = operation.rooms;
  const auto& effects = envelope_.expose(now.outdoors, pressurised_, operation.envelope);
  const auto& powers = internal_loads_.advance(people_, now.local.minute_of_day,
                                               is_open(drawings.open_days, day_kind_));
  const double floor_m2 = drawings.floor_area_m2();
  const double special_m2 = static_cast<double>(drawings.storeys) * drawings.zone_m2(special);
  load_.lights_and_plugs_W = load_.other_electricity_W = load_.other_fuel_W = 0.0;
  double planned_present = 0.0;
  double planned_awake = 0.0;
  for (std::size_t zone = 0; zone < zone_loads_.size(); ++zone) {
    const std::size_t side = zone % kZonesPerStorey;
    const double weight = drawings.storey_weight(zone / kZonesPerStorey);
    const double share = drawings.zone_m2(side) / floor_m2;
    const double server_W =
        side == special ? rooms.server_W * drawings.zone_m2(side) / special_m2 : 0.0;
    const int planned = people_.present(zone, now.local.minute_of_day);
    const double present = planned + share * rooms.extra_people;
    const double drawn_lights_W =
        rooms.lights_factor * powers[zone].lights_W + share * rooms.extra_lights_W;
    const double drawn_plugs_W =
        rooms.plugs_factor * powers[zone].plugs_W + share * rooms.extra_plugs_W + server_W;
    const double people_W = present * drawings.sensible_W_person;
    const double lights_W = truth_.zone_heat_share * drawn_lights_W;
    const double plugs_W = truth_.zone_heat_share * drawn_plugs_W;
    ZoneLoads& loads = zone_loads_[zone];
    loads.radiant_W = lights_radiant * lights_W + plugs_radiant * plugs_W +
                      people_radiant * people_W + effects[zone].transmitted_sun_W;
    loads.convective_W = (1.0 - lights_radiant) * lights_W + (1.0 - plugs_radiant) * plugs_W +
                         (1.0 - people_radiant) * people_W;
    loads.moisture_kg_s = present * drawings.latent_W_person / kEvaporation_J_kg;
    loads.infiltration_kg_s = effects[zone].infiltration_kg_s;
    loads.outdoor = now.outdoors.air;
    load_.lights_and_plugs_W += weight * (drawn_lights_W + drawn_plugs_W);
    planned_present += planned;
    planned_awake += planned * drawings.rooms(side).awake_share(now.local.minute_of_day);
  }
  const double assigned = std::max(1, people_.assigned());
  load_.people_share = planned_present / assigned;
  load_.awake_share = planned_awake / assigned;
  constexpr double dusk_sine = -0.05;  // lamps switch when the sun is 3 degrees below the horizon
  load_.dark = now.outdoors.sun.up < dusk_sine;
}

void Building::exchange_through_doors() {
  const double exchange_kg_s = truth_.drawings.between_rooms_kg_s;
  for (ZoneLoads& loads : zone_loads_) loads.exchange_W = loads.exchange_moisture_kg_s = 0.0;
  for (std::size_t storey = 0; storey < truth_.drawings.storeys_simulated(); ++storey) {
    const std::size_t centre = storey * kZonesPerStorey + core;
    for (const std::size_t side : {south, north, east, west, special}) {
      const std::size_t room = storey * kZonesPerStorey + side;
      const AirState& inner = zones()[centre].air();
      const AirState& outer = zones()[room].air();
      const double heat_W =
          exchange_kg_s * kDryAirHeat_J_kgK * (inner.temperature_C - outer.temperature_C);
      const double moisture_kg_s = exchange_kg_s * (inner.humidity_kg_kg - outer.humidity_kg_kg);
      zone_loads_[room].exchange_W += heat_W;
      zone_loads_[room].exchange_moisture_kg_s += moisture_kg_s;
      zone_loads_[centre].exchange_W -= heat_W;
      zone_loads_[centre].exchange_moisture_kg_s -= moisture_kg_s;
    }
  }
}

void Building::advance_zones() {
  heat_imbalance_J_ = 0.0;
  for (std::size_t zone = 0; zone < zone_loads_.size(); ++zone) {
    Zone& room = envelope_.zones()[zone];
    const double before_J = room.stored_J();
    const ZoneHeat heat = room.advance(zone_loads_[zone], step_s_);
    const double kept_J =
        heat.gains_J + heat.supply_J + heat.infiltration_J + before_J - room.stored_J();
    heat_imbalance_J_ += kept_J;
    zone_imbalance_J_[zone] = kept_J + heat.exchange_J + heat.constructions_J;
  }
  heat_imbalance_J_ += envelope_.exposed_heat_W() * step_s_;
}

UtilityPower Building::advance(const Outdoors& outdoors, metering::Instant instant,
                               const metering::LocalTime& local) {
  if (today_ != local.date) begin_day(local.date);
  const Moment now = moment(outdoors, instant, local);
  Operation operation = as_built();
  for (const auto& effect : effects_) effect->operate(now, operation);
  run_air_handlers(now, operation);
  add_gains(now, operation);
  exchange_through_doors();
  advance_zones();
  for (const auto& effect : effects_) effect->load(now, load_);
  UtilityPower power = plant_.advance(load_, operation.plant, outdoors);
  for (const auto& effect : effects_) effect->supply(now, power);
  return power;
}

}  // namespace recald::simulators
