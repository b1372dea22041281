#include <cmath>
#include <numbers>

#include "simulators/energyplus/changes/changes.hpp"

namespace recald::simulators::energyplus::changes {
namespace {

bool has_chiller(const BuildingYear& building) {
  return has_object(building.model(), "Chiller:Electric:EIR");
}

bool has_cooling_machine(const BuildingYear& building) {
  Json model = building.model();
  return scale_cooling_cop(model, 1.0) > 0;
}

bool has_defrost(const BuildingYear& building) {
  return has_object(building.model(), "Coil:Heating:DX:SingleSpeed");
}

bool has_heat_meter(const BuildingYear& building) {
  return !heating_fuel(building.model()).empty();
}

void chiller_part_load(BuildingYear& building, double share, Rng /*rng*/) {
  constexpr const char* kCurve = "Power taken in vain";
  constexpr double kMost = 1.2;
  building.model()["Curve:Quadratic"][kCurve] = {{"coefficient1_constant", share},
                                                 {"coefficient2_x", 1.0 - share},
                                                 {"coefficient3_x_2", 0.0},
                                                 {"minimum_value_of_x", 0.0},
                                                 {"maximum_value_of_x", kMost}};
  for_each_object(building.model(), "Chiller:Electric:EIR", [&](Json& chiller) {
    chiller
        ["electric_input_to_cooling_output_ratio_function_of_part_load_ratio_"
         "curve_name"] = kCurve;
  });
}

void fouling(BuildingYear& building, double share, Rng /*rng*/) {
  scale_cooling_cop(building.model(), 1.0 / (1.0 + share));
}

void heat_pump_defrost(BuildingYear& building, double factor, Rng /*rng*/) {
  constexpr double kUsual = 0.058333;  // Three and a half minutes an hour.
  for_each_object(building.model(), "Coil:Heating:DX:SingleSpeed", [&](Json& coil) {
    coil["defrost_control"] = "Timed";
    coil["defrost_time_period_fraction"] =
        factor * coil.value("defrost_time_period_fraction", kUsual);
  });
}

void add_heat(BuildingYear& building, const char* name, double W_m2, Quarters shares) {
  const std::string schedule = building.add_schedule(name, std::move(shares));
  add_outside_load(building, name, heating_fuel(building.model()).c_str(),
                   W_m2 * building.around().floor_m2, schedule);
}

void steam_trap_leak(BuildingYear& building, double W_m2, Rng /*rng*/) {
  add_heat(building, "Pipes and traps", W_m2,
           Quarters(building.days().size() * kQuartersPerDay, 1.0));
}

void seasonal_hot_water(BuildingYear& building, double W_m2, Rng /*rng*/) {
  constexpr double kPipe = 0.35;
  constexpr double kSwing = 0.25;  // Of what is drawn: the mains are coldest in late winter.
  Quarters shares;
  const bool has_people = building.has(Role::presence);
  for (std::size_t i = 0; i < building.days().size() * kQuartersPerDay; ++i) {
    const double year = static_cast<double>(i) / static_cast<double>(365 * kQuartersPerDay);
    const double cold = 1.0 + kSwing * std::cos(2.0 * std::numbers::pi * (year - 0.13));
    const double present =
        has_people ? building.schedule(building.names_of(Role::presence).front())[i] : 0.5;
    shares.push_back(std::min((kPipe + (1.0 - kPipe) * present) * cold, 1.0));
  }
  add_heat(building, "More hot water", W_m2, std::move(shares));
}

}  // namespace

void add_plant_changes(std::vector<HiddenChange>& all) {
  all.insert(all.end(),
             {{"chiller_part_load", 0.1, 0.5, "share of full power at no load", has_chiller,
               chiller_part_load},
              {"fouling", 0.1, 1.0, "share more electricity a year after cleaning",
               has_cooling_machine, fouling, Course::sawtooth},
              {"heat_pump_defrost", 1.5, 5.0, "times the usual defrosting", has_defrost,
               heat_pump_defrost},
              {"seasonal_hot_water", 0.5, 8.0, "W/m2 of floor", has_heat_meter, seasonal_hot_water},
              {"steam_trap_leak", 0.3, 6.0, "W/m2 of floor", has_heat_meter, steam_trap_leak}});
}

}  // namespace recald::simulators::energyplus::changes
