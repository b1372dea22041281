#include "daemon/site/setup/starter_building.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text/nearest.hpp"

namespace recald::daemon {
namespace {

using metering::Utility;

/// Typical of a use. Densities after ASHRAE 90.1 (lighting) and 62.1 (people, outdoor air),
/// rounded; plugs after the reference buildings of the US Department of Energy.
struct UseFacts {
  std::string_view name;
  double people_m2;
  double lights_W_m2;
  double plugs_W_m2;
  double outdoor_air_l_s_m2;
  double supply_air_l_s_m2;
  double night_air_share;  ///< Of the air handlers that run round the clock.
  double glass_share;      ///< Of the walls.
  double storey_height_m;
  int opens;
  int closes;
  bool saturday;
  bool sunday;
  double hot_water_l_m2_day;
};

constexpr auto kUses = std::to_array<UseFacts>({
    {"office", 0.05, 11, 9, 0.6, 5.0, 0.0, 0.33, 3.7, 7, 19, false, false, 0.2},
    {"school", 0.25, 13, 7, 2.5, 5.0, 0.0, 0.33, 4.0, 7, 17, false, false, 0.3},
    {"shop", 0.15, 16, 5, 1.2, 5.0, 0.0, 0.15, 5.0, 8, 21, true, false, 0.1},
    {"hotel", 0.05, 10, 6, 0.5, 4.0, 0.8, 0.30, 3.2, 0, 24, true, true, 2.5},
    {"clinic", 0.10, 12, 12, 1.5, 6.0, 0.2, 0.25, 4.0, 7, 19, false, false, 0.6},
    {"laboratory", 0.05, 15, 40, 5.0, 7.0, 0.7, 0.30, 4.2, 7, 19, false, false, 0.6},
    {"restaurant", 0.50, 14, 40, 3.5, 7.0, 0.0, 0.20, 4.0, 9, 23, true, true, 6.0},
    {"warehouse", 0.005, 8, 3, 0.3, 2.0, 0.0, 0.03, 8.0, 6, 18, false, false, 0.05},
});

constexpr auto kUseNames = [] {
  std::array<std::string_view, kUses.size()> names{};
  for (std::size_t i = 0; i < kUses.size(); ++i) names[i] = kUses[i].name;
  return names;
}();

/// U-values in W/m²K by climate zone 1 to 8, rounded.
struct Envelope {
  const char* typical_of;
  std::array<double, 8> wall;
  std::array<double, 8> roof;
  std::array<double, 8> window;
  std::array<double, 8> shgc;
  double leakage_cm2_m2;
};

constexpr Envelope kBeforeCodes{
    "buildings from before energy codes, 1980",  {1.3, 1.3, 1.1, 0.9, 0.8, 0.7, 0.6, 0.5},
    {0.6, 0.6, 0.55, 0.5, 0.45, 0.4, 0.35, 0.3}, {6.0, 6.0, 6.0, 3.5, 3.5, 3.5, 3.5, 3.0},
    {0.6, 0.6, 0.6, 0.5, 0.5, 0.5, 0.5, 0.5},    3.0};
constexpr Envelope kFirstCodes{"ASHRAE 90.1-1989, 1980 to 2004",
                               {1.0, 0.8, 0.7, 0.6, 0.5, 0.45, 0.4, 0.35},
                               {0.4, 0.4, 0.38, 0.36, 0.34, 0.32, 0.3, 0.25},
                               {6.0, 6.0, 4.0, 3.4, 3.3, 3.0, 2.8, 2.5},
                               {0.3, 0.3, 0.35, 0.4, 0.42, 0.45, 0.5, 0.5},
                               2.0};
constexpr Envelope kLaterCodes{"ASHRAE 90.1-2004 and later",
                               {0.7, 0.7, 0.5, 0.4, 0.36, 0.36, 0.36, 0.36},
                               {0.36, 0.36, 0.36, 0.36, 0.36, 0.36, 0.33, 0.27},
                               {5.5, 4.5, 3.2, 3.0, 2.8, 2.6, 2.5, 2.3},
                               {0.25, 0.25, 0.25, 0.38, 0.39, 0.39, 0.45, 0.45},
                               1.2};

const Envelope& envelope_of(const std::optional<int>& built) {
  if (!built || *built < 1980) return kBeforeCodes;
  return *built < 2005 ? kFirstCodes : kLaterCodes;
}

const char* article(std::string_view use) { return use.front() == 'o' ? "an" : "a"; }

bool has_meter(const StarterFacts& facts, Utility utility) {
  return std::ranges::any_of(facts.meters,
                             [&](const auto& meter) { return meter.second == utility; });
}

/// "key = value   # comment"
std::string line(const std::string& key, const std::string& value, const std::string& comment) {
  const std::string text = key + " = " + value;
  return fmt::format("{:<36} # {}\n", text, comment);
}

std::string number(double value) { return fmt::format("{:.3g}", value); }

/// A square of the storeys' floor, a quarter of the walls to each side.
std::string surfaces(const StarterFacts& facts, const UseFacts& use, const Envelope& envelope) {
  const auto zone = static_cast<std::size_t>(facts.climate_zone - 1);
  const double footprint_m2 = facts.floor_area_m2 / facts.storeys;
  const double side_m2 = std::sqrt(footprint_m2) * facts.storeys * use.storey_height_m;
  const std::string typical = fmt::format("guess, +-30 %: {}", envelope.typical_of);
  std::string text;
  const auto surface = [&](const std::string& name, const char* kind, double area_m2, double u) {
    text += fmt::format("\n[[building.surface]]\nname = \"{}\"\nkind = \"{}\"\n", name, kind);
    text += line("area_m2", number(area_m2), "guess: a square building");
    text += line("u_W_m2K", number(u), typical);
  };
  for (const auto& [side, azimuth] : {std::pair{"north", 0}, std::pair{"east", 90},
                                      std::pair{"south", 180}, std::pair{"west", 270}}) {
    surface(fmt::format("{} wall", side), "wall", side_m2 * (1.0 - use.glass_share),
            envelope.wall[zone]);
    text += fmt::format("azimuth_deg = {}\n", azimuth);
    surface(fmt::format("{} windows", side), "window", side_m2 * use.glass_share,
            envelope.window[zone]);
    text += fmt::format("azimuth_deg = {}\n", azimuth);
    text += line("shgc", number(envelope.shgc[zone]), typical);
  }
  surface("roof", "roof", footprint_m2, envelope.roof[zone]);
  surface("ground floor", "ground", footprint_m2, 0.4);
  return text;
}

std::string day(const UseFacts& use, double full) {
  std::vector<std::string> hours;
  for (int hour = 0; hour < 24; ++hour) {
    const bool open = use.opens <= hour && hour < use.closes;
    const bool edge = open && (hour == use.opens || hour == use.closes - 1);
    hours.push_back(number(open ? full * (edge && use.closes - use.opens < 24 ? 0.5 : 1.0) : 0.0));
  }
  return fmt::format("[{}]", fmt::join(hours, ", "));
}

std::string use_of(const UseFacts& use) {
  const std::string typical = fmt::format("typical of {} {}", article(use.name), use.name);
  std::string text = "\n[building.use]\n";
  text += line("occupancy_person_m2", number(use.people_m2), "guess, a factor of 2: " + typical);
  text += line("lighting_W_m2", number(use.lights_W_m2), "guess, +-40 %: " + typical);
  text += line("plugs_W_m2", number(use.plugs_W_m2), "guess, a factor of 2: " + typical);
  text += "\n[building.schedule]                  # guess: typical hours\n";
  text += "workday = " + day(use, 0.9) + "\n";
  text += "saturday = " + day(use, use.saturday ? 0.8 : 0.0) + "\n";
  text += "sunday = " + day(use, use.sunday ? 0.8 : 0.0) + "\n";
  text += "\n[building.setpoint]\n";
  text += line("cooling_occupied_C", "24", "guess, +-2 K");
  text += line("heating_occupied_C", "21", "guess, +-1.5 K");
  text += line("occupied_from", std::to_string(use.opens), "guess, +-2 h");
  text += line("occupied_to", std::to_string(use.closes), "guess, +-2 h");
  if (use.saturday) text += "saturday_occupied = true\n";
  if (use.sunday) text += "sunday_occupied = true\n";
  return text;
}

std::string systems_of(const StarterFacts& facts, const UseFacts& use, const Envelope& envelope) {
  const double outdoor_m3_s = 1e-3 * use.outdoor_air_l_s_m2 * facts.floor_area_m2;
  const double supply_m3_s = 1e-3 * use.supply_air_l_s_m2 * facts.floor_area_m2;
  const std::string typical = fmt::format("typical of {} {}", article(use.name), use.name);
  std::string text = "\n[building.infiltration]\n";
  text += line("ela_cm2_m2", number(envelope.leakage_cm2_m2),
               fmt::format("guess, a factor of 2: {}", envelope.typical_of));
  text += "\n[building.air]\n";
  text += line("reheat_boxes", "true", "guess; false if each room has a unit of its own");
  text += line("outdoor_air_m3_s", number(outdoor_m3_s), "guess, a factor of 2: " + typical);
  if (use.night_air_share > 0.0) {
    text += line("outdoor_air_unoccupied_fraction", number(use.night_air_share),
                 "guess, +-0.2: " + typical);
  }
  text += line("supply_flow_design_m3_s", number(supply_m3_s), "guess, +-30 %");
  text += line("supply_flow_min_m3_s", number(std::max(0.4 * supply_m3_s, outdoor_m3_s)),
               "guess, +-30 %");
  text += line("fan_design_kW", number(1.8 * supply_m3_s), "guess, +-40 %: 1.8 kW per m3/s");
  text += "\n[building.heating]\n";
  const bool burns = has_meter(facts, Utility::gas);
  text += line("efficiency", burns ? "0.82" : "0.97",
               burns ? "guess, +-0.08: a boiler" : "guess, +-0.03: district heat or steam");
  if (!has_meter(facts, Utility::chilled_water)) {
    text += "\n[building.cooling]\n";
    text += line("chiller_cop", "3.2", "guess, +-25 %: own chiller or packaged units");
  }
  text += "\n[building.hot_water]\n";
  text += line("volume_m3_day", number(1e-3 * use.hot_water_l_m2_day * facts.floor_area_m2),
               "guess, a factor of 2: " + typical);
  return text;
}

/// The later months are kept to check the model, where enough are left to calibrate it.
std::string period_of(const metering::MonthRange& months) {
  const auto count = (months.last - months.first).count() + 1;
  const auto kept = std::chrono::months{count >= 36 ? 12 : count >= 18 ? 6 : 0};
  const auto range = [](metering::Month from, metering::Month to) {
    return fmt::format("{{ from = \"{}\", to = \"{}\" }}", metering::to_string(from),
                       metering::to_string(to));
  };
  std::string text = "\n[period]\ncalibration = " + range(months.first, months.last - kept) + "\n";
  if (kept.count() > 0) {
    text +=
        "validation = " + range(months.last - kept + std::chrono::months{1}, months.last) + "\n";
  }
  return text;
}

/// Parameters that a guessed building leaves widest, with priors as wide as the guesses.
std::string model_of(const StarterFacts& facts, const UseFacts& use) {
  std::vector<std::string> outputs;
  for (const auto& [id, utility] : facts.meters) {
    if (utility != Utility::water) outputs.push_back("\"" + id + "\"");
  }
  std::string text =
      fmt::format("\n[[model]]\nkind = \"hourly\"\noutputs = [{}]\n", fmt::join(outputs, ", "));
  const auto parameter = [&](const char* name, double min, double mode, double max) {
    text += fmt::format(
        "\n[[model.parameter]]\nname = \"{}\"\nmin = {}\nmode = {}\nmax = {}\n"
        "source = \"guess: typical of {} {}\"\n",
        name, number(min), number(mode), number(max), article(use.name), use.name);
  };
  const double outdoor_m3_s = 1e-3 * use.outdoor_air_l_s_m2 * facts.floor_area_m2;
  parameter("occupancy_density", 0.2 * use.people_m2, use.people_m2, 2.0 * use.people_m2);
  parameter("outdoor_airflow", 0.3 * outdoor_m3_s, outdoor_m3_s, 2.0 * outdoor_m3_s);
  parameter("cooling_setpoint", 21.0, 24.0, 27.0);
  parameter("heating_setpoint", 18.5, 21.0, 23.0);
  parameter("u_factor_scale", 0.5, 1.0, 1.6);
  return text;
}

Result<const UseFacts*> find_use(const std::string& name) {
  const auto found = std::ranges::find(kUses, name, &UseFacts::name);
  if (found != kUses.end()) return &*found;
  const std::string_view nearest = nearest_name(name, kUseNames);
  return failure(ErrorCode::invalid_value,
                 fmt::format("no typical building of use '{}' is known{}; known uses are {}", name,
                             nearest.empty() ? "" : fmt::format(", did you mean '{}'?", nearest),
                             fmt::join(kUseNames, ", ")));
}

}  // namespace

std::span<const std::string_view> starter_uses() { return kUseNames; }

Result<int> climate_zone_of(const weather::WeatherSeries& weather) {
  constexpr std::size_t kLeastDays = 300;
  double heating_K_d = 0.0;
  double cooling_K_d = 0.0;
  std::size_t days = 0;
  for (std::size_t first = 0; first + 24 <= weather.hours.size(); first += 24) {
    double sum = 0.0;
    for (std::size_t h = first; h < first + 24; ++h) sum += weather.hours[h].dry_bulb_C;
    const double mean_C = sum / 24.0;
    if (std::isnan(mean_C)) continue;
    ++days;
    heating_K_d += std::max(18.0 - mean_C, 0.0);
    cooling_K_d += std::max(mean_C - 10.0, 0.0);
  }
  if (days < kLeastDays) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("a climate zone needs {} days of temperatures, but the weather has "
                               "{}; give a year of weather",
                               kLeastDays, days));
  }
  heating_K_d *= 365.0 / static_cast<double>(days);
  cooling_K_d *= 365.0 / static_cast<double>(days);
  if (heating_K_d > 7000.0) return 8;
  if (heating_K_d > 5000.0) return 7;
  if (heating_K_d > 4000.0) return 6;
  if (heating_K_d > 3000.0) return 5;
  if (cooling_K_d > 5000.0) return 1;
  if (cooling_K_d > 3500.0) return 2;
  return cooling_K_d > 2500.0 || heating_K_d <= 2000.0 ? 3 : 4;
}

Result<std::string> starter_model(const StarterFacts& facts) {
  const auto use = TRY(find_use(facts.use));
  if (!(facts.floor_area_m2 >= 10.0 && facts.floor_area_m2 <= 1e6)) {
    return failure(
        ErrorCode::invalid_value,
        fmt::format("a floor area of {} m2 cannot be; give 10 to 1000000 m2, all storeys "
                    "together",
                    facts.floor_area_m2));
  }
  if (facts.storeys < 1 || facts.storeys > 200) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("{} storeys cannot be; give 1 to 200", facts.storeys));
  }
  if (std::ranges::none_of(
          facts.meters, [](const auto& meter) { return meter.second == Utility::electricity; })) {
    return failure(ErrorCode::invalid_value,
                   "a model needs an electricity meter, from which it reads lights and plugs");
  }
  const Envelope& envelope = envelope_of(facts.built);
  std::string text = fmt::format(
      "# A starter model: what is typical of {} {} in climate zone {} ({}).\n"
      "# Every line with \"guess\" is one: replace it by what you know, the largest first.\n",
      article(use->name), use->name, facts.climate_zone, envelope.typical_of);
  text += period_of(facts.months);
  text += model_of(facts, *use);
  text += "\n[building]\n";
  text += line("floor_area_m2", number(facts.floor_area_m2), "as given");
  text += line("storeys", std::to_string(facts.storeys), "as given");
  text += line("storey_height_m", number(use->storey_height_m), "guess, +-15 %");
  text += surfaces(facts, *use, envelope);
  text += use_of(*use);
  text += systems_of(facts, *use, envelope);
  return text;
}

}  // namespace recald::daemon
