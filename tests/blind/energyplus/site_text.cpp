#include "tests/blind/energyplus/site_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "simulators/energyplus/model_edits.hpp"
#include "tests/blind/population/significant_digits.hpp"

namespace recald::blind {
namespace {

using namespace simulators;
using namespace simulators::energyplus;

double number_in(const Table& table, const std::string& row, const std::string& column) {
  const auto found = table.find(row);
  if (found == table.end()) return 0.0;
  const auto value = found->second.find(column);
  return value == found->second.end() ? 0.0 : std::strtod(value->second.c_str(), nullptr);
}

const Table& table_of(const SizedModel& sized, const std::string& name) {
  static const Table kNone;
  const auto found = sized.tables.find(name);
  return found == sized.tables.end() ? kNone : found->second;
}

/// What an engineer remembers of a number: off by some per cent, and rounded.
class Memory {
 public:
  explicit Memory(Rng rng) : rng_(rng) {}
  double of(double value, double spread) {
    constexpr int kDigits = 2;
    return rounded(value * std::exp(spread * rng_.normal()), kDigits);
  }

 private:
  Rng rng_;
};

/// Walls and windows to one side, roofs, floors.
struct Surface {
  double area_m2 = 0.0;
  double area_u_W_K = 0.0;
  double area_absorbed_m2 = 0.0;  ///< Or solar gain, of windows.
};

enum class Kind { wall, window, skylight, roof, ground };

using Envelope = std::map<std::pair<Kind, int>, Surface>;  ///< By kind and azimuth, deg.

int side_of(double azimuth_deg) {
  constexpr double kQuarterTurn_deg = 90.0;
  return static_cast<int>(std::lround(azimuth_deg / kQuarterTurn_deg)) % 4 * 90;
}

Envelope envelope_of(const SizedModel& sized) {
  constexpr double kFlat_deg = 45.0;
  constexpr double kDown_deg = 150.0;
  const Table& zones = table_of(sized, "Zone Summary");
  Envelope envelope;
  const Table& opaque = table_of(sized, "Opaque Exterior");
  for (const auto& [name, row] : opaque) {
    const double tilt_deg = number_in(opaque, name, "Tilt");
    const double many = std::max(number_in(zones, row.at("Zone"), "Multipliers"), 1.0);
    const double area_m2 = many * number_in(opaque, name, "Net Area");
    const Kind kind = tilt_deg > kDown_deg   ? Kind::ground
                      : tilt_deg < kFlat_deg ? Kind::roof
                                             : Kind::wall;
    const int side = kind == Kind::wall ? side_of(number_in(opaque, name, "Azimuth")) : 0;
    Surface& surface = envelope[{kind, side}];
    surface.area_m2 += area_m2;
    surface.area_u_W_K += area_m2 * number_in(opaque, name, "U-Factor with Film");
    surface.area_absorbed_m2 += area_m2 * (1.0 - number_in(opaque, name, "Reflectance"));
  }
  const Table& glass = table_of(sized, "Exterior Fenestration");
  for (const auto& [name, row] : glass) {
    if (!row.contains("Zone") || row.at("Zone").empty()) continue;  // sums
    const double many = std::max(number_in(zones, row.at("Zone"), "Multipliers"), 1.0);
    const double area_m2 = many * number_in(glass, name, "Area of Multiplied Openings");
    const bool is_flat = number_in(glass, name, "Tilt") < kFlat_deg;
    const Kind kind = is_flat ? Kind::skylight : Kind::window;
    Surface& surface = envelope[{kind, is_flat ? 0 : side_of(number_in(glass, name, "Azimuth"))}];
    surface.area_m2 += area_m2;
    surface.area_u_W_K += area_m2 * number_in(glass, name, "Glass U-Factor");
    surface.area_absorbed_m2 += area_m2 * number_in(glass, name, "Glass SHGC");
  }
  return envelope;
}

std::string_view side_name(int azimuth_deg) {
  constexpr std::string_view kNames[] = {"north", "east", "south", "west"};
  return kNames[azimuth_deg / 90];
}

std::string surfaces(const Envelope& envelope, Memory& memory) {
  constexpr double kSpread = 0.1;
  std::string text;
  for (const auto& [key, surface] : envelope) {
    const auto [kind, side] = key;
    if (surface.area_m2 < 0.5) continue;
    const double u_W_m2K = memory.of(surface.area_u_W_K / surface.area_m2, kSpread);
    const double absorbed = surface.area_absorbed_m2 / surface.area_m2;
    const auto add = [&](const std::string& name, std::string_view of, const std::string& rest) {
      text += fmt::format(
          "[[building.surface]]\nname = \"{}\"\nkind = \"{}\"\narea_m2 = {:.1f}\nu_W_m2K = "
          "{}\n{}\n",
          name, of, surface.area_m2, u_W_m2K, rest);
    };
    const std::string azimuth = fmt::format("azimuth_deg = {}\n", side);
    const auto glass = [&](const std::string& where) {
      return where + fmt::format("shgc = {}\nframe_fraction = 0.0\nshading_factor = 1.0\n",
                                 std::min(memory.of(absorbed, kSpread), 0.87));
    };
    switch (kind) {
      case Kind::wall:
        add(fmt::format("{} wall", side_name(side)), "wall",
            azimuth + fmt::format("solar_absorptance = {:.1f}\n", absorbed));
        break;
      case Kind::window:
        add(fmt::format("{} windows", side_name(side)), "window", glass(azimuth));
        break;
      case Kind::skylight:
        add("skylight", "window", glass("tilt_deg = 0\nazimuth_deg = 180\n"));
        break;
      case Kind::roof:
        add("roof", "roof", fmt::format("solar_absorptance = {:.1f}\n", absorbed));
        break;
      case Kind::ground:
        add("ground slab", "ground", "");
        break;
    }
  }
  return text;
}

double area_of(const Envelope& envelope, Kind kind) {
  double sum_m2 = 0.0;
  for (const auto& [key, surface] : envelope) {
    if (key.first == kind) sum_m2 += surface.area_m2;
  }
  return sum_m2;
}

/// Means of a role's schedules by local hour over the days of one kind.
std::array<double, 24> by_hour(const BuildingYear& drawings, Role role, DayKind kind) {
  std::array<double, 24> sum{};
  double count = 0.0;
  for (const std::string& name : drawings.names_of(role)) {
    const Quarters& quarters = drawings.schedule(name);
    for (std::size_t day = 0; day < drawings.days().size(); ++day) {
      if (drawings.kind_of(day) != kind) continue;
      count += 1.0;
      for (std::size_t quarter = 0; quarter < kQuartersPerDay; ++quarter) {
        sum[quarter / 4] += 0.25 * quarters[day * kQuartersPerDay + quarter];
      }
    }
  }
  for (double& value : sum) value = count > 0.0 ? value / count : 0.0;
  return sum;
}

std::string list_of(const std::array<double, 24>& values) {
  std::string list;
  for (const double value : values) {
    list += fmt::format("{}{:.2f}", list.empty() ? "" : ", ", std::min(value, 1.0));
  }
  return list;
}

/// From and to which hour of a day of this kind the building is kept for people. By set-points,
/// where they are set back at night; else by the fans.
std::pair<int, int> occupied_hours(const BuildingYear& drawings, DayKind kind) {
  const auto workday = by_hour(drawings, Role::cooling_setpoint, DayKind::workday);
  const auto cooling = by_hour(drawings, Role::cooling_setpoint, kind);
  const auto fans = by_hour(drawings, Role::fans, kind);
  const auto hours_where = [](const auto& is_on) {
    int first = 24;
    int last = 0;
    for (int hour = 0; hour < 24; ++hour) {
      if (!is_on(static_cast<std::size_t>(hour))) continue;
      first = std::min(first, hour);
      last = hour + 1;
    }
    return first < last ? std::pair(first, last) : std::pair(0, 0);
  };
  constexpr double kSetBack_K = 1.0;
  const double least = *std::ranges::min_element(workday);
  if (*std::ranges::max_element(workday) - least > kSetBack_K) {
    return hours_where([&](std::size_t hour) { return cooling[hour] < least + 0.5 * kSetBack_K; });
  }
  return hours_where([&](std::size_t hour) { return fans[hour] > 0.5; });
}

/// A flow of outdoor air, and the schedule that its plant follows.
struct OutdoorAir {
  std::string_view type;
  const char* flow;
  const char* schedule;
};
constexpr std::array kOutdoorAir{
    OutdoorAir{"Controller:OutdoorAir", "minimum_outdoor_air_flow_rate",
               "minimum_outdoor_air_schedule_name"},
    OutdoorAir{"ZoneHVAC:", "maximum_outdoor_air_flow_rate", "outdoor_air_schedule_name"},
    OutdoorAir{"ZoneHVAC:", "cooling_outdoor_air_flow_rate",
               "supply_air_fan_operating_mode_schedule_name"},
    OutdoorAir{"DesignSpecification:OutdoorAir", "outdoor_air_flow_per_zone_floor_area",
               "outdoor_air_schedule_name"},
};

/// Mean at an hour of the days of a kind.
double at_hour(const BuildingYear& drawings, const Quarters& quarters, DayKind kind,
               std::size_t hour) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t day = 0; day < drawings.days().size(); ++day) {
    if (drawings.kind_of(day) != kind) continue;
    sum += quarters[day * kQuartersPerDay + 4 * hour];
    count += 1.0;
  }
  return sum / count;
}

/// Share of the outdoor air whose plant runs at an hour of the days of a kind.
double share_running_at(const BuildingYear& drawings, DayKind kind, std::size_t hour) {
  const double fans = drawings.has(Role::fans) ? by_hour(drawings, Role::fans, kind)[hour] : 0.0;
  double all = 0.0;
  double running = 0.0;
  for (const OutdoorAir& outdoor : kOutdoorAir) {
    if (all > 0.0) break;  // the same air would be counted again
    for (const auto& [type, objects] : drawings.model().items()) {
      if (!type.starts_with(outdoor.type)) continue;
      for (const auto& [name, object] : objects.items()) {
        if (!object.contains(outdoor.flow) || !object[outdoor.flow].is_number()) continue;
        const double flow = object[outdoor.flow].template get<double>();
        const Quarters* const follows =
            drawings.find_schedule(in_capitals(object.value(outdoor.schedule, "")));
        all += flow;
        running += flow * std::min(follows ? at_hour(drawings, *follows, kind, hour) : fans, 1.0);
      }
    }
  }
  return all > 0.0 ? running / all : 0.0;
}

double sum_of(Json model, std::string_view type, std::initializer_list<const char*> fields) {
  double sum = 0.0;
  for_each_object(model, type, [&](const std::string& /*name*/, Json& object) {
    for (const char* field : fields) {
      if (!object.contains(field) || !object[field].is_number()) continue;
      sum += object[field].get<double>();
      break;
    }
  });
  return sum;
}

/// Of a type; empty where there is none.
Json find_object(const Json& model, const char* type, const std::string& wanted) {
  const Json objects = model.value(type, Json::object());
  for (const auto& [name, object] : objects.items()) {
    if (in_capitals(name) == in_capitals(wanted)) return object;
  }
  return Json::object();
}

/// Pumps of one speed in the loops of chillers and towers: they turn whenever there is something to
/// cool.
double idle_W(const Json& model) {
  double sum_W = 0.0;
  for (const auto& [type, list] : {std::pair{"PlantLoop", "plant_side_branch_list_name"},
                                   std::pair{"CondenserLoop", "condenser_side_branch_list_name"}}) {
    const Json loops = model.value(type, Json::object());
    for (const Json& loop : loops) {
      double pumps_W = 0.0;
      bool cools = std::string_view{type} == "CondenserLoop";
      const Json branches = find_object(model, "BranchList", loop.value(list, ""));
      for (const Json& listed : branches.value("branches", Json::array())) {
        const Json branch = find_object(model, "Branch", listed.value("branch_name", ""));
        for (const Json& part : branch.value("components", Json::array())) {
          const std::string kind = part.value("component_object_type", "");
          cools = cools || kind.starts_with("Chiller:");
          if (kind != "Pump:ConstantSpeed") continue;
          const Json pump = find_object(model, kind.c_str(), part.value("component_name", ""));
          const Json power_W = pump.value("design_power_consumption", Json());
          if (power_W.is_number()) pumps_W += power_W.get<double>();
        }
      }
      if (cools) sum_W += pumps_W;
    }
  }
  return sum_W;
}

double first_of(const Json& model, std::string_view type, const char* field, double otherwise) {
  for (const auto& [of, objects] : model.items()) {
    if (!of.starts_with(type)) continue;
    for (const auto& [name, object] : objects.items()) {
      if (object.contains(field) && object[field].is_number()) return object[field].get<double>();
    }
  }
  return otherwise;
}

/// In the design, m³/s; of zones' specifications where neither handlers nor units have any.
double outdoor_air_m3_s(const SizedModel& sized) {
  const double moved =
      sum_of(sized.model, "Controller:OutdoorAir", {"minimum_outdoor_air_flow_rate"}) +
      sum_of(sized.model,
             "ZoneHVAC:", {"maximum_outdoor_air_flow_rate", "cooling_outdoor_air_flow_rate"});
  if (moved > 0.0) return moved;
  const Table& zones = table_of(sized, "Zone Summary");
  return first_of(sized.model, "DesignSpecification:OutdoorAir",
                  "outdoor_air_flow_per_zone_floor_area", 0.0006) *
         number_in(zones, "Conditioned Total", "Area");
}

/// Above which no more outdoor air is taken than must be; 0 without an economiser of that kind.
double economiser_limit_C(const Json& model) {
  if (!model.contains("Controller:OutdoorAir")) return 0.0;
  for (const auto& [name, controller] : model["Controller:OutdoorAir"].items()) {
    if (controller.value("economizer_control_type", "") == "FixedDryBulb") {
      return controller["economizer_maximum_limit_dry_bulb_temperature"].get<double>();
    }
  }
  return 0.0;
}

constexpr std::size_t kDeepNight_h = 3;
constexpr std::size_t kNoon_h = 12;

std::string operation(const SiteFacts& facts, const SizedModel& sized, const BuildingYear& drawings,
                      double floor_m2, Memory& memory) {
  const auto cooling = by_hour(drawings, Role::cooling_setpoint, DayKind::workday);
  const auto heating = by_hour(drawings, Role::heating_setpoint, DayKind::workday);
  auto [from, to] = occupied_hours(drawings, DayKind::workday);
  if (from == to) to = 24;
  const auto is_open = [&](DayKind kind) {
    const auto [opens, closes] = occupied_hours(drawings, kind);
    return 2 * (closes - opens) > to - from;
  };
  // Where workdays never end, weekends tell what never stops.
  const bool is_whole = from == 0 && to == 24;
  const double always_share = is_whole ? share_running_at(drawings, DayKind::sunday, kNoon_h)
                                       : share_running_at(drawings, DayKind::workday, kDeepNight_h);
  const bool boxes = sized.model.contains("AirTerminal:SingleDuct:VAV:Reheat");
  const double recovery =
      first_of(sized.model,
               "HeatExchanger:AirToAir:", "sensible_effectiveness_at_100_heating_air_flow", 0.0);
  double fan_m3_s = 0.0;
  double fan_W = 0.0;
  const Table& fans = table_of(sized, "Fans");
  for (const auto& [name, row] : fans) {
    fan_m3_s += number_in(fans, name, "Max Air Flow Rate");
    fan_W += number_in(fans, name, "Rated Electricity Rate");
  }
  double pump_W = 0.0;
  const Table& pumps = table_of(sized, "Pumps");
  for (const auto& [name, row] : pumps) pump_W += number_in(pumps, name, "Electricity Rate");
  pump_W = std::max(pump_W - idle_W(sized.model), 0.0);
  const double outdoor_m3_s = outdoor_air_m3_s(sized);
  constexpr double kUsual_m3_s_m2 = 0.006;
  if (fan_m3_s == 0.0) fan_m3_s = std::max(kUsual_m3_s_m2 * floor_m2, 1.5 * outdoor_m3_s);
  const double least = first_of(sized.model, "AirTerminal:SingleDuct:VAV:Reheat",
                                "constant_minimum_air_flow_fraction", 0.5);
  double supply_C = 13.0;
  for (const std::string& name : drawings.names_of(Role::supply_temperature)) {
    supply_C = drawings.schedule(name).front();
  }
  std::string text = fmt::format(
      R"([building.setpoint]
cooling_occupied_C = {:.1f}
cooling_unoccupied_C = {:.1f}
heating_occupied_C = {:.1f}
heating_unoccupied_C = {:.1f}
occupied_from = {}
occupied_to = {}
{}{}
[building.infiltration]
ela_cm2_m2 = {}

[building.air]
reheat_boxes = {}
outdoor_air_m3_s = {}
outdoor_air_unoccupied_fraction = {:.1f}
supply_flow_design_m3_s = {}
supply_flow_min_m3_s = {}
supply_temperature_C = {:.1f}
fan_design_kW = {}
pump_design_kW = {}
)",
      *std::ranges::min_element(cooling), *std::ranges::max_element(cooling),
      *std::ranges::max_element(heating), *std::ranges::min_element(heating), from, to,
      is_open(DayKind::saturday) ? "saturday_occupied = true\n" : "",
      is_open(DayKind::sunday) ? "sunday_occupied = true\n" : "",
      memory.of(facts.leakage_cm2_m2, 0.2), boxes, memory.of(outdoor_m3_s, 0.1), always_share,
      memory.of(fan_m3_s, 0.08), memory.of(std::max(std::min(least, 1.0) * fan_m3_s, 0.02), 0.08),
      supply_C, memory.of(1e-3 * fan_W, 0.1), memory.of(1e-3 * pump_W, 0.1));
  const double lockout_C = economiser_limit_C(sized.model);
  if (recovery > 0.0) text += fmt::format("heat_recovery = {:.2f}\n", recovery);
  if (lockout_C > 0.0) text += fmt::format("economiser_lockout_C = {:.0f}\n", lockout_C);
  return text + "\n";
}

std::string services(const SizedModel& sized, const std::vector<MeterPlate>& plates,
                     Memory& memory) {
  const Json& model = sized.model;
  const double efficiency =
      first_of(model, "Boiler:", "nominal_thermal_efficiency",
               first_of(model, "Coil:Heating:Fuel", "burner_efficiency", 1.0));
  std::string text;
  const bool heats = std::ranges::any_of(
      plates, [](const MeterPlate& plate) { return plate.utility == Utility::heat; });
  if (heats) {
    text +=
        fmt::format("[building.heating]\nloss_fraction = 0.0\nefficiency = {:.2f}\n\n", efficiency);
  }
  const double cop = first_of(
      model, "Chiller:", "reference_cop",
      first_of(model, "Coil:Cooling:", "gross_rated_cooling_cop",
               first_of(model, "Coil:Cooling:", "high_speed_gross_rated_cooling_cop",
                        first_of(model, "AirConditioner:", "gross_rated_cooling_cop", 0.0))));
  if (cop > 0.0) {
    text += fmt::format("[building.cooling]\nloss_fraction = 0.0\nchiller_cop = {}\n",
                        memory.of(cop, 0.05));
    if (const double idle = idle_W(model); idle > 0.0) {
      text += fmt::format("idle_kW = {}\n", memory.of(1e-3 * idle, 0.1));
    }
    text += "\n";
  }
  const double ground_C =
      first_of(model, "Site:GroundTemperature:BuildingSurface", "april_ground_temperature", 18.0);
  return text + fmt::format("[building.ground]\ntemperature_C = {:.1f}\n", ground_C);
}

std::string heading(const SiteFacts& facts, const std::vector<MeterPlate>& plates) {
  std::string holidays;
  for (const metering::Day day : facts.holidays) {
    holidays += fmt::format("  \"{}\",\n", metering::to_string(day));
  }
  std::string text = fmt::format(
      R"(# {}. Numbers are those of drawings and nameplates.
[site]
id = "{}"
timezone = "{}"
latitude_deg = {}
longitude_deg = {}
altitude_m = {}
interval = "15m"
holidays = [   # local dates that run like Sundays
{}]

[weather]
file = "weather.csv"
format = "csv"
stamps = "end"

)",
      facts.title, facts.id, facts.time_zone, facts.place.latitude_deg, facts.place.longitude_deg,
      facts.place.altitude_m, holidays);
  std::string outputs;
  for (const MeterPlate& plate : plates) {
    text += fmt::format(
        "[[meter]]\nid = \"{}\"\nutility = \"{}\"\nfile = \"readings.csv\"\nstamps = \"start\"\n"
        "rated_kW = {:.0f}\n",
        plate.id, plate.kind, plate.rated_kW);
    if (plate.utility != Utility::electricity) {
      text += "zero_run_max = \"9000h\"   # zero is zero here\n";
    }
    text += "\n";
    outputs += fmt::format("{}\"{}\"", outputs.empty() ? "" : ", ", plate.id);
  }
  // The last year is for validation; of a single year, the last four months.
  const int last = facts.first_year + facts.years - 1;
  const bool single = facts.years == 1;
  return text + fmt::format(R"([period]
calibration = {{ from = "{}-01", to = "{}" }}
validation = {{ from = "{}-{}", to = "{}-12" }}

[[model]]
kind = "hourly"
outputs = [{}]

)",
                            facts.first_year,
                            single ? fmt::format("{}-08", last) : fmt::format("{}-12", last - 1),
                            last, single ? "09" : "01", last, outputs);
}

}  // namespace

std::vector<CaseMeter> meters_of(const Json& model) {
  std::vector<CaseMeter> meters{{Utility::electricity, {"electricity", {"Electricity:Facility"}}}};
  const bool is_ideal = has_object(model, "ZoneHVAC:IdealLoadsAirSystem");
  if (is_ideal || has_object(model, "DistrictCooling")) {
    meters.push_back({Utility::cooling, {"chilled_water", {"DistrictCooling:Facility"}}});
  } else if (model.contains("Coil:Cooling:Water") ||
             model.contains("Coil:Cooling:Water:DetailedGeometry")) {
    meters.push_back({Utility::cooling, {"chilled_water", {"CoolingCoils:EnergyTransfer"}}});
  }
  const std::string fuel = heating_fuel(model);
  if (fuel == "DistrictHeatingWater") {
    meters.push_back({Utility::heat, {"heating", {"DistrictHeatingWater:Facility"}}});
  } else if (fuel == "NaturalGas") {
    meters.push_back({Utility::heat, {"gas", {"NaturalGas:Facility"}}});
  }
  return meters;
}

BaseParameters as_drawn(const SizedModel& sized, const BuildingYear& drawings) {
  constexpr double kHardlyAnybody = 0.01;
  const double people_m2 =
      number_in(table_of(sized, "Zone Summary"), "Conditioned Total", "People");
  const auto cooling = by_hour(drawings, Role::cooling_setpoint, DayKind::workday);
  return {people_m2 > 0.0 ? 1.0 / people_m2 : kHardlyAnybody, outdoor_air_m3_s(sized),
          *std::ranges::min_element(cooling)};
}

std::string site_text(const SiteFacts& facts, const SizedModel& sized, const BuildingYear& drawings,
                      const std::vector<MeterPlate>& plates, Rng rng) {
  Memory memory(rng);
  const Table& zones = table_of(sized, "Zone Summary");
  const double floor_m2 = number_in(zones, "Conditioned Total", "Area");
  const double volume_m3 = number_in(zones, "Conditioned Total", "Volume");
  const Envelope envelope = envelope_of(sized);
  const double roof_m2 = area_of(envelope, Kind::roof) + area_of(envelope, Kind::skylight);
  const double storeys = std::max(std::round(floor_m2 / std::max(roof_m2, 1.0)), 1.0);
  const BaseParameters drawn = as_drawn(sized, drawings);
  std::string text = heading(facts, plates);
  text += fmt::format(
      "[building]\nfloor_area_m2 = {:.0f}\nstoreys = {:.0f}\nstorey_height_m = {:.1f}\n"
      "mass = \"{}\"\n\n",
      floor_m2, storeys, volume_m3 / floor_m2, facts.heavy ? "heavy" : "light");
  text += surfaces(envelope, memory);
  text += fmt::format(
      R"([building.use]
occupancy_person_m2 = {}
lighting_W_m2 = {}
plugs_W_m2 = {}
exterior_kW = {:.1f}
zone_heat_share = 1.0

[building.schedule]   # people present / assigned, by local hour
workday = [{}]
saturday = [{}]
sunday = [{}]

)",
      memory.of(drawn.occupancy_person_m2, 0.2),
      memory.of(number_in(zones, "Conditioned Total", "Lighting"), 0.08),
      memory.of(number_in(zones, "Conditioned Total", "Plug and Process"), 0.12),
      1e-3 * sum_of(sized.model, "Exterior:Lights", {"design_level"}),
      list_of(by_hour(drawings, Role::presence, DayKind::workday)),
      list_of(by_hour(drawings, Role::presence, DayKind::saturday)),
      list_of(by_hour(drawings, Role::presence, DayKind::sunday)));
  return text + operation(facts, sized, drawings, floor_m2, memory) +
         services(sized, plates, memory);
}

}  // namespace recald::blind
