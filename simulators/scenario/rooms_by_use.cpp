#include "simulators/scenario/rooms_by_use.hpp"

#include <algorithm>

namespace recald::simulators {
namespace {

constexpr HourlyShares kNobody{};
constexpr HourlyShares kAllAwake{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
                                 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
constexpr HourlyShares kAsleepAtNight{0.25, 0.08, 0.06, 0.06, 0.06, 0.15, 0.6, 0.9,
                                      0.9,  0.8,  0.8,  0.8,  0.8,  0.8,  0.8, 0.8,
                                      0.85, 0.9,  0.95, 1.0,  1.0,  0.9,  0.7, 0.45};

void furnish_office(Drawings& drawings) {
  drawings.perimeter_rooms = {1.1, 8.4, 8.8, 0.05, 0.05, 9.0, 10.0, 0.28, 0.62, 0.0, 0.03, false};
  drawings.core_rooms = {1.0, 8.6, 8.8, 0.04, 0.05, 9.0, 11.0, 0.26, 0.62, 0.0, 0.03, false};
  drawings.special_rooms = {0.0, 0.0, 0.0, 0.0, 0.0, 8.0, 90.0, 0.62, 0.0, 0.08, 0.03, false};
  drawings.special_share_of_core = 0.06;  // closets with servers and copiers
  drawings.occupancy_person_m2 = 0.05;
  drawings.core_runs_always = false;
  drawings.core_min_share = 0.30;
  drawings.perimeter_min_share = 0.30;
  drawings.occupied_from_h = 7.0;
  drawings.occupied_to_h = 19.0;
  drawings.night_cooling_C = 29.0;
  drawings.presence_workday = {0,    0,    0,    0,    0,    0.01, 0.05, 0.22,
                               0.55, 0.77, 0.79, 0.78, 0.61, 0.70, 0.79, 0.78,
                               0.66, 0.36, 0.14, 0.05, 0.03, 0.01, 0,    0};
  drawings.presence_saturday = {0,    0,    0,    0,    0,    0, 0, 0, 0, 0.01, 0.01, 0.02,
                                0.02, 0.02, 0.02, 0.01, 0.01, 0, 0, 0, 0, 0,    0,    0};
  drawings.presence_sunday = drawings.presence_saturday;
}

void furnish_school(Drawings& drawings) {
  drawings.perimeter_rooms = {1.25, 7.8, 7.1, 0.02, 0.03, 9.5, 5.0, 0.20, 0.55, 0.0, 0.03, false};
  drawings.core_rooms = {1.0, 7.9, 7.2, 0.02, 0.05, 8.5, 4.0, 0.25, 0.40, 0.0, 0.03, false};
  drawings.special_rooms = {0.0, 0.0, 0.0, 0.0, 0.0, 9.0, 35.0, 0.22, 0.0, 0.38, 0.05, true};
  drawings.special_share_of_core = 0.2;  // kitchen and computer rooms
  drawings.occupancy_person_m2 = 0.14;
  drawings.sensible_W_person = 65.0;
  drawings.latent_W_person = 45.0;
  drawings.core_runs_always = false;
  drawings.core_min_share = 0.40;
  drawings.perimeter_min_share = 0.40;
  drawings.occupied_from_h = 7.0;
  drawings.occupied_to_h = 17.0;
  drawings.presence_workday = {0,    0,    0,    0,    0,    0,    0.12, 0.57,
                               0.79, 0.80, 0.80, 0.79, 0.63, 0.72, 0.72, 0.30,
                               0.08, 0.03, 0.02, 0.02, 0.01, 0,    0,    0};
  drawings.presence_saturday = {0,    0,    0,    0,    0, 0, 0, 0, 0, 0, 0.01, 0.01,
                                0.01, 0.01, 0.01, 0.01, 0, 0, 0, 0, 0, 0, 0,    0};
  drawings.presence_sunday = drawings.presence_saturday;
}

/// Rooms described fully by these numbers: `visits` gives the people.
RoomUse rooms_with(double lighting_W_m2, double plugs_W_m2, double standing, double people,
                   double working) {
  RoomUse rooms{};
  rooms.crowding = 1.0;
  rooms.lighting_W_m2 = lighting_W_m2;
  rooms.plugs_W_m2 = plugs_W_m2;
  rooms.plugs_standing_share = standing;
  rooms.plugs_people_share = people;
  rooms.plugs_working_share = working;
  rooms.plugs_habit = 0.03;
  return rooms;
}

void open_from(Drawings& drawings, OpenDays days, double from_h, double to_h) {
  drawings.open_days = days;
  drawings.core_runs_always = false;
  drawings.occupied_from_h = drawings.working_from_h = from_h;
  drawings.occupied_to_h = drawings.working_to_h = to_h;
  drawings.cleaning_from_h = to_h;
  drawings.cleaning_to_h = std::min(to_h + 1.5, 24.0);
}

/// A sales floor on which customers stay for most of an hour, with stores and staff rooms inside
/// it. Closed on Sundays, because a site file has no Sunday hours.
void furnish_shop(Drawings& drawings) {
  const Visits customers{
      .stay_h = 0.9,
      .workday = {0,    0,    0,    0,    0,    0,    0.03, 0.08, 0.22, 0.42, 0.52, 0.60,
                  0.70, 0.66, 0.60, 0.66, 0.76, 0.80, 0.68, 0.48, 0.24, 0,    0,    0},
      .saturday = {0,    0,    0,    0,    0,    0,    0.03, 0.08, 0.26, 0.54, 0.74, 0.86,
                   0.90, 0.90, 0.88, 0.85, 0.80, 0.68, 0.50, 0.34, 0.18, 0,    0,    0},
      .sunday = kNobody,
      .awake = kAllAwake};
  drawings.perimeter_rooms = rooms_with(16.0, 4.0, 0.25, 0.0, 0.60);
  drawings.core_rooms = rooms_with(17.0, 5.0, 0.25, 0.0, 0.60);
  drawings.special_rooms = rooms_with(9.0, 8.0, 0.35, 0.0, 0.40);
  for (RoomUse* floor : {&drawings.perimeter_rooms, &drawings.core_rooms}) {
    floor->lit_while_open = true;
    floor->visits = customers;
  }
  drawings.special_share_of_core = 0.12;
  drawings.storey_height_m = 6.1;
  drawings.between_rooms_kg_s = 3.0;  // one floor
  drawings.hall = true;
  drawings.occupancy_person_m2 = 0.10;
  open_from(drawings, OpenDays::workdays_and_saturdays, 7.0, 21.0);
  drawings.core_min_share = 0.35;
  drawings.perimeter_min_share = 0.35;
  drawings.night_cooling_C = 30.0;
  drawings.night_heating_C = 15.0;
}

/// Guest rooms along the facades, corridors, lobby and dining in the core, kitchen and laundry
/// inside it. There is no set-back, and every day is alike.
void furnish_hotel(Drawings& drawings) {
  const Visits guests{
      .stay_h = 8.0,
      .workday = {0.70, 0.70, 0.70, 0.70, 0.70, 0.68, 0.58, 0.40, 0.30, 0.22, 0.17, 0.16,
                  0.16, 0.16, 0.17, 0.20, 0.28, 0.36, 0.42, 0.48, 0.54, 0.60, 0.66, 0.69},
      .saturday = {0.68, 0.68, 0.68, 0.68, 0.68, 0.68, 0.64, 0.56, 0.46, 0.36, 0.28, 0.24,
                   0.24, 0.24, 0.24, 0.27, 0.34, 0.42, 0.48, 0.52, 0.56, 0.62, 0.66, 0.68},
      .sunday = {0.64, 0.64, 0.64, 0.64, 0.64, 0.64, 0.60, 0.52, 0.42, 0.32, 0.26, 0.22,
                 0.20, 0.20, 0.20, 0.24, 0.30, 0.38, 0.46, 0.52, 0.58, 0.64, 0.68, 0.70},
      .awake = kAsleepAtNight};
  drawings.perimeter_rooms = rooms_with(9.0, 9.0, 0.18, 0.50, 0.0);
  drawings.core_rooms = rooms_with(9.0, 6.0, 0.30, 0.20, 0.20);
  drawings.special_rooms = rooms_with(11.0, 70.0, 0.14, 0.10, 0.12);
  drawings.perimeter_rooms.visits = drawings.core_rooms.visits = guests;
  drawings.core_rooms.lit_while_open = true;
  drawings.special_rooms.appliance_runs = true;
  drawings.special_share_of_core = 0.2;
  drawings.perimeter_depth_m = std::min(7.0, 0.35 * drawings.width_m);
  drawings.storey_height_m = 3.1;
  drawings.occupancy_person_m2 = 0.05;
  drawings.sensible_W_person = 68.0;
  drawings.latent_W_person = 42.0;
  open_from(drawings, OpenDays::every_day, 0.0, 24.0);
  drawings.cleaning_to_h = drawings.cleaning_from_h;  // by day, room after room
  drawings.perimeter_runs_always = drawings.core_runs_always = true;
  drawings.core_night_share = 1.0;
  drawings.core_min_share = 0.30;
  drawings.perimeter_min_share = 0.30;
  drawings.night_cooling_C = drawings.cooling_setpoint_C;
  drawings.night_heating_C = drawings.heating_setpoint_C;
}

/// Consulting rooms by day along the facades, wards and emergency day and night in the core,
/// imaging and sterilisation inside it.
void furnish_clinic(Drawings& drawings) {
  const Visits by_day{
      .stay_h = 1.0,
      .workday = {0,    0,    0,    0,    0,    0,    0.04, 0.18, 0.52, 0.78, 0.82, 0.80,
                  0.66, 0.72, 0.80, 0.76, 0.56, 0.26, 0.08, 0.02, 0,    0,    0,    0},
      .saturday = kNobody,
      .sunday = kNobody,
      .awake = kAllAwake};
  const Visits wards{
      .stay_h = 20.0,
      .workday = {0.50, 0.50, 0.50, 0.50, 0.50, 0.50, 0.54, 0.62, 0.70, 0.74, 0.76, 0.76,
                  0.75, 0.75, 0.76, 0.76, 0.74, 0.70, 0.66, 0.62, 0.58, 0.54, 0.52, 0.51},
      .saturday = {0.50, 0.50, 0.50, 0.50, 0.50, 0.50, 0.51, 0.54, 0.57, 0.60, 0.62, 0.62,
                   0.62, 0.62, 0.64, 0.64, 0.62, 0.60, 0.58, 0.55, 0.53, 0.51, 0.50, 0.49},
      .sunday = {0.48, 0.48, 0.48, 0.48, 0.48, 0.48, 0.49, 0.52, 0.55, 0.58, 0.60, 0.60,
                 0.60, 0.60, 0.62, 0.62, 0.60, 0.58, 0.56, 0.54, 0.52, 0.50, 0.49, 0.49},
      .awake = kAsleepAtNight};
  drawings.perimeter_rooms = rooms_with(11.0, 13.0, 0.22, 0.40, 0.12);
  drawings.core_rooms = rooms_with(13.0, 18.0, 0.36, 0.30, 0.06);
  drawings.special_rooms = rooms_with(13.0, 110.0, 0.26, 0.0, 0.14);
  drawings.perimeter_rooms.visits = by_day;
  drawings.core_rooms.visits = wards;
  drawings.special_rooms.appliance_runs = true;
  drawings.special_share_of_core = 0.12;
  drawings.storey_height_m = 4.0;
  drawings.occupancy_person_m2 = 0.07;
  open_from(drawings, OpenDays::workdays, 7.0, 18.0);
  drawings.core_runs_always = true;
  drawings.core_night_share = 0.85;
  drawings.core_min_share = 0.50;
  drawings.perimeter_min_share = 0.40;
  drawings.night_cooling_C = 28.0;
  drawings.night_heating_C = 18.0;
}

/// High racks in the core, docks and a few desks along the facades, a charging station. Kept
/// between 16 and 27 degC, doors open all day, two shifts.
void furnish_warehouse(Drawings& drawings) {
  const Visits shifts{
      .stay_h = 6.0,
      .workday = {0,    0,    0,    0,    0,    0.06, 0.46, 0.82, 0.88, 0.88, 0.84, 0.70,
                  0.76, 0.86, 0.86, 0.80, 0.56, 0.34, 0.28, 0.26, 0.16, 0,    0,    0},
      .saturday = {0,    0,    0, 0, 0, 0.02, 0.12, 0.20, 0.20, 0.20, 0.18, 0.16,
                   0.10, 0.03, 0, 0, 0, 0,    0,    0,    0,    0,    0,    0},
      .sunday = kNobody,
      .awake = kAllAwake};
  drawings.perimeter_rooms = rooms_with(8.0, 4.0, 0.20, 0.30, 0.25);
  drawings.core_rooms = rooms_with(7.5, 1.6, 0.20, 0.20, 0.40);
  drawings.special_rooms = rooms_with(8.0, 60.0, 0.18, 0.0, 0.32);
  drawings.perimeter_rooms.visits = drawings.core_rooms.visits = shifts;
  drawings.core_rooms.lit_while_open = true;
  drawings.perimeter_rooms.crowding = 1.6;
  drawings.special_share_of_core = 0.02;
  drawings.storey_height_m = 8.0;
  drawings.between_rooms_kg_s = 2.0;
  drawings.leakage_cm2_m2 = 2.0;
  drawings.hall = true;
  drawings.occupancy_person_m2 = 0.005;
  drawings.sensible_W_person = 100.0;
  drawings.latent_W_person = 135.0;
  open_from(drawings, OpenDays::workdays_and_saturdays, 5.0, 21.0);
  drawings.core_min_share = 0.15;
  drawings.perimeter_min_share = 0.15;
  drawings.special_min_share = 0.20;
  drawings.cooling_setpoint_C = 27.0;
  drawings.heating_setpoint_C = 16.0;
  drawings.heating_setpoint_min_C = 15.3;
  drawings.heating_setpoint_max_C = 16.9;
  drawings.night_cooling_C = 32.0;
  drawings.night_heating_C = 11.0;
}

/// Dining rooms along the facades, and in the core a bar and a kitchen that cooks with electricity
/// under hoods: it counts as plugs, whose heat the hoods remove. Closed on Sundays and Mondays.
void furnish_restaurant(Drawings& drawings) {
  const Visits diners{
      .stay_h = 1.1,
      .workday = {0,    0,    0,    0,    0,    0,    0,    0,    0.02, 0.06, 0.12, 0.34,
                  0.74, 0.66, 0.32, 0.15, 0.16, 0.34, 0.70, 0.84, 0.76, 0.48, 0.18, 0},
      .saturday = {0,    0,    0,    0,    0,    0,    0,    0,    0.02, 0.06, 0.12, 0.30,
                   0.62, 0.62, 0.40, 0.24, 0.26, 0.46, 0.82, 0.92, 0.90, 0.60, 0.24, 0},
      .sunday = kNobody,
      .awake = kAllAwake};
  drawings.perimeter_rooms = rooms_with(15.0, 4.0, 0.30, 0.30, 0.10);
  drawings.core_rooms = rooms_with(14.0, 22.0, 0.40, 0.20, 0.10);
  drawings.special_rooms = rooms_with(13.0, 330.0, 0.09, 0.34, 0.14);
  drawings.perimeter_rooms.visits = drawings.core_rooms.visits = diners;
  for (RoomUse* rooms :
       {&drawings.perimeter_rooms, &drawings.core_rooms, &drawings.special_rooms}) {
    rooms->lit_while_open = true;
  }
  drawings.perimeter_rooms.crowding = 1.25;
  drawings.perimeter_depth_m = std::min(5.0, 0.22 * drawings.width_m);
  drawings.special_share_of_core = 0.6;
  drawings.zone_heat_share = 0.6;
  drawings.between_rooms_kg_s = 0.3;
  drawings.hall = true;
  drawings.occupancy_person_m2 = 0.35;
  drawings.sensible_W_person = 80.0;  // includes the heat of the meal
  drawings.latent_W_person = 80.0;
  open_from(drawings, OpenDays::workdays_and_saturdays, 9.0, 23.0);
  drawings.core_min_share = 0.45;
  drawings.perimeter_min_share = 0.45;
  drawings.special_min_share = 0.40;
  drawings.night_heating_C = 16.0;
}

/// Halls along the facades and in the core, changing rooms and showers inside it. Busy
/// mornings and evenings.
void furnish_gym(Drawings& drawings) {
  const Visits members{
      .stay_h = 1.2,
      .workday = {0,    0,    0,    0,    0,    0.06, 0.36, 0.54, 0.42, 0.34, 0.32, 0.38,
                  0.52, 0.38, 0.26, 0.30, 0.50, 0.82, 0.92, 0.80, 0.52, 0.22, 0,    0},
      .saturday = {0,    0,    0,    0,    0,    0.02, 0.10, 0.26, 0.46, 0.62, 0.64, 0.56,
                   0.44, 0.36, 0.34, 0.36, 0.38, 0.34, 0.26, 0.16, 0.08, 0.03, 0,    0},
      .sunday = kNobody,
      .awake = kAllAwake};
  drawings.perimeter_rooms = rooms_with(12.0, 12.0, 0.12, 0.55, 0.0);
  drawings.core_rooms = rooms_with(12.0, 10.0, 0.12, 0.50, 0.05);
  drawings.special_rooms = rooms_with(9.0, 8.0, 0.20, 0.50, 0.0);
  drawings.perimeter_rooms.visits = drawings.core_rooms.visits = members;
  drawings.perimeter_rooms.lit_while_open = drawings.core_rooms.lit_while_open = true;
  drawings.special_share_of_core = 0.3;
  drawings.storey_height_m = 5.0;
  drawings.between_rooms_kg_s = 1.0;
  drawings.hall = true;
  drawings.occupancy_person_m2 = 0.09;
  drawings.sensible_W_person = 130.0;
  drawings.latent_W_person = 190.0;
  open_from(drawings, OpenDays::workdays_and_saturdays, 5.0, 22.0);
  drawings.core_min_share = 0.40;
  drawings.perimeter_min_share = 0.40;
  drawings.night_heating_C = 16.0;
}

HourlyShares mixed(const HourlyShares& perimeter, const HourlyShares& in_core, double share) {
  HourlyShares both{};
  for (std::size_t hour = 0; hour < both.size(); ++hour) {
    both[hour] = share * perimeter[hour] + (1.0 - share) * in_core[hour];
  }
  return both;
}

/// Sets the site file's presence from the visits, and the hot water that follows it: over an
/// ordinary week it equals the daily amount drawn.
void quote_presence(Drawings& drawings) {
  if (!drawings.perimeter_rooms.visits || !drawings.core_rooms.visits) return;
  const Visits& outer = *drawings.perimeter_rooms.visits;
  const Visits& inner = *drawings.core_rooms.visits;
  const double share = drawings.perimeter_people_share();
  const auto quote = [&](HourlyShares Visits::*day) {
    return mixed(hourly_means(outer.*day), hourly_means(inner.*day), share);
  };
  drawings.presence_workday = quote(&Visits::workday);
  drawings.presence_saturday = quote(&Visits::saturday);
  drawings.presence_sunday = quote(&Visits::sunday);
  double awake_hours = 0.0;
  for (std::size_t hour = 0; hour < 24; ++hour) {
    const auto week = [&](const Visits& visits) {
      return visits.awake[hour] *
             (5.0 * visits.workday[hour] + visits.saturday[hour] + visits.sunday[hour]);
    };
    awake_hours += share * week(outer) + (1.0 - share) * week(inner);
  }
  drawings.hot_water_with_people = 0.75 * 7.0 * 24.0 / awake_hours;
}

}  // namespace

void furnish(Drawings& drawings) {
  switch (drawings.use) {
    case Use::laboratory:
      break;
    case Use::office:
      furnish_office(drawings);
      break;
    case Use::school:
      furnish_school(drawings);
      break;
    case Use::shop:
      furnish_shop(drawings);
      break;
    case Use::hotel:
      furnish_hotel(drawings);
      break;
    case Use::clinic:
      furnish_clinic(drawings);
      break;
    case Use::warehouse:
      furnish_warehouse(drawings);
      break;
    case Use::restaurant:
      furnish_restaurant(drawings);
      break;
    case Use::gym:
      furnish_gym(drawings);
      break;
  }
  // There are people in the perimeter even where the core is thin.
  drawings.perimeter_rooms.crowding =
      std::min(drawings.perimeter_rooms.crowding, 0.9 / drawings.perimeter_floor_share());
  quote_presence(drawings);
}

}  // namespace recald::simulators
