#include "core/model/electricity_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "core/absent.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::model {
namespace {

using metering::Validity;

constexpr double kTrim = 0.10;
constexpr std::size_t kLeastValues = 8;
constexpr double kConstantCvrmse = 0.05;
constexpr double kLeastOkShare = 0.5;  // of an hour's slots
constexpr int kStandbyFromHour = 2;
constexpr int kStandbyToHour = 5;

using Cells = std::array<std::array<std::vector<double>, 24>, kDayTypes>;

double trimmed_mean(std::vector<double> values) {
  std::ranges::sort(values);
  const auto cut = static_cast<std::ptrdiff_t>(kTrim * static_cast<double>(values.size()));
  const double sum = std::accumulate(values.begin() + cut, values.end() - cut, 0.0);
  return sum / static_cast<double>(std::ssize(values) - 2 * cut);
}

bool is_usable(const HourlyLoad& load) {
  return std::isfinite(load.mean_kW) && load.ok_share >= kLeastOkShare;
}

Cells collect(std::span<const HourlyLoad> loads, const Holidays& holidays) {
  Cells cells;
  for (const HourlyLoad& load : loads) {
    if (!is_usable(load)) continue;
    const auto day = static_cast<std::size_t>(day_type(load.date, holidays));
    cells[day][static_cast<std::size_t>(load.hour)].push_back(load.mean_kW);
  }
  return cells;
}

/// Standard error of a cell's mean from the scatter of its weekly means: days of a week are alike,
/// weeks differ.
HourlySchedule standard_errors(std::span<const HourlyLoad> loads, const Holidays& holidays) {
  struct Sum {
    double kW = 0.0;
    int n = 0;
  };
  std::map<std::tuple<std::size_t, int, std::chrono::sys_days>, Sum> weeks;
  for (const HourlyLoad& load : loads) {
    if (!is_usable(load)) continue;
    const std::chrono::sys_days date{load.date};
    const auto monday = date - (std::chrono::weekday{date} - std::chrono::Monday);
    const auto day = static_cast<std::size_t>(day_type(load.date, holidays));
    Sum& sum = weeks[{day, load.hour, monday}];
    sum.kW += load.mean_kW;
    sum.n += 1;
  }
  std::array<std::array<std::vector<double>, 24>, kDayTypes> means;
  for (const auto& [key, sum] : weeks) {
    means[std::get<0>(key)][static_cast<std::size_t>(std::get<1>(key))].push_back(sum.kW / sum.n);
  }
  HourlySchedule result;
  for (std::size_t day = 0; day < kDayTypes; ++day) {
    for (int hour = 0; hour < 24; ++hour) {
      const std::vector<double>& values = means[day][static_cast<std::size_t>(hour)];
      const double n = static_cast<double>(values.size());
      double squares = 0.0;
      const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
      for (const double value : values) squares += (value - mean) * (value - mean);
      result.at(static_cast<DayType>(day), hour) =
          n >= 3.0 ? std::sqrt(squares / (n - 1.0) / n) : kAbsent;
    }
  }
  return result;
}

double standby_kW(const Cells& cells, const KnownLoads& known) {
  std::vector<double> nights;
  for (const DayType day : {DayType::saturday, DayType::sunday_or_holiday}) {
    for (int hour = kStandbyFromHour; hour < kStandbyToHour; ++hour) {
      for (const double kW : cells[static_cast<std::size_t>(day)][static_cast<std::size_t>(hour)]) {
        nights.push_back(kW - known.exterior_kW - known.fans_and_pumps_kW.at(day, hour));
      }
    }
  }
  return nights.empty() ? 0.0 : std::max(median(std::move(nights)), 0.0);
}

void split(const KnownLoads& known, ElectricityProfile& profile) {
  const double installed = known.lighting_W_m2 + known.plugs_W_m2;
  const double light_share = installed > 0.0 ? known.lighting_W_m2 / installed : 0.0;
  for (std::size_t i = 0; i < kDayTypes; ++i) {
    const auto day = static_cast<DayType>(i);
    for (int hour = 0; hour < 24; ++hour) {
      const double indoors_kW = std::max(profile.measured_kW.at(day, hour) - known.exterior_kW -
                                             known.fans_and_pumps_kW.at(day, hour),
                                         0.0);
      const double standing_kW = std::min(profile.standby_kW, indoors_kW);
      const double rest_kW = indoors_kW - standing_kW;
      profile.loads.lights_kW.at(day, hour) = light_share * rest_kW;
      profile.loads.plugs_kW.at(day, hour) = standing_kW + (1.0 - light_share) * rest_kW;
    }
  }
}

struct MonthTotals {
  double measured_kWh = 0.0;
  double profile_kWh = 0.0;
  double variable_kWh = 0.0;  ///< Lights and plugs of the profile: what a factor acts on.
};

std::map<metering::Month, MonthTotals> monthly_totals(std::span<const HourlyLoad> loads,
                                                      const Holidays& holidays,
                                                      const ElectricityProfile& profile) {
  std::map<metering::Month, MonthTotals> months;
  for (const HourlyLoad& load : loads) {
    if (!is_usable(load)) continue;
    const DayType day = day_type(load.date, holidays);
    const auto calendar_month = static_cast<unsigned>(load.date.month());
    const double variable_kWh =
        profile.loads.lights_kW.at(day, load.hour) + profile.loads.plugs_kW.at(day, load.hour);
    MonthTotals& total = months[load.date.year() / load.date.month()];
    total.measured_kWh += load.mean_kW;
    total.variable_kWh += variable_kWh;
    total.profile_kWh += profile.measured_kW.at(day, load.hour) +
                         (profile.loads.month_factor[calendar_month - 1] - 1.0) * variable_kWh;
  }
  return months;
}

double monthly_cvrmse(const std::map<metering::Month, MonthTotals>& months) {
  double squares = 0.0;
  double measured_kWh = 0.0;
  for (const auto& [month, total] : months) {
    squares += std::pow(total.measured_kWh - total.profile_kWh, 2);
    measured_kWh += total.measured_kWh;
  }
  const double n = static_cast<double>(months.size());
  return n < 2.0 ? 0.0 : std::sqrt(squares / (n - 1.0)) / (measured_kWh / n);
}

void fit_month_factors(const std::map<metering::Month, MonthTotals>& months,
                       ElectricityProfile& profile) {
  std::array<MonthTotals, 12> by_calendar_month;
  for (const auto& [month, total] : months) {
    MonthTotals& sum = by_calendar_month[static_cast<unsigned>(month.month()) - 1];
    sum.measured_kWh += total.measured_kWh;
    sum.profile_kWh += total.profile_kWh;
    sum.variable_kWh += total.variable_kWh;
  }
  for (std::size_t i = 0; i < 12; ++i) {
    const MonthTotals& sum = by_calendar_month[i];
    if (sum.variable_kWh <= 0.0) continue;
    profile.loads.month_factor[i] =
        std::max(1.0 + (sum.measured_kWh - sum.profile_kWh) / sum.variable_kWh, 0.0);
  }
}

std::string check_words(const ProfileCheck& check, std::size_t months) {
  std::array<char, 320> text{};
  const double percent = 100.0 * check.monthly_cvrmse;
  if (check.constant) {
    std::snprintf(text.data(), text.size(),
                  "One load profile predicts the electricity of %zu months within %.1f %% "
                  "(CV(RMSE) of the months).",
                  months, percent);
  } else {
    std::snprintf(text.data(), text.size(),
                  "The load profile is not constant over the year: a single one misses the months "
                  "by %.1f %% (CV(RMSE)). The limit is 5 %%, so each calendar month has its own "
                  "factor. Months that occur once in the record match by construction.",
                  percent);
  }
  return text.data();
}

}  // namespace

std::vector<HourlyLoad> hourly_loads(const metering::MonthSlots& month) {
  const metering::MonthGrid& grid = *month.grid;
  struct Sum {
    double kW = 0.0;
    int ok = 0;
    int slots = 0;
    bool suspect = false;
  };
  std::vector<Sum> sums(static_cast<std::size_t>(grid.days()) * 24);
  const int slots_per_hour = std::max(grid.times_of_day() / 24, 1);
  for (int slot = 0; slot < grid.slots(); ++slot) {
    const int hour = grid.time_of_day(slot) / slots_per_hour;
    Sum& sum = sums[static_cast<std::size_t>(grid.day(slot) * 24 + hour)];
    sum.slots += 1;
    sum.suspect |= month.validity[static_cast<std::size_t>(slot)] == Validity::suspect;
    if (month.is_ok(slot)) {
      sum.kW += month.used_kW[static_cast<std::size_t>(slot)];
      sum.ok += 1;
    }
  }
  std::vector<HourlyLoad> hours;
  hours.reserve(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Sum& sum = sums[i];
    if (sum.slots == 0) continue;  // skipped by a clock change
    const auto day = std::chrono::day{static_cast<unsigned>(i / 24 + 1)};
    hours.push_back({.date = grid.month() / day,
                     .hour = static_cast<int>(i % 24),
                     .mean_kW = sum.ok > 0 ? sum.kW / sum.ok : kAbsent,
                     .ok_share = static_cast<double>(sum.ok) / sum.slots,
                     .suspect = sum.suspect});
  }
  return hours;
}

Result<ElectricityProfile> fit_profile(std::span<const HourlyLoad> loads, const Holidays& holidays,
                                       const KnownLoads& known) {
  const Cells cells = collect(loads, holidays);
  ElectricityProfile profile;
  profile.known = known;
  for (std::size_t day = 0; day < kDayTypes; ++day) {
    for (int hour = 0; hour < 24; ++hour) {
      const std::vector<double>& values = cells[day][static_cast<std::size_t>(hour)];
      if (values.size() < kLeastValues) {
        return failure(ErrorCode::not_enough_data,
                       std::string{"the electricity meter has only "} +
                           std::to_string(values.size()) + " valid hours at " +
                           std::to_string(hour) + " h on days of kind " + kDayTypeNames[day] +
                           "; a load profile needs at least 8 of each hour");
      }
      profile.measured_kW.at(static_cast<DayType>(day), hour) = trimmed_mean(values);
      profile.hours_used += static_cast<int>(values.size());
    }
  }
  profile.standard_error_kW = standard_errors(loads, holidays);
  profile.standby_kW = standby_kW(cells, known);
  split(known, profile);

  const auto months = monthly_totals(loads, holidays, profile);
  profile.check.monthly_cvrmse = monthly_cvrmse(months);
  profile.check.constant = profile.check.monthly_cvrmse <= kConstantCvrmse;
  if (!profile.check.constant) {
    fit_month_factors(months, profile);
    profile.check.uses_month_factors = true;
  }
  profile.check.words = check_words(profile.check, months.size());
  return profile;
}

}  // namespace recald::model
