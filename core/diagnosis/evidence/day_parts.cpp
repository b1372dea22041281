#include "core/diagnosis/evidence/day_parts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/absent.hpp"

namespace recald::diagnosis {
namespace {

constexpr double kLeastMeasuredShare = 0.75;
constexpr std::size_t kLeastMonthsToSplit = 6;

bool is_winter(metering::Month month) {
  const auto m = static_cast<unsigned>(month.month());
  return m == 12 || m <= 2;
}
bool is_summer(metering::Month month) {
  const auto m = static_cast<unsigned>(month.month());
  return m >= 6 && m <= 8;
}

void add_hour(const model::DriverHour& hour, int index, std::vector<DayPart>& parts) {
  const int part = hour.local_hour / kHoursPerPart;
  if (parts.empty() || parts.back().date != hour.date || parts.back().part != part) {
    parts.push_back({.date = hour.date,
                     .part = part,
                     .day_index = hour.day_index,
                     .part_of_week = static_cast<int>(hour.weekday) * kPartsPerDay + part,
                     .first_hour = index,
                     .hours = 0,
                     .month = hour.month,
                     .day = hour.day,
                     .time_h = 0.0,
                     .dry_bulb_C = 0.0,
                     .humidity_ratio = 0.0,
                     .wind_m_s = 0.0,
                     .global_horizontal_W_m2 = 0.0});
  }
  DayPart& last = parts.back();
  ++last.hours;
  last.dry_bulb_C += hour.dry_bulb_C;
  last.humidity_ratio += hour.humidity_ratio;
  last.wind_m_s += hour.wind_m_s;
  last.global_horizontal_W_m2 += hour.global_horizontal_W_m2;
}

/// The latest month of this season that is neither held out nor among the first
/// three of the record.
template <class IsSeason>
void show_one(const std::vector<metering::Month>& months, IsSeason is_season,
              std::vector<Role>& roles) {
  for (std::size_t i = 0; i < months.size(); ++i) {
    if (roles[i] == Role::show && is_season(months[i])) return;
  }
  for (std::size_t i = months.size(); i-- > 3;) {
    if (roles[i] == Role::fit && is_season(months[i])) {
      roles[i] = Role::show;
      return;
    }
  }
}

std::size_t count_of(const std::vector<Role>& roles, Role role) {
  return static_cast<std::size_t>(std::ranges::count(roles, role));
}

}  // namespace

DayParts make_day_parts(const model::Drivers& drivers) {
  DayParts result;
  for (std::size_t i = 0; i < drivers.hours.size(); ++i) {
    add_hour(drivers.hours[i], static_cast<int>(i), result.parts);
  }
  for (DayPart& part : result.parts) {
    const double n = part.hours;
    part.dry_bulb_C /= n;
    part.humidity_ratio /= n;
    part.wind_m_s /= n;
    part.global_horizontal_W_m2 /= n;
    const auto since_first = drivers.hours[static_cast<std::size_t>(part.first_hour)].start -
                             drivers.hours.front().start;
    part.time_h = std::chrono::duration<double, std::ratio<3600>>(since_first).count() + 0.5 * n;
  }
  return result;
}

void DayParts::average_into(const Eigen::Ref<const Eigen::ArrayXXd>& hourly,
                            Eigen::ArrayXXd& means) const {
  assert(means.rows() == count() && means.cols() == hourly.cols());
  for (Eigen::Index g = 0; g < hourly.cols(); ++g) {
    const double* column = hourly.col(g).data();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      double sum = 0.0;
      const double* hour = column + parts[i].first_hour;
      for (int h = 0; h < parts[i].hours; ++h) sum += hour[h];
      means(static_cast<Eigen::Index>(i), g) = sum / parts[i].hours;
    }
  }
}

Eigen::ArrayXXd measured_parts(const DayParts& day_parts,
                               const Eigen::Ref<const Eigen::ArrayXXd>& hourly_kW) {
  Eigen::ArrayXXd means(day_parts.count(), hourly_kW.cols());
  for (Eigen::Index g = 0; g < hourly_kW.cols(); ++g) {
    for (Eigen::Index i = 0; i < day_parts.count(); ++i) {
      const DayPart& part = day_parts.parts[static_cast<std::size_t>(i)];
      double sum = 0.0;
      int measured = 0;
      for (int h = 0; h < part.hours; ++h) {
        const double value = hourly_kW(part.first_hour + h, g);
        if (!std::isfinite(value)) continue;
        sum += value;
        ++measured;
      }
      const bool enough = measured >= kLeastMeasuredShare * part.hours;
      means(i, g) = enough ? sum / measured : kAbsent;
    }
  }
  return means;
}

std::vector<Role> split_months(const std::vector<metering::Month>& months,
                               const SplitOptions& options) {
  std::vector<Role> roles(months.size(), Role::fit);
  const std::size_t n = months.size();
  if (n < kLeastMonthsToSplit) return roles;
  const auto share = [n](double s) {
    return static_cast<std::size_t>(std::lround(s * static_cast<double>(n)));
  };
  const auto last =
      std::min<std::size_t>(static_cast<std::size_t>(options.last_months_to_show), n / 3);
  std::fill(roles.end() - static_cast<std::ptrdiff_t>(last), roles.end(), Role::show);
  if (n >= 12) {
    show_one(months, is_winter, roles);
    show_one(months, is_summer, roles);
  }
  // The rest one by one from the end, each at least two months from the months already held out.
  for (std::size_t i = n; i-- > 3 && count_of(roles, Role::show) < share(options.show_share);) {
    const bool apart = roles[i] == Role::fit &&
                       (i + 2 >= n || (roles[i + 1] == Role::fit && roles[i + 2] == Role::fit));
    if (apart) roles[i] = Role::show;
  }
  // Months to choose by are spread evenly, so that every season has some.
  const std::size_t wanted = share(options.select_share);
  const std::size_t left = n - count_of(roles, Role::show);
  std::size_t seen = 0;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < n && wanted > 0; ++i) {
    if (roles[i] != Role::fit) continue;
    ++seen;
    // The middle of each of `wanted` equal stretches.
    if (2 * seen * wanted >= (2 * taken + 1) * left) {
      roles[i] = Role::select;
      ++taken;
    }
  }
  return roles;
}

std::vector<Role> split_months(const std::vector<metering::Month>& months,
                               const std::vector<metering::Month>& read,
                               const SplitOptions& options) {
  std::vector<Role> roles(months.size(), Role::fit);
  const std::vector<Role> of_read = split_months(read, options);
  for (std::size_t i = 0; i < read.size(); ++i) {
    roles[static_cast<std::size_t>(std::ranges::find(months, read[i]) - months.begin())] =
        of_read[i];
  }
  return roles;
}

std::vector<Role> part_roles(const DayParts& day_parts, const std::vector<Role>& month_roles,
                             int buffer_days) {
  const auto& parts = day_parts.parts;
  std::vector<Role> roles(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    roles[i] = month_roles[static_cast<std::size_t>(parts[i].month)];
  }
  const auto yields = [](Role mine, Role other) {
    return mine < other;  // fit yields to select and show, select to show
  };
  const std::vector<Role> before = roles;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0 && before[i] == before[i - 1]) continue;
    if (i == 0) continue;
    // The role changes between i-1 and i: the yielding side loses its nearest days.
    if (yields(before[i - 1], before[i])) {
      for (std::size_t j = i; j-- > 0 && before[j] == before[i - 1] &&
                              parts[i].day_index - parts[j].day_index <= buffer_days;) {
        roles[j] = Role::buffer;
      }
    } else {
      for (std::size_t j = i; j < parts.size() && before[j] == before[i] &&
                              parts[j].day_index - parts[i - 1].day_index <= buffer_days;
           ++j) {
        roles[j] = Role::buffer;
      }
    }
  }
  return roles;
}

}  // namespace recald::diagnosis
