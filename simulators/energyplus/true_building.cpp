#include "simulators/energyplus/true_building.hpp"

#include <algorithm>
#include <cmath>

#include "simulators/energyplus/model_edits.hpp"

namespace recald::simulators::energyplus {
namespace {

struct Spread {
  const char* name;
  Triangular change;
};

constexpr Spread kSpreads[] = {
    {"lighting", {0.8, 1.0, 1.25}},
    {"plugs", {0.75, 1.0, 1.3}},
    {"occupancy", {0.6, 1.0, 1.4}},
    {"infiltration", {0.5, 1.0, 2.0}},
    {"outdoor_air", {0.75, 1.0, 1.25}},
    {"cooling_setpoint_K", {-1.2, 0.0, 1.2}},
    {"heating_setpoint_K", {-0.8, 0.0, 0.8}},
    {"supply_air_K", {-0.8, 0.0, 0.8}},
    {"supply_reset_K", {0.0, 3.0, 4.5}},
    {"u_opaque", {0.85, 1.0, 1.2}},
    {"u_window", {0.9, 1.0, 1.1}},
    {"shgc", {0.85, 1.0, 1.15}},
    {"cop", {0.85, 1.0, 1.1}},
    {"boiler", {0.93, 1.0, 1.03}},
    {"start_h", {-0.75, 0.0, 0.75}},
    {"stop_h", {-0.75, 0.0, 0.75}},
    {"people_sd", {0.03, 0.08, 0.16}},
    {"plug_sd", {0.02, 0.05, 0.1}},
};

void scale_glazing_u(Json& model, double factor) {
  constexpr double kMost_W_m2K = 7.0;
  for_each_object(model, "WindowMaterial:SimpleGlazingSystem", [&](Json& glazing) {
    glazing["u_factor"] = std::min(factor * glazing["u_factor"].get<double>(), kMost_W_m2K);
  });
}

/// Layers that insulate, with and without mass.
void scale_insulation(Json& model, double u_factor) {
  constexpr double kInsulator_W_mK = 0.08;
  scale(model, "Material:NoMass", {"thermal_resistance"}, 1.0 / u_factor);
  if (!model.contains("Material")) return;
  for (auto& [name, layer] : model["Material"].items()) {
    const double conductivity_W_mK = layer.value("conductivity", 1.0);
    if (conductivity_W_mK < kInsulator_W_mK) layer["conductivity"] = u_factor * conductivity_W_mK;
  }
}

void scale_boilers(Json& model, double factor) {
  scale(model, "Boiler:", {"nominal_thermal_efficiency"}, factor);
  scale(model, "Coil:Heating:", {"burner_efficiency"}, factor);
}

/// Air is supplied warmer the colder it is outside, which drawings do not tell.
void reset_supply(BuildingYear& building, double most_K) {
  constexpr double kFrom_C = 18.0;
  constexpr double kTo_C = 2.0;
  building.change(
      Role::supply_temperature, [&](std::size_t day, std::size_t quarter, double value) {
        const double outdoors_C = building.weather_at(day, quarter).at_end.air.temperature_C;
        return value + most_K * std::clamp((kFrom_C - outdoors_C) / (kFrom_C - kTo_C), 0.0, 1.0);
      });
}

int quarters_of(double hours) { return static_cast<int>(std::lround(4.0 * hours)); }

/// What a day of one year is like for everybody.
struct LivedDay {
  double attendance;
  int late_quarters;
  double left_on;
};

std::vector<LivedDay> draw_days(const BuildingYear& building, const TrueParameters& parameters,
                                std::uint64_t seed) {
  constexpr double kWeeks_s = 14.0 * kDay_s;
  constexpr double kLate_quarters = 1.0;
  constexpr double kFridays = 0.94;
  const double people_sd = parameters.at("people_sd") / std::sqrt(2.0);
  Rng rng = stream_of(seed, Stream::people, static_cast<std::uint64_t>(building.around().year));
  Persistence weeks(kWeeks_s, kDay_s, rng);
  Persistence machines(kWeeks_s, kDay_s, rng);
  std::vector<LivedDay> days;
  for (const metering::Day day : building.days()) {
    const bool is_friday = std::chrono::weekday{std::chrono::sys_days{day}} == std::chrono::Friday;
    const double chance = std::exp(people_sd * (weeks.advance(rng) + rng.normal()));
    const double late = std::clamp(kLate_quarters * rng.normal(), -3.0, 3.0);
    days.push_back({.attendance = chance * (is_friday ? kFridays : 1.0),
                    .late_quarters = static_cast<int>(std::lround(late)),
                    .left_on = std::exp(parameters.at("plug_sd") *
                                        (machines.advance(rng) + 0.5 * rng.normal()))});
  }
  return days;
}

void live(Quarters& quarters, std::size_t day, const LivedDay& habit, bool are_people) {
  double* const first = quarters.data() + day * kQuartersPerDay;
  const std::vector<double> planned(first, first + kQuartersPerDay);
  const double stands = are_people ? 0.0 : *std::ranges::min_element(planned);
  for (std::size_t quarter = 0; quarter < kQuartersPerDay; ++quarter) {
    const auto from = std::clamp(static_cast<int>(quarter) - habit.late_quarters, 0,
                                 static_cast<int>(kQuartersPerDay) - 1);
    const double span = planned[static_cast<std::size_t>(from)] - stands;
    // EnergyPlus takes no share above one.
    first[quarter] = std::min(stands * habit.left_on + habit.attendance * span, 1.0);
  }
}

}  // namespace

TrueParameters draw_true_parameters(std::uint64_t seed) {
  TrueParameters parameters;
  std::uint64_t index = 0;
  for (const Spread& spread : kSpreads) {
    // A stream each: a new one leaves the others as they were.
    Rng rng = stream_of(seed, Stream::building, 20'000 + index++);
    parameters[spread.name] = spread.change.draw(rng);
  }
  return parameters;
}

void make_true(BuildingYear& building, const TrueParameters& parameters) {
  Json& model = building.model();
  scale_lights(model, parameters.at("lighting"));
  scale_equipment(model, parameters.at("plugs"));
  scale_people(model, parameters.at("occupancy"));
  scale_infiltration(model, parameters.at("infiltration"));
  scale_outdoor_air(model, parameters.at("outdoor_air"));
  scale_insulation(model, parameters.at("u_opaque"));
  scale_glazing_u(model, parameters.at("u_window"));
  scale_solar_gain(model, parameters.at("shgc"));
  scale_cooling_cop(model, parameters.at("cop"));
  scale_boilers(model, parameters.at("boiler"));
  const auto add = [&](Role role, const char* name) {
    building.change(
        role, [&](std::size_t, std::size_t, double value) { return value + parameters.at(name); });
  };
  add(Role::cooling_setpoint, "cooling_setpoint_K");
  add(Role::heating_setpoint, "heating_setpoint_K");
  add(Role::supply_temperature, "supply_air_K");
  reset_supply(building, parameters.at("supply_reset_K"));
  const std::pair hours{quarters_of(parameters.at("start_h")),
                        quarters_of(parameters.at("stop_h"))};
  stretch_operation(building, [&](std::size_t /*day*/) { return hours; });
}

void follow_habits(BuildingYear& building, const TrueParameters& parameters, std::uint64_t seed) {
  const std::vector<LivedDay> days = draw_days(building, parameters, seed);
  for (const Role role : {Role::presence, Role::lights, Role::equipment}) {
    for (const std::string& name : building.names_of(role)) {
      Quarters& quarters = building.schedule(name);
      for (std::size_t day = 0; day < days.size(); ++day) {
        live(quarters, day, days[day], role == Role::presence);
      }
    }
  }
}

}  // namespace recald::simulators::energyplus
