#include "core/model/epc/climate_classes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace recald::model::epc {
namespace {

/// Longer than any night of a building with a five-day week: a weekend or holiday.
constexpr double kLongStretch_h = 24.0;
constexpr std::size_t kStretchClasses = 4;
constexpr int kHoursOfPart = 4;

using HourIndices = std::vector<std::size_t>;

void append_class(const Drivers& drivers, std::span<const std::size_t> members,
                  ClimateClasses& out) {
  ClimateClass mean{};
  Eigen::ArrayXd irradiance = Eigen::ArrayXd::Zero(drivers.irradiance_W_m2.rows());
  for (const std::size_t i : members) {
    const DriverHour& hour = drivers.hours[i];
    mean.dry_bulb_C += hour.dry_bulb_C;
    mean.wind2_m2_s2 += hour.wind_m_s * hour.wind_m_s;
    mean.occupied_fraction += hour.occupied_fraction;
    mean.lights_W += hour.lights_W;
    mean.plugs_W += hour.plugs_W;
    mean.humidity_ratio += hour.humidity_ratio;
    irradiance += drivers.irradiance_W_m2.col(static_cast<Eigen::Index>(i));
  }
  const double n = static_cast<double>(members.size());
  out.classes.push_back({n, mean.dry_bulb_C / n, mean.wind2_m2_s2 / n, mean.occupied_fraction / n,
                         mean.lights_W / n, mean.plugs_W / n, mean.humidity_ratio / n});
  for (const double sum : irradiance) out.irradiance_W_m2.push_back(sum / n);
}

/// Splits sorted hours into classes of equal count.
void append_classes(const Drivers& drivers, std::span<const std::size_t> members,
                    std::size_t classes, ClimateClasses& out) {
  const std::size_t n = members.size();
  for (std::size_t k = 0; k < classes; ++k) {
    const std::size_t from = k * n / classes;
    const std::size_t to = (k + 1) * n / classes;
    append_class(drivers, members.subspan(from, to - from), out);
  }
}

/// Gives a part of the day its share of the state's classes.
std::size_t classes_in(std::ptrdiff_t part_hours, std::size_t state_hours, int classes_per_state) {
  const auto n = static_cast<std::size_t>(part_hours);
  if (classes_per_state == 0) return n;
  const double share = static_cast<double>(n) / static_cast<double>(state_hours);
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(share * classes_per_state)),
                                 1, n);
}

ClimateState make_state(const Drivers& drivers, HourIndices members, int classes_per_state,
                        ClimateClasses& out) {
  ClimateState state;
  state.hours = static_cast<double>(members.size());
  state.first_class = static_cast<int>(out.classes.size());

  const auto part_of_day = [&](std::size_t i) {
    return drivers.hours[i].local_hour / kHoursOfPart;
  };
  std::ranges::stable_sort(members, {}, [&](std::size_t i) {
    return std::pair{part_of_day(i), drivers.hours[i].dry_bulb_C};
  });
  for (auto part = members.begin(); part != members.end();) {
    const auto end = std::find_if(
        part, members.end(),
        [&, first = part_of_day(*part)](std::size_t i) { return part_of_day(i) != first; });
    append_classes(drivers, {part, end}, classes_in(end - part, members.size(), classes_per_state),
                   out);
    part = end;
  }
  state.classes = static_cast<int>(out.classes.size()) - state.first_class;

  for (const std::size_t i : members) {
    state.humidity_ratio.push_back(drivers.hours[i].humidity_ratio);
  }
  std::ranges::sort(state.humidity_ratio);
  state.humidity_ratio_sum.assign(members.size() + 1, 0.0);
  std::partial_sum(state.humidity_ratio.begin(), state.humidity_ratio.end(),
                   state.humidity_ratio_sum.begin() + 1);
  return state;
}

/// Runs of unoccupied hours in one month, each with its length and mean temperature.
std::vector<StretchClass> find_stretches(const Drivers& drivers, std::size_t from, std::size_t to) {
  std::vector<StretchClass> stretches;
  double hours = 0.0;
  double sum_C = 0.0;
  const auto close = [&] {
    if (hours > 0.0) stretches.push_back({hours, hours, sum_C / hours});
    hours = 0.0;
    sum_C = 0.0;
  };
  for (std::size_t i = from; i < to; ++i) {
    if (drivers.hours[i].occupied) {
      close();
    } else {
      hours += 1.0;
      sum_C += drivers.hours[i].dry_bulb_C;
    }
  }
  close();
  return stretches;
}

std::vector<StretchClass> merge_like(std::vector<StretchClass> stretches) {
  std::vector<StretchClass> classes;
  const auto short_ones = std::ranges::stable_partition(
      stretches, [](const StretchClass& s) { return s.length_h <= kLongStretch_h; });
  const auto merge = [&](auto begin, auto end) {
    std::sort(begin, end, [](const auto& a, const auto& b) { return a.dry_bulb_C < b.dry_bulb_C; });
    const auto n = static_cast<std::size_t>(end - begin);
    const std::size_t count = std::min(n, kStretchClasses);
    for (std::size_t k = 0; k < count; ++k) {
      StretchClass merged{};
      double members = 0.0;
      for (std::size_t i = k * n / count; i < (k + 1) * n / count; ++i) {
        const StretchClass& s = begin[static_cast<std::ptrdiff_t>(i)];
        merged.hours += s.hours;
        merged.dry_bulb_C += s.hours * s.dry_bulb_C;
        members += 1.0;
      }
      classes.push_back({merged.hours, merged.hours / members, merged.dry_bulb_C / merged.hours});
    }
  };
  merge(stretches.begin(), short_ones.begin());
  merge(short_ones.begin(), stretches.end());
  return classes;
}

ClimateMonth make_month(const Drivers& drivers, std::size_t month, std::size_t from, std::size_t to,
                        int classes_per_state, ClimateClasses& out) {
  HourIndices occupied;
  HourIndices unoccupied;
  for (std::size_t i = from; i < to; ++i) {
    (drivers.hours[i].occupied ? occupied : unoccupied).push_back(i);
  }
  const metering::Month calendar_month = drivers.months[month];
  const int days = metering::days_in(calendar_month);
  const auto new_year = std::chrono::sys_days{calendar_month.year() / 1 / 1};
  const auto first = std::chrono::sys_days{calendar_month / 1};
  ClimateMonth result;
  result.days = days;
  result.day_of_year_mid = static_cast<double>((first - new_year).count()) + 0.5 * days;
  result.occupied = make_state(drivers, std::move(occupied), classes_per_state, out);
  result.unoccupied = make_state(drivers, std::move(unoccupied), classes_per_state, out);
  result.stretches = merge_like(find_stretches(drivers, from, to));
  const auto share = [&](bool DriverHour::*plant) {
    const std::span hours{drivers.hours.data() + from, to - from};
    return static_cast<double>(std::ranges::count(hours, true, plant)) /
           static_cast<double>(hours.size());
  };
  result.heating_share = share(&DriverHour::heating);
  result.cooling_share = share(&DriverHour::cooling);
  return result;
}

}  // namespace

double ClimateState::excess_over(double cut) const {
  const auto above = std::ranges::upper_bound(humidity_ratio, cut);
  const auto below = static_cast<std::size_t>(above - humidity_ratio.begin());
  const double count = static_cast<double>(humidity_ratio.size() - below);
  return humidity_ratio_sum.back() - humidity_ratio_sum[below] - count * cut;
}

double ClimateState::shortfall_under(double cut) const {
  const auto above = std::ranges::lower_bound(humidity_ratio, cut);
  const auto below = static_cast<std::size_t>(above - humidity_ratio.begin());
  return static_cast<double>(below) * cut - humidity_ratio_sum[below];
}

std::span<const double> ClimateClasses::irradiance(int class_index) const {
  const std::size_t n = orientations.size();
  return std::span{irradiance_W_m2}.subspan(static_cast<std::size_t>(class_index) * n, n);
}

ClimateClasses make_climate_classes(const Drivers& drivers, int classes_per_state) {
  ClimateClasses result;
  result.orientations = drivers.orientations;
  result.pressure_Pa = drivers.pressure_Pa;
  std::size_t from = 0;
  for (std::size_t month = 0; month < drivers.months.size(); ++month) {
    std::size_t to = from;
    while (to < drivers.hours.size() && drivers.hours[to].month == static_cast<int>(month)) ++to;
    result.months.push_back(make_month(drivers, month, from, to, classes_per_state, result));
    from = to;
  }
  return result;
}

}  // namespace recald::model::epc
