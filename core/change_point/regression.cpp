#include "core/change_point/regression.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "core/absent.hpp"
#include "core/change_point/month_errors.hpp"
#include "core/change_point/selection.hpp"
#include "core/text/number_text.hpp"

namespace recald::change_point {
namespace {

constexpr int kLeastMonths = 6;  // or blocks are sixths of the days
constexpr int kMostFolds = 13;   // not 12: a fold has months of different seasons
constexpr int kRounds = 3;       // of weights
constexpr double kSettled = 0.01;
constexpr int kBesideRange = 10;           // days on either side of …
constexpr double kLeastRange_K = 3.0;      // … the temperatures that a slope takes
constexpr double kLeastScatter = 0.05;     // of all days' rms
constexpr double kRoundingScatter = 1e-4;  // of the mean: a meter's register is no finer
constexpr double kLeastSd_kWh = 1e-6;      // of a meter that shows nothing

// What a thermometer in the shade has ever shown, and some more: what lies outside is a code or a
// wrong unit.
constexpr double kColdest_C = -95.0;
constexpr double kHottest_C = 65.0;

struct Training {
  std::vector<TrainingDay> days;
  bool with_temperature = true;
  std::string no_temperature_because;
  double coldest_C = kAbsent;
  double warmest_C = kAbsent;
};

int day_number(const MeterDay& day) {
  return static_cast<int>(std::chrono::sys_days{day.date}.time_since_epoch().count());
}

std::vector<double> sorted_temperatures(const std::vector<TrainingDay>& days) {
  std::vector<double> values(days.size());
  std::ranges::transform(days, values.begin(), &TrainingDay::dry_bulb_C);
  std::ranges::sort(values);
  return values;
}

/// Calendar months, or stretches of as many days where there are few months.
void assign_blocks(std::vector<TrainingDay>& days) {
  std::vector<int> month_index;
  int months = 0;
  std::optional<metering::Month> last;
  for (const TrainingDay& day : days) {
    const metering::Day date{std::chrono::sys_days{std::chrono::days{day.day_number}}};
    const metering::Month month = date.year() / date.month();
    if (last != month) ++months;
    last = month;
    month_index.push_back(months - 1);
  }
  const int blocks = std::max(months, kLeastMonths);
  for (std::size_t i = 0; i < days.size(); ++i) {
    days[i].block =
        months >= kLeastMonths ? month_index[i] : static_cast<int>(i * kLeastMonths / days.size());
    days[i].fold = days[i].block % std::min(blocks, kMostFolds);
  }
}

std::optional<Error> fault_of(const MeterDay& day) {
  if (std::isinf(day.energy_kWh)) {
    return Error{ErrorCode::not_finite, "the consumption of " + metering::to_string(day.date) +
                                            " is infinite; leave unknown values out"};
  }
  if (day.dry_bulb_C < kColdest_C || day.dry_bulb_C > kHottest_C) {
    return Error{ErrorCode::out_of_range,
                 "the mean temperature of " + metering::to_string(day.date) + " is " +
                     number_text(day.dry_bulb_C) + " °C; use °C, and leave unknown values out"};
  }
  return {};
}

Result<Training> collect(std::span<const MeterDay> days) {
  Training training;
  int with_temperature = 0;
  for (const MeterDay& day : days) {
    if (auto fault = fault_of(day)) return tl::unexpected(std::move(*fault));
    if (std::isnan(day.energy_kWh)) continue;
    if (!std::isnan(day.dry_bulb_C)) ++with_temperature;
    training.days.push_back({.day_number = day_number(day),
                             .type = day.type,
                             .dry_bulb_C = day.dry_bulb_C,
                             .energy_kWh = day.energy_kWh});
  }
  const int usable = static_cast<int>(training.days.size());
  if (usable < kLeastDays) {
    return failure(ErrorCode::not_enough_data,
                   "a change-point regression needs " + std::to_string(kLeastDays) +
                       " days with a usable consumption, but there are " + std::to_string(usable) +
                       "; wait for more days, or provide more recorded ones");
  }
  if (with_temperature < kLeastDays) {
    training.no_temperature_because = "only " + std::to_string(with_temperature) + " of " +
                                      std::to_string(usable) + " usable days have a temperature";
  } else {
    std::erase_if(training.days, [](const TrainingDay& day) { return std::isnan(day.dry_bulb_C); });
    const std::vector<double> sorted = sorted_temperatures(training.days);
    training.coldest_C = sorted.front();
    training.warmest_C = sorted.back();
    const double low = sorted[kBesideRange - 1];
    const double high = sorted[sorted.size() - kBesideRange];
    if (high - low < kLeastRange_K) {
      training.no_temperature_because = "nearly all usable days lie between " +
                                        number_text(low, 3) + " and " + number_text(high, 3) +
                                        " °C, too close together for a slope";
    }
  }
  training.with_temperature = training.no_temperature_because.empty();
  if (!training.with_temperature) {
    for (TrainingDay& day : training.days) day.dry_bulb_C = 0.0;
  }
  assign_blocks(training.days);
  return training;
}

void take_fits(const Choice& choice, const std::vector<GroupFit>& fits, Regression& regression) {
  regression.curves.clear();
  int bases = 0;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    int in_group = 0;
    for (std::size_t type = 0; type < model::kDayTypes; ++type) {
      const int base = choice.groups[k][type];
      if (base == kNotInGroup) continue;
      regression.base_kWh[type] = fits[k].base_kWh[static_cast<std::size_t>(base)];
      regression.base_number[type] = bases + base;
      regression.curve_of[type] = k;
      in_group = std::max(in_group, base + 1);
    }
    bases += in_group;
    regression.curves.push_back(fits[k].curve);
  }
}

std::span<const double> view(const Eigen::VectorXd& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

FittedDays look_at(const std::vector<TrainingDay>& days, Regression& regression) {
  const auto n = static_cast<Eigen::Index>(days.size());
  FittedDays fitted{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const TrainingDay& day = days[static_cast<std::size_t>(i)];
    fitted.level_kWh(i) = regression.expected_kWh(day.type, day.dry_bulb_C);
    fitted.residual_kWh(i) = day.energy_kWh - fitted.level_kWh(i);
  }
  const double rms = std::sqrt(fitted.residual_kWh.squaredNorm() / static_cast<double>(n));
  const double least =
      std::max({kLeastScatter * rms, kRoundingScatter * regression.mean_kWh, kLeastSd_kWh});
  regression.scatter = ScatterByLevel{view(fitted.level_kWh), view(fitted.residual_kWh), least};
  fitted.sd_kWh = fitted.level_kWh.unaryExpr([&](double l) { return regression.scatter.at(l); });
  return fitted;
}

}  // namespace

double Regression::expected_kWh(model::DayType type, double dry_bulb_C) const {
  const auto kind = static_cast<std::size_t>(type);
  return base_kWh[kind] + curves[curve_of[kind]].at(dry_bulb_C);
}

Result<Regression> fit_regression(std::span<const MeterDay> days) {
  assert(std::ranges::adjacent_find(days, std::ranges::greater_equal{}, &MeterDay::date) ==
         days.end());
  auto training = TRY(collect(days));
  Regression regression{.days = static_cast<int>(training.days.size()),
                        .coldest_C = training.coldest_C,
                        .warmest_C = training.warmest_C,
                        .no_temperature_because = training.no_temperature_because};
  for (const TrainingDay& day : training.days) {
    regression.mean_kWh += std::abs(day.energy_kWh) / regression.days;
  }
  Selector selector{training.days, training.with_temperature};
  Selection selection;
  FittedDays fitted;
  for (int round = 0; round < kRounds; ++round) {
    selection = selector.select(training.days);
    take_fits(selection.choice, selector.fit(training.days, selection.choice), regression);
    fitted = look_at(training.days, regression);
    double moved = 0.0;
    for (std::size_t i = 0; i < training.days.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double weight = outlier_weight(fitted.residual_kWh(at) / fitted.sd_kWh(at));
      moved = std::max(moved, std::abs(weight - training.days[i].weight));
      training.days[i].weight = weight;
    }
    if (moved < kSettled) break;
  }
  learn_errors(training.days, selection.left_out_residual_kWh, fitted, regression);
  return regression;
}

}  // namespace recald::change_point
