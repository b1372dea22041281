#include "core/profile/load_band.hpp"

#include <algorithm>
#include <cmath>

#include "core/statistics/quantile.hpp"

namespace recald::profile {
namespace {

constexpr std::size_t kOfEachHour = 50;  // of the nearest; three hours of the day make a band
constexpr std::size_t kFewest = 40;

std::size_t index_of(model::DayType day, int local_hour) {
  return static_cast<std::size_t>(local_hour) + (day == model::DayType::workday ? 0U : 24U);
}

}  // namespace

LoadBand::LoadBand(std::span<const ModelledHour> hours) {
  for (const ModelledHour& hour : hours) {
    if (std::isnan(hour.measured_kW) || std::isnan(hour.modelled_kW)) continue;
    cells_[index_of(hour.day, hour.local_hour)].push_back(
        {hour.modelled_kW, hour.measured_kW - hour.modelled_kW});
    least_kW_ = std::min(least_kW_, hour.measured_kW);
  }
  for (std::vector<Hour>& cell : cells_) {
    std::ranges::stable_sort(cell, {}, &Hour::modelled_kW);
  }
}

const std::vector<LoadBand::Hour>& LoadBand::cell(model::DayType day, int local_hour) const {
  return cells_[index_of(day, (local_hour + 24) % 24)];
}

std::optional<ExpectedLoad> LoadBand::at(model::DayType day, int local_hour,
                                         double modelled_kW) const {
  std::vector<double> residuals_kW;
  for (const int near : {local_hour - 1, local_hour, local_hour + 1}) {
    const std::vector<Hour>& hours = cell(day, near);
    // The window of neighbours slides along the sorted hours while the next one is nearer.
    const auto found = std::ranges::lower_bound(hours, modelled_kW, {}, &Hour::modelled_kW);
    std::size_t begin = static_cast<std::size_t>(found - hours.begin());
    std::size_t end = begin;
    while (end - begin < kOfEachHour && (begin > 0 || end < hours.size())) {
      const bool is_lower_nearer =
          end == hours.size() || (begin > 0 && modelled_kW - hours[begin - 1].modelled_kW <=
                                                   hours[end].modelled_kW - modelled_kW);
      if (is_lower_nearer) {
        --begin;
      } else {
        ++end;
      }
    }
    for (std::size_t i = begin; i < end; ++i) residuals_kW.push_back(hours[i].residual_kW);
  }
  if (residuals_kW.size() < kFewest) return std::nullopt;
  std::ranges::sort(residuals_kW);
  return not_below_what_was_measured({modelled_kW + quantile_of_sorted(residuals_kW, 0.05),
                                      modelled_kW + quantile_of_sorted(residuals_kW, 0.5),
                                      modelled_kW + quantile_of_sorted(residuals_kW, 0.95)});
}

/// A meter that stands still at night has residuals as large as the model is wrong, but never runs
/// backwards.
ExpectedLoad LoadBand::not_below_what_was_measured(ExpectedLoad load) const {
  for (double* const kW : {&load.q05_kW, &load.q50_kW, &load.q95_kW}) {
    *kW = std::max(*kW, least_kW_);
  }
  return load;
}

}  // namespace recald::profile
