#include <algorithm>
#include <cmath>

#include "simulators/energyplus/changes/changes.hpp"

namespace recald::simulators::energyplus::changes {
namespace {

bool has_setpoints(const BuildingYear& building) { return building.has(Role::cooling_setpoint); }

/// `share(day, hour)` of each quarter of an hour.
template <class Share>
Quarters shares_by_hour(const BuildingYear& building, const Share& share) {
  Quarters shares;
  for (std::size_t day = 0; day < building.days().size(); ++day) {
    for (std::size_t quarter = 0; quarter < kQuartersPerDay; ++quarter) {
      shares.push_back(share(day, 0.25 * static_cast<double>(quarter)));
    }
  }
  return shares;
}

bool is_workday(const BuildingYear& building, std::size_t day) {
  return building.kind_of(day) == DayKind::workday;
}

double noon_C(const BuildingYear& building, std::size_t day) {
  return building.weather_at(day, kQuartersPerDay / 2).at_end.air.temperature_C;
}

void cooking(BuildingYear& building, double W_m2, Rng /*rng*/) {
  const std::string schedule =
      building.add_schedule("Kitchen", shares_by_hour(building, [&](std::size_t day, double hour) {
                              if (!is_workday(building, day)) return 0.0;
                              return hour >= 9.0 && hour < 13.0 ? 1.0 : 0.0;
                            }));
  const bool burns = heating_fuel(building.model()) == "NaturalGas";
  add_outside_load(building, "Kitchen", burns ? "NaturalGas" : "Electricity",
                   W_m2 * building.around().floor_m2, schedule);
}

void data_backup_nights(BuildingYear& building, double W_m2, Rng /*rng*/) {
  constexpr unsigned kFirstNights = 2;
  constexpr unsigned kLastNights = 27;
  add_equipment(building, "Night jobs", W_m2,
                building.add_schedule(
                    "Night jobs", shares_by_hour(building, [&](std::size_t day, double hour) {
                      const auto date = static_cast<unsigned>(building.days()[day].day());
                      const bool runs = date <= kFirstNights || date > kLastNights;
                      return runs && (hour < 6.0 || hour >= 21.0) ? 1.0 : 0.0;
                    })));
}

void ev_charging(BuildingYear& building, double W_m2, Rng rng) {
  std::vector<double> cars;
  for (std::size_t day = 0; day < building.days().size(); ++day) {
    cars.push_back(rng.uniform(0.6, 1.0));
  }
  const std::string schedule = building.add_schedule(
      "Cars charge", shares_by_hour(building, [&](std::size_t day, double hour) {
        if (!is_workday(building, day)) return 0.0;
        const double morning = std::exp(-std::pow((hour - 9.5) / 1.2, 2.0));
        const double afternoon = 0.6 * std::exp(-std::pow((hour - 14.0) / 1.2, 2.0));
        return cars[day] * (morning + afternoon);
      }));
  add_outside_load(building, "Car chargers", "Electricity", W_m2 * building.around().floor_m2,
                   schedule);
}

void event_evenings(BuildingYear& building, double share, Rng rng) {
  constexpr double kChance = 0.1;
  constexpr std::size_t kFrom = 72;
  constexpr std::size_t kTo = 92;
  std::vector<bool> happens;
  for (std::size_t day = 0; day < building.days().size(); ++day) {
    happens.push_back(rng.uniform() < kChance);
  }
  for (const Role role : {Role::presence, Role::lights}) {
    building.change(role, [&](std::size_t day, std::size_t quarter, double value) {
      const bool now = happens[day] && quarter >= kFrom && quarter < kTo;
      return now ? std::max(value, share) : value;
    });
  }
  constexpr int kLonger = 20;
  stretch_operation(building,
                    [&](std::size_t day) { return std::pair(0, happens[day] ? kLonger : 0); });
}

void irrigation_pumps(BuildingYear& building, double W_m2, Rng rng) {
  constexpr double kWarm_C = 22.0;
  std::vector<bool> dry;
  for (std::size_t day = 0; day < building.days().size(); ++day) {
    dry.push_back(rng.uniform() < 0.6 && noon_C(building, day) > kWarm_C);
  }
  const std::string schedule = building.add_schedule(
      "Irrigation", shares_by_hour(building, [&](std::size_t day, double hour) {
        return dry[day] && hour >= 1.0 && hour < 5.0 ? 1.0 : 0.0;
      }));
  add_outside_load(building, "Irrigation", "Electricity", W_m2 * building.around().floor_m2,
                   schedule);
}

void open_windows(BuildingYear& building, double m3_s_1000_m2, Rng /*rng*/) {
  constexpr double kPleasant_C[] = {16.0, 27.0};
  const Quarters presence = building.schedule(building.names_of(Role::presence).front());
  Quarters open;
  for (std::size_t i = 0; i < presence.size(); ++i) {
    const double outdoors_C =
        building.weather_at(i / kQuartersPerDay, i % kQuartersPerDay).at_end.air.temperature_C;
    const bool pleasant = outdoors_C > kPleasant_C[0] && outdoors_C < kPleasant_C[1];
    open.push_back(pleasant ? std::min(presence[i], 1.0) : 0.0);
  }
  const std::string schedule = building.add_schedule("Windows open", std::move(open));
  const std::string zones = add_zone_list(building.model());
  building.model()["ZoneInfiltration:DesignFlowRate"]["Open windows"] = {
      {"zone_or_zonelist_or_space_or_spacelist_name", zones},
      {"schedule_name", schedule},
      {"design_flow_rate_calculation_method", "Flow/Area"},
      {"flow_rate_per_floor_area", 1e-3 * m3_s_1000_m2}};
}

void snow_melting(BuildingYear& building, double W_m2, Rng /*rng*/) {
  constexpr double kFrost_C = 1.0;
  constexpr double kDamp = 0.8;
  Quarters on;
  for (std::size_t i = 0; i < building.days().size() * kQuartersPerDay; ++i) {
    const Outdoors& at = building.weather_at(i / kQuartersPerDay, i % kQuartersPerDay).at_end;
    on.push_back(at.air.temperature_C < kFrost_C && at.relative_humidity > kDamp ? 1.0 : 0.0);
  }
  add_outside_load(building, "Ramp and gutters", "Electricity", W_m2 * building.around().floor_m2,
                   building.add_schedule("Frost outside", std::move(on)));
}

void tariff_load_shift(BuildingYear& building, double relaxed_K, Rng /*rng*/) {
  const auto is_summer = [&](std::size_t day) {
    const auto month = static_cast<unsigned>(building.days()[day].month());
    return month >= 6 && month <= 9;
  };
  const double cooled_ahead_K = std::min(0.3 * relaxed_K, 0.8);  // Never down to the heating.
  building.change(Role::cooling_setpoint, [&](std::size_t day, std::size_t quarter, double value) {
    if (!is_summer(day) || !is_workday(building, day)) return value;
    if (quarter >= 56 && quarter < 72) return value + relaxed_K;
    return quarter >= 40 && quarter < 56 ? value - cooled_ahead_K : value;
  });
}

}  // namespace

void add_changes_outside_the_catalogue(std::vector<HiddenChange>& all) {
  all.insert(
      all.end(),
      {{"cooking", 2.0, 20.0, "W/m2 of floor", always, cooking},
       {"data_backup_nights", 2.0, 20.0, "W/m2 of floor", always, data_backup_nights},
       {"ev_charging", 1.0, 20.0, "W/m2 of floor", always, ev_charging},
       {"event_evenings", 0.3, 1.0, "share of the people", has_people, event_evenings},
       {"irrigation_pumps", 1.0, 15.0, "W/m2 of floor", always, irrigation_pumps},
       {"open_windows", 0.2, 3.0, "m3/s for each 1000 m2 of floor", has_people, open_windows},
       {"snow_melting", 2.0, 15.0, "W/m2 of floor", always, snow_melting},
       {"tariff_load_shift", 1.0, 4.0, "K", has_setpoints, tariff_load_shift}});
}

}  // namespace recald::simulators::energyplus::changes
