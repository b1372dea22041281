#include "core/metering/months/series_doubts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "core/absent.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::metering {
namespace {

/// Of measured slots; NaN: none.
double mean_of(const MonthSlots& month, int from, int to) {
  double sum = 0.0;
  int count = 0;
  for (int slot = std::max(0, from); slot < std::min(to, month.grid->slots()); ++slot) {
    const double value = month.measured_kW[static_cast<std::size_t>(slot)];
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : kAbsent;
}

/// The highest measured slot outside of [from, to); NaN: none.
double highest_beside(const MonthSlots& month, int from, int to) {
  double highest_kW = kAbsent;
  for (int slot = 0; slot < month.slots(); ++slot) {
    const double value_kW = month.measured_kW[static_cast<std::size_t>(slot)];
    const bool is_beside = slot < from || slot >= to;
    if (is_beside && !(value_kW <= highest_kW) && !std::isnan(value_kW)) highest_kW = value_kW;
  }
  return highest_kW;
}

/// The first slot of the hour that a clock change repeats, on its day; nothing on other days.
std::optional<int> repeated_hour(const MonthGrid& grid, int begin, int end) {
  for (int slot = begin + 1; slot < end; ++slot) {
    if (grid.time_of_day(slot) > grid.time_of_day(slot - 1)) continue;
    const int per_hour = static_cast<int>(std::chrono::hours{1} / grid.interval());
    return slot - per_hour;  // it is the second pass that begins there
  }
  return {};
}

/// Factors between units that people mix up, and what they mean. Smaller ones than 8 occur in
/// buildings.
struct UnitFactor {
  double factor;
  const char* meaning;
};
constexpr std::array<UnitFactor, 6> kUnitFactors{{{29.307, "kWh in a therm"},
                                                  {1000.0, "Wh in a kWh"},
                                                  {10.55, "kWh in a cubic metre of gas"},
                                                  {293.07, "kWh in an MMBtu"},
                                                  {277.78, "kWh in a GJ"},
                                                  {3412.1, "BTU in a kWh"}}};
constexpr double kFactorOff = 0.06;  // of its logarithm, what a week's load does by itself
constexpr std::size_t kDaysBeside = 7;

const UnitFactor* unit_factor(double ratio) {
  const double size = std::abs(std::log(ratio));
  const auto found = std::ranges::find_if(kUnitFactors, [&](const UnitFactor& one) {
    return std::abs(size - std::log(one.factor)) < kFactorOff;
  });
  return found == kUnitFactors.end() ? nullptr : &*found;
}

/// A day and its mean.
struct DayMean {
  Day date;
  double kW;
};

DataFinding unit_finding(std::string_view meter, const DayMean& day, double ratio,
                         const UnitFactor& factor) {
  std::array<char, 64> times{};
  std::snprintf(times.data(), times.size(), ratio > 1.0 ? "%.3g times" : "1/%.3g of",
                ratio > 1.0 ? ratio : 1.0 / ratio);
  return {.meter = std::string{meter},
          .sentence = "From " + to_string(day.date) + " on it reads " + times.data() +
                      " what it read in the week before: probably another unit (there are " +
                      std::to_string(static_cast<int>(std::lround(factor.factor))) + " " +
                      factor.meaning + "). Give each part its own [[meter]] and unit.",
          .span = {},
          .slots = 0,
          .grade = DataFinding::Grade::warning};
}

/// Where a unit changes from one day to the next, both weeks beside it agree, and so do the two
/// days.
std::vector<DataFinding> unit_changes(std::string_view meter, const std::vector<DayMean>& days) {
  std::vector<DataFinding> findings;
  for (std::size_t i = kDaysBeside; i + kDaysBeside <= days.size(); ++i) {
    std::vector<double> before;
    std::vector<double> since;
    for (std::size_t k = 1; k <= kDaysBeside; ++k) {
      before.push_back(days[i - k].kW);
      since.push_back(days[i + k - 1].kW);
    }
    // What feeds in on some days and draws on others has a mean of any size.
    if (std::ranges::min(since) <= 0.0 || std::ranges::min(before) <= 0.0) continue;
    const double ratio = median(since) / median(before);
    if (!(ratio > 0.0) || std::isinf(ratio)) continue;
    const UnitFactor* factor = unit_factor(ratio);
    if (factor == nullptr) continue;
    const double sharp = ratio > 1.0 ? std::ranges::min(since) / std::ranges::max(before)
                                     : std::ranges::min(before) / std::ranges::max(since);
    if (sharp * 4.0 < factor->factor) continue;
    findings.push_back(unit_finding(meter, days[i], ratio, *factor));
    i += kDaysBeside;
  }
  return findings;
}

}  // namespace

/// Where the two passes of a repeated hour stand if a file has one row for both. A file of starts
/// has them in the first pass; one of ends an interval earlier, as its clock shows the first end
/// of the second pass as the last of the hour before, or, if an end is its begin's time plus the
/// interval, with the last end where the second pass ends.
std::optional<SeriesDoubts::SummedHour> SeriesDoubts::summed_hour(const MonthSlots& month,
                                                                  int first, int per_hour) {
  struct Pattern {
    int summed_from;  ///< Slots after the first …
    int summed;       ///< … and how many in a row.
    bool is_last_summed;
  };
  const int second = first + per_hour;
  const double beside = 0.5 * (mean_of(month, first - 1 - per_hour, first - 1) +
                               mean_of(month, second + per_hour, second + 2 * per_hour));
  for (const Pattern& pattern : {Pattern{0, per_hour, false}, Pattern{-1, per_hour, false},
                                 Pattern{0, per_hour - 1, true}}) {
    const int begin = first + pattern.summed_from;
    const int end = begin + pattern.summed;
    double sum_kW = 0.0;
    for (int slot = begin; slot < end; ++slot) sum_kW += mean_of(month, slot, slot + 1);
    if (pattern.is_last_summed) sum_kW += mean_of(month, second + per_hour - 1, second + per_hour);
    const bool stands_once = std::isnan(mean_of(month, end, end + per_hour));
    const double ratio = sum_kW / per_hour / beside;
    constexpr double kSummedMin = 1.6;
    constexpr double kSummedMax = 2.4;
    constexpr double kFarAbove = 1.2;  // any other of the month, however the load moves around it
    const bool is_double = ratio > kSummedMin && ratio < kSummedMax;
    const bool is_highest =
        sum_kW / per_hour > kFarAbove * highest_beside(month, begin, second + per_hour);
    if (!stands_once || !(is_double || is_highest)) continue;
    return SummedHour{{month.grid->start(begin), month.grid->start(second + per_hour)}, ratio};
  }
  return {};
}

void SeriesDoubts::take(const MonthSlots& month) {
  const MonthGrid& grid = *month.grid;
  OneMonth& one = months_[grid.month()] = {};
  find_higher_estimate(month);
  const int per_hour = static_cast<int>(std::chrono::hours{1} / grid.interval());
  for (int day = 0; day < grid.days(); ++day) {
    const int begin = grid.day_begins()[static_cast<std::size_t>(day)];
    const int end = grid.day_begins()[static_cast<std::size_t>(day) + 1];
    one.days_kW.push_back(mean_of(month, begin, end));
    const auto first = repeated_hour(grid, begin, end);
    if (!first || per_hour < 1) continue;
    if (const auto hour = summed_hour(month, *first, per_hour)) one.summed.push_back(*hour);
  }
}

/// A peak is measured; a higher value that its source calls an estimate may have been one.
void SeriesDoubts::find_higher_estimate(const MonthSlots& month) {
  constexpr double kHigher = 1.002;  // less is no news
  const auto highest = [&](const auto& counts) {
    int found = -1;
    for (int slot = 0; slot < month.slots(); ++slot) {
      const auto i = static_cast<std::size_t>(slot);
      if (!counts(i)) continue;
      if (found < 0 || month.measured_kW[i] > month.measured_kW[static_cast<std::size_t>(found)]) {
        found = slot;
      }
    }
    return found;
  };
  const int estimate = highest([&](std::size_t i) {
    return month.validity[i] == Validity::scaled && has(month.reasons[i], Reason::estimated) &&
           !std::isnan(month.measured_kW[i]);
  });
  if (estimate < 0) return;
  const int measured = highest([&](std::size_t i) { return month.validity[i] == Validity::ok; });
  if (measured < 0) return;  // such a month has no peak
  const double estimate_kW = month.measured_kW[static_cast<std::size_t>(estimate)];
  const double measured_kW = month.measured_kW[static_cast<std::size_t>(measured)];
  if (estimate_kW <= kHigher * measured_kW) return;
  months_[month.grid->month()].higher_estimate = {month.grid->start(estimate), estimate_kW,
                                                  measured_kW};
}

std::optional<DataFinding> SeriesDoubts::higher_estimates(std::string_view meter) const {
  std::optional<HigherEstimate> farthest;
  int count = 0;
  for (const auto& [month, one] : months_) {
    if (!one.higher_estimate) continue;
    ++count;
    const HigherEstimate& here = *one.higher_estimate;
    if (!farthest ||
        here.estimate_kW * farthest->measured_kW > farthest->estimate_kW * here.measured_kW) {
      farthest = here;
    }
  }
  if (!farthest) return {};
  std::array<char, 64> kW{};
  std::snprintf(kW.data(), kW.size(), "%.4g kW beside a peak of %.4g kW", farthest->estimate_kW,
                farthest->measured_kW);
  return DataFinding{
      .meter = std::string{meter},
      .sentence = "In " + std::to_string(count) + (count == 1 ? " month" : " months") +
                  " a value that its quality flag calls an estimate is higher than the peak, which "
                  "counts measured ones: " +
                  kW.data() + (count == 1 ? " (" : " (most so ") + to_string(farthest->at) + ").",
      .span = {farthest->at, farthest->at},
      .slots = count,
      .grade = DataFinding::Grade::warning};
}

std::vector<DataFinding> SeriesDoubts::describe(std::string_view meter) const {
  std::vector<DataFinding> findings;
  std::vector<DayMean> days;
  for (const auto& [month, one] : months_) {
    for (std::size_t day = 0; day < one.days_kW.size(); ++day) {
      if (std::isnan(one.days_kW[day])) continue;
      days.push_back({month / std::chrono::day{static_cast<unsigned>(day) + 1}, one.days_kW[day]});
    }
    for (const SummedHour& hour : one.summed) {
      std::array<char, 32> ratio{};
      std::snprintf(ratio.data(), ratio.size(), "%.2g", hour.ratio);
      findings.push_back(
          {.meter = std::string{meter},
           .sentence = "The hour that the clock repeats stands once in the file, with " +
                       std::string{ratio.data()} +
                       " times the load of the hours beside it: probably both hours added up, and "
                       "no peak (" +
                       to_string(hour.span.begin) + ").",
           .span = hour.span,
           .slots = 0,
           .grade = DataFinding::Grade::warning});
    }
  }
  std::ranges::move(unit_changes(meter, days), std::back_inserter(findings));
  if (auto higher = higher_estimates(meter)) findings.push_back(std::move(*higher));
  return findings;
}

}  // namespace recald::metering
