#include "core/profile/load_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "core/absent.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::profile {
namespace {

using model::DayType;

constexpr double kLeastMeasured = 0.5;  // of an hour's slots
constexpr std::size_t kWeek_h = 7 * 24;
constexpr double kBaseProbability = 0.05;

bool is_believed(const model::HourlyLoad& load) {
  return std::isfinite(load.mean_kW) && load.ok_share >= kLeastMeasured && !load.suspect;
}

void find_base(std::vector<double> loads_kW, LoadShape& shape) {
  shape.base_kW = shape.base_share = kAbsent;
  if (loads_kW.size() < kWeek_h) return;
  std::ranges::sort(loads_kW);
  shape.base_kW = quantile_of_sorted(loads_kW, kBaseProbability);
  const double mean_kW =
      std::accumulate(loads_kW.begin(), loads_kW.end(), 0.0) / static_cast<double>(loads_kW.size());
  if (loads_kW.front() >= 0.0 && mean_kW > 0.0) shape.base_share = shape.base_kW / mean_kW;
}

}  // namespace

LoadShape load_shape(std::span<const model::HourlyLoad> loads, const model::Holidays& holidays) {
  LoadShape shape;
  std::array<std::array<int, 24>, model::kDayTypes> counts{};
  std::array<std::set<metering::Day>, model::kDayTypes> days;
  std::vector<double> loads_kW;
  for (const model::HourlyLoad& load : loads) {
    if (!is_believed(load)) continue;
    const DayType type = model::day_type(load.date, holidays);
    const auto kind = static_cast<std::size_t>(type);
    shape.mean_kW.at(type, load.hour) += load.mean_kW;
    ++counts[kind][static_cast<std::size_t>(load.hour)];
    days[kind].insert(load.date);
    loads_kW.push_back(load.mean_kW);
  }
  for (std::size_t kind = 0; kind < model::kDayTypes; ++kind) {
    shape.days[kind] = static_cast<int>(days[kind].size());
    for (int hour = 0; hour < 24; ++hour) {
      const int count = counts[kind][static_cast<std::size_t>(hour)];
      double& mean_kW = shape.mean_kW.at(static_cast<DayType>(kind), hour);
      mean_kW = count > 0 ? mean_kW / count : kAbsent;
    }
  }
  find_base(std::move(loads_kW), shape);
  return shape;
}

}  // namespace recald::profile
