/// A small site in a folder of its own: its TOML file and, where a test wants them, readings and
/// weather. `edited` makes one mistake in it, `line_of` says where.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

namespace recald::testing {

inline constexpr std::string_view kSampleMeters = R"([site]
id = "depot"
name = "Tram depot"
timezone = "Europe/Zurich"
latitude_deg = 47.4
longitude_deg = 8.5
altitude_m = 420
interval = "15m"
watermark = "72h"
holidays = ["2021-12-25"]

[[meter]]
id = "electricity"
utility = "electricity"
file = "readings.csv"
rated_kW = 400

[[meter]]
id = "district_heat"
utility = "heating"
file = "readings.csv"
name_in_file = "heat"
zero_run_max = "96h"
)";

inline constexpr std::string_view kSampleModel = R"(
[weather]
file = "weather.csv"
values = "mean"

[period]
calibration = { from = "2021-01", to = "2021-09" }
validation = { from = "2021-10", to = "2021-12" }

[[model]]
kind = "epc"
outputs = ["electricity", "district_heat"]
weights = { district_heat = 0.8 }

[[model.parameter]]
name = "occupancy_density"

[[model.parameter]]
name = "outdoor_airflow"
min = 0.8
mode = 2.0
max = 2.6

[building]
floor_area_m2 = 2400
storeys = 2
mass = "medium"

[[building.surface]]
name = "south wall"
kind = "wall"
area_m2 = 300
u_W_m2K = 0.4
azimuth_deg = 180

[[building.surface]]
name = "south windows"
kind = "window"
area_m2 = 120
u_W_m2K = 1.6
azimuth_deg = 180
shgc = 0.5

[[building.surface]]
name = "roof"
kind = "roof"
area_m2 = 1200
u_W_m2K = 0.25

[building.use]
occupancy_person_m2 = 0.05
lighting_W_m2 = 8
plugs_W_m2 = 9

[building.schedule]
workday = [0, 0, 0, 0, 0, 0.1, 0.5, 0.9, 1, 1, 1, 1, 0.7, 1, 1, 1, 1, 0.8, 0.4, 0.2, 0.1, 0, 0, 0]
saturday = [0, 0, 0, 0, 0, 0, 0, 0, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
sunday = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]

[building.setpoint]
cooling_occupied_C = 25
heating_occupied_C = 21

[building.air]
outdoor_air_m3_s = 2.0
supply_flow_design_m3_s = 6.0
supply_flow_min_m3_s = 2.5
fan_design_kW = 9

[building.heating]
efficiency = 0.95
)";

inline std::string sample_site() { return std::string{kSampleMeters} + std::string{kSampleModel}; }

/// `text` with its only `from` replaced. Throws where it is absent or not alone: the test is wrong.
inline std::string edited(std::string text, std::string_view from, std::string_view to) {
  const std::size_t place = text.find(from);
  if (place == std::string::npos || text.find(from, place + 1) != std::string::npos) {
    throw std::logic_error("not exactly once in the text: " + std::string{from});
  }
  return text.replace(place, from.size(), to);
}

/// Number of the first line that contains `words`, from 1.
inline int line_of(const std::string& text, std::string_view words) {
  const std::size_t place = text.find(words);
  if (place == std::string::npos) throw std::logic_error("not in it: " + std::string{words});
  return 1 + static_cast<int>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
}

}  // namespace recald::testing
