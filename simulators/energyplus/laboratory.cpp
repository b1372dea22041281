#include "simulators/energyplus/laboratory.hpp"

#include "simulators/energyplus/parts/air_handler.hpp"

namespace recald::simulators::energyplus {
namespace {

constexpr double kLength_m = 80.0;
constexpr double kStorey_m = 4.0;
constexpr double kWindowShare = 0.35;
/// Borders between the rooms of a storey, from south to north.
constexpr std::array<double, 4> kBorders_m{0.0, 8.0, 32.0, 40.0};
constexpr std::array<const char*, 3> kStripNames{"Office south", "Laboratory", "Office north"};
constexpr std::size_t kStrips = kStripNames.size();
constexpr std::size_t kLaboratoryStrip = 1;

/// Of supply air at full flow.
constexpr double kOfficeSupply_m3_s_m2 = 0.0060;
constexpr double kLaboratorySupply_m3_s_m2 = 0.0075;
constexpr double kOfficeMinimumShare = 0.35;
constexpr double kLaboratoryMinimumShare = 0.75;
constexpr double kReheat_W_m2 = 110.0;

constexpr WeeklyShares kOfficePresence{
    .workday = {0,    0,    0,    0,    0,    0,    0.03, 0.15, 0.41, 0.67, 0.78, 0.79,
                0.62, 0.68, 0.79, 0.80, 0.72, 0.46, 0.19, 0.07, 0.04, 0.03, 0.01, 0},
    .saturday = {0,    0,    0,    0,    0,    0,    0,    0.01, 0.02, 0.03, 0.05, 0.06,
                 0.06, 0.06, 0.05, 0.04, 0.03, 0.02, 0.01, 0.01, 0,    0,    0,    0},
    .sunday = {0,    0,    0,    0,    0,    0,    0,    0, 0.01, 0.02, 0.03, 0.03,
               0.03, 0.03, 0.03, 0.02, 0.02, 0.01, 0.01, 0, 0,    0,    0,    0}};
constexpr WeeklyShares kLaboratoryPresence{
    .workday = {0.02, 0.02, 0.01, 0.01, 0.01, 0.01, 0.03, 0.10, 0.32, 0.60, 0.75, 0.78,
                0.66, 0.70, 0.80, 0.80, 0.74, 0.55, 0.36, 0.26, 0.20, 0.14, 0.08, 0.04},
    .saturday = {0.02, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.02, 0.05, 0.10, 0.15, 0.18,
                 0.18, 0.18, 0.18, 0.17, 0.15, 0.12, 0.09, 0.07, 0.05, 0.04, 0.03, 0.02},
    .sunday = {0.02, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.03, 0.06, 0.09, 0.11,
               0.12, 0.12, 0.12, 0.11, 0.10, 0.09, 0.07, 0.06, 0.05, 0.04, 0.03, 0.02}};

/// The offices' outdoor air stops at night and on Sundays.
WeeklyShares office_hours() {
  WeeklyShares open{};
  for (std::size_t hour = 6; hour < 20; ++hour) open.workday[hour] = 1.0;
  for (std::size_t hour = 8; hour < 14; ++hour) open.saturday[hour] = 1.0;
  return open;
}

std::string room_name(std::size_t strip, std::size_t storey) {
  return std::string{kStripNames[strip]} + " " + std::to_string(storey + 1);
}

Room room_at(std::size_t strip, std::size_t storey) {
  using What = Beyond::What;
  const Beyond facade{.what = What::outdoors, .room = {}, .window_share = kWindowShare};
  // The laboratories' narrow ends are shafts and stairs.
  const Beyond end = strip == kLaboratoryStrip ? Beyond{} : facade;
  const auto beside = [&](std::size_t other) {
    return Beyond{.what = What::room, .room = room_name(other, storey), .window_share = 0.0};
  };
  const auto on_storey = [&](std::size_t other) {
    return Beyond{.what = What::room, .room = room_name(strip, other), .window_share = 0.0};
  };
  const auto level = static_cast<double>(storey);
  Room room{.name = room_name(strip, storey),
            .x_m = {0.0, kLength_m},
            .y_m = {kBorders_m[strip], kBorders_m[strip + 1]},
            .z_m = {level * kStorey_m, (level + 1.0) * kStorey_m},
            .beyond = {}};
  room.beyond[south] = strip == 0 ? facade : beside(strip - 1);
  room.beyond[north] = strip + 1 == kStrips ? facade : beside(strip + 1);
  room.beyond[east] = end;
  room.beyond[west] = end;
  room.beyond[ceiling] = storey + 1 == kLaboratoryStoreys ? Beyond{} : on_storey(storey + 1);
  room.beyond[floor_face] = storey == 0 ? Beyond{.what = What::ground} : on_storey(storey - 1);
  return room;
}

struct Rooms {
  std::vector<Room> offices;
  std::vector<Room> laboratories;
};

Rooms rooms_of_building() {
  Rooms rooms;
  for (std::size_t storey = 0; storey < kLaboratoryStoreys; ++storey) {
    for (std::size_t strip = 0; strip < kStrips; ++strip) {
      (strip == kLaboratoryStrip ? rooms.laboratories : rooms.offices)
          .push_back(room_at(strip, storey));
    }
  }
  return rooms;
}

std::vector<std::string> names_of(const std::vector<Room>& rooms) {
  std::vector<std::string> names;
  for (const Room& room : rooms) names.push_back(room.name);
  return names;
}

void add_people_and_machines(Json& model, const Rooms& rooms,
                             const LaboratoryParameters& parameters) {
  for (const PeopleSchedule& schedule : laboratory_schedules()) {
    add_weekly(model, schedule.name, schedule.weekly());
  }
  add_loads(model, {.of = "Offices",
                    .rooms = names_of(rooms.offices),
                    .people_person_m2 = parameters.office_person_m2,
                    .lighting_W_m2 = parameters.office_lighting_W_m2,
                    .equipment_W_m2 = parameters.office_equipment_W_m2});
  add_loads(model, {.of = "Laboratories",
                    .rooms = names_of(rooms.laboratories),
                    .people_person_m2 = parameters.laboratory_person_m2,
                    .lighting_W_m2 = parameters.laboratory_lighting_W_m2,
                    .equipment_W_m2 = parameters.laboratory_equipment_W_m2});
}

Terminal terminal_of(const Room& room, double supply_m3_s_m2, double minimum_share) {
  return {.room = room.name,
          .supply_m3_s = supply_m3_s_m2 * room.floor_m2(),
          .minimum_share = minimum_share,
          .reheat_W = kReheat_W_m2 * room.floor_m2()};
}

std::vector<AirHandler> handlers_of(Json& model, const Rooms& rooms,
                                    const LaboratoryParameters& parameters) {
  constexpr double kPreheat_C = 9.0;
  std::vector<AirHandler> handlers;
  AirHandler& offices = handlers.emplace_back(
      AirHandler{.name = "Office handler",
                 .supply_C = parameters.supply_air_C,
                 .preheat_C = kPreheat_C,
                 .outdoor_m3_s = parameters.office_outdoor_m3_s,
                 .outdoor_schedule = add_weekly(model, "Office hours", office_hours()),
                 .fan_pressure_Pa = parameters.fan_pressure_Pa,
                 .terminals = {}});
  for (const Room& room : rooms.offices) {
    offices.terminals.push_back(terminal_of(room, kOfficeSupply_m3_s_m2, kOfficeMinimumShare));
  }
  for (std::size_t storey = 0; storey < rooms.laboratories.size(); ++storey) {
    handlers.push_back(
        {.name = "Laboratory handler " + std::to_string(storey + 1),
         .supply_C = parameters.supply_air_C,
         .preheat_C = kPreheat_C,
         .outdoor_m3_s = parameters.laboratory_outdoor_m3_s[storey],
         .outdoor_schedule = add_constant(model, "Always", 1.0),
         .fan_pressure_Pa = parameters.fan_pressure_Pa,
         .terminals = {terminal_of(rooms.laboratories[storey], kLaboratorySupply_m3_s_m2,
                                   kLaboratoryMinimumShare)}});
  }
  return handlers;
}

}  // namespace

std::vector<PeopleSchedule> laboratory_schedules() {
  return {{"Offices presence", kOfficePresence},
          {"Offices lights on", kOfficePresence, 0.08, 1.0},
          {"Offices equipment on", kOfficePresence, 0.30, 0.75},
          {"Laboratories presence", kLaboratoryPresence},
          {"Laboratories lights on", kLaboratoryPresence, 0.15, 0.95},
          {"Laboratories equipment on", kLaboratoryPresence, 0.45, 0.40}};
}

Json laboratory_model(const LaboratoryParameters& parameters) {
  Json model = empty_model("Campus laboratory", parameters.ground_C);
  add_constructions(model, parameters.envelope);
  const Rooms rooms = rooms_of_building();
  for (const Room& room : rooms.offices) add_room(model, room);
  for (const Room& room : rooms.laboratories) add_room(model, room);
  add_people_and_machines(model, rooms, parameters);
  std::vector<std::string> all = names_of(rooms.offices);
  for (const Room& room : rooms.laboratories) all.push_back(room.name);
  add_infiltration(model, "Facade", all, parameters.infiltration_m3_s_m2);
  add_thermostats(model, all, parameters.heating_setpoint_C, parameters.cooling_setpoint_C);

  const WaterDesign design;
  WaterLoop chilled{.of = WaterLoop::Of::cooling,
                    .supply_C = parameters.chilled_water_C,
                    .pump_head_Pa = 180'000.0,
                    .coils = {}};
  WaterLoop hot{.of = WaterLoop::Of::heating,
                .supply_C = design.hot_C,
                .pump_head_Pa = 120'000.0,
                .coils = {}};
  for (const AirHandler& handler : handlers_of(model, rooms, parameters)) {
    const HandlerCoils coils = add_air_handler(model, handler, design);
    chilled.coils.push_back(coils.cooling);
    hot.coils.insert(hot.coils.end(), coils.heating.begin(), coils.heating.end());
  }
  add_water_loop(model, chilled);
  add_water_loop(model, hot);
  return model;
}

}  // namespace recald::simulators::energyplus
