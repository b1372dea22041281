#include "simulators/climate/climate_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kDegreeDayBase_C = 18.3;
constexpr double kWetDay_mm = 0.25;

/// The value that this share of the sample exceeds. Reorders the sample.
double exceeded_by(double share, std::vector<double>& sample) {
  const auto rank = static_cast<std::ptrdiff_t>((1.0 - share) * static_cast<double>(sample.size()));
  const auto value = sample.begin() + std::min(rank, std::ssize(sample) - 1);
  std::nth_element(sample.begin(), value, sample.end());
  return *value;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double total(const Monthly& monthly) {
  double sum = 0.0;
  for (const double value : monthly) sum += value;
  return sum;
}

}  // namespace

ClimateStatistics::ClimateStatistics(std::chrono::sys_days first_day, std::chrono::seconds step)
    : date_(first_day), steps_a_day_(static_cast<int>(std::chrono::days{1} / step)) {
  assert(std::chrono::days{1} % step == std::chrono::seconds{0});
}

void ClimateStatistics::add(const Outdoors& outdoors) {
  const std::chrono::year_month_day date{date_};
  Month& month = months_[static_cast<unsigned>(date.month()) - 1];
  const double air_C = outdoors.air.temperature_C;
  const double step_h = 24.0 / static_cast<double>(steps_a_day_);
  const double fallen_mm = outdoors.precipitation_mm_h * step_h;
  month.steps += 1.0;
  month.dry_bulb_C += air_C;
  month.dew_point_C +=
      dew_point_C(vapour_pressure_Pa(outdoors.air.humidity_kg_kg, outdoors.pressure_Pa));
  month.wind_m_s += outdoors.wind_speed_m_s;
  month.global_W_m2 += outdoors.global_horizontal_W_m2;
  month.precipitation_mm += fallen_mm;
  snowfall_mm_ += fallen_mm * outdoors.snow_share;
  dry_bulbs_C_.push_back(air_C);

  today_.sum_C += air_C;
  today_.lowest_C = std::min(today_.lowest_C, air_C);
  today_.highest_C = std::max(today_.highest_C, air_C);
  today_.precipitation_mm += fallen_mm;
  if (++today_.steps == steps_a_day_) end_day();
}

void ClimateStatistics::end_day() {
  const std::chrono::year_month_day date{date_};
  if (year_lowest_C_.empty() || date.month() / date.day() == std::chrono::January / 1) {
    year_lowest_C_.push_back(today_.lowest_C);
    year_highest_C_.push_back(today_.highest_C);
  }
  year_lowest_C_.back() = std::min(year_lowest_C_.back(), today_.lowest_C);
  year_highest_C_.back() = std::max(year_highest_C_.back(), today_.highest_C);
  Month& month = months_[static_cast<unsigned>(date.month()) - 1];
  month.days += 1.0;
  month.range_K += today_.highest_C - today_.lowest_C;
  const double mean_C = today_.sum_C / static_cast<double>(steps_a_day_);
  heating_K_days_ += std::max(0.0, kDegreeDayBase_C - mean_C);
  cooling_K_days_ += std::max(0.0, mean_C - kDegreeDayBase_C);
  if (today_.precipitation_mm >= kWetDay_mm) wet_days_ += 1.0;
  days_ += 1.0;
  today_ = {};
  date_ += std::chrono::days{1};
}

Normals ClimateStatistics::result() const {
  const auto years = static_cast<double>(year_lowest_C_.size());
  assert(days_ >= 365.0 * years);
  Normals normals{};
  for (std::size_t m = 0; m < 12; ++m) {
    const Month& month = months_[m];
    normals.dry_bulb_C[m] = month.dry_bulb_C / month.steps;
    normals.daily_range_K[m] = month.range_K / month.days;
    normals.dew_point_C[m] = month.dew_point_C / month.steps;
    normals.wind_m_s[m] = month.wind_m_s / month.steps;
    normals.global_kWh_m2_day[m] = month.global_W_m2 / month.steps * 24.0 / 1000.0;
    normals.precipitation_mm[m] = month.precipitation_mm / years;
  }
  normals.wet_days = wet_days_ / years;
  normals.snowfall_mm = snowfall_mm_ / years;
  normals.heating_K_days = heating_K_days_ / years;
  normals.cooling_K_days = cooling_K_days_ / years;
  std::vector<double> dry_bulbs_C = dry_bulbs_C_;
  normals.heating_design_C = exceeded_by(0.996, dry_bulbs_C);
  normals.cooling_design_C = exceeded_by(0.004, dry_bulbs_C);
  normals.annual_minimum_C = mean_of(year_lowest_C_);
  normals.annual_maximum_C = mean_of(year_highest_C_);
  return normals;
}

Normals simulated_normals(ClimateKind kind, int years, std::uint64_t seed,
                          std::chrono::seconds step) {
  using namespace std::chrono;
  const Place& place = comparable_city(kind).place;
  const sys_days first = 2021y / January / 1;
  const sys_days after = (2021y + std::chrono::years{years}) / January / 1;
  const seconds sun_behind_utc{std::lround(-place.longitude_deg * 240.0)};  // 24 h in 360 degrees
  WeatherGenerator weather(climate_of(kind, place), first + sun_behind_utc,
                           stream_of(seed, Stream::weather), step);
  ClimateStatistics statistics(first, step);
  for (auto steps = (after - first) / step; steps > 0; --steps) statistics.add(weather.advance());
  return statistics.result();
}

namespace {

struct Row {
  std::string_view name;
  int decimals;
  double (*value)(const Normals&);
};

constexpr std::size_t kJanuary = 0;
constexpr std::size_t kJuly = 6;

constexpr std::array kRows{
    Row{"dry bulb, year, degC", 1, [](const Normals& n) { return annual_mean(n.dry_bulb_C); }},
    Row{"dry bulb, January", 1, [](const Normals& n) { return n.dry_bulb_C[kJanuary]; }},
    Row{"dry bulb, July", 1, [](const Normals& n) { return n.dry_bulb_C[kJuly]; }},
    Row{"daily range, K", 1, [](const Normals& n) { return annual_mean(n.daily_range_K); }},
    Row{"dew point, year, degC", 1, [](const Normals& n) { return annual_mean(n.dew_point_C); }},
    Row{"dew point, January", 1, [](const Normals& n) { return n.dew_point_C[kJanuary]; }},
    Row{"dew point, July", 1, [](const Normals& n) { return n.dew_point_C[kJuly]; }},
    Row{"wind, m/s", 1, [](const Normals& n) { return annual_mean(n.wind_m_s); }},
    Row{"global radiation, kWh/m² a day", 2,
        [](const Normals& n) { return annual_mean(n.global_kWh_m2_day); }},
    Row{"of it in January", 2, [](const Normals& n) { return n.global_kWh_m2_day[kJanuary]; }},
    Row{"of it in July", 2, [](const Normals& n) { return n.global_kWh_m2_day[kJuly]; }},
    Row{"heating degree days 18.3, K d", 0, [](const Normals& n) { return n.heating_K_days; }},
    Row{"cooling degree days 18.3, K d", 0, [](const Normals& n) { return n.cooling_K_days; }},
    Row{"exceeded 99.6 % of hours, degC", 1, [](const Normals& n) { return n.heating_design_C; }},
    Row{"exceeded 0.4 % of hours, degC", 1, [](const Normals& n) { return n.cooling_design_C; }},
    Row{"lowest of a year, degC", 1, [](const Normals& n) { return n.annual_minimum_C; }},
    Row{"highest of a year, degC", 1, [](const Normals& n) { return n.annual_maximum_C; }},
    Row{"precipitation, mm a year", 0, [](const Normals& n) { return total(n.precipitation_mm); }},
    Row{"days of it", 0, [](const Normals& n) { return n.wet_days; }},
    Row{"snowfall as water, mm a year", 0, [](const Normals& n) { return n.snowfall_mm; }},
};

/// Rounded, with no sign on a zero.
std::string rounded(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  return text.find_first_of("123456789") == std::string::npos && text[0] == '-' ? text.substr(1)
                                                                                : text;
}

}  // namespace

std::string climate_table(int years, std::uint64_t seed) {
  std::string header = "| simulated / published |";
  std::string rule = "| --- |";
  std::vector<Normals> simulated;
  for (const ClimateKind kind : kClimateKinds) {
    header += fmt::format(" {}, {} |", name_of(kind), comparable_city(kind).name);
    rule += " ---: |";
    simulated.push_back(simulated_normals(kind, years, seed));
  }
  std::string table = header + '\n' + rule + '\n';
  for (const Row& row : kRows) {
    table += fmt::format("| {} |", row.name);
    for (std::size_t i = 0; i < simulated.size(); ++i) {
      table += fmt::format(" {} / {} |", rounded(row.value(simulated[i]), row.decimals),
                           rounded(row.value(normals_of(kClimateKinds[i])), row.decimals));
    }
    table += '\n';
  }
  return table;
}

}  // namespace recald::simulators
