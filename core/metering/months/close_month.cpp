#include "core/metering/months/close_month.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace recald::metering {
namespace {

using std::chrono::seconds;

seconds peak_window(const MonthSlots& month, const PeakRule& rule) {
  const seconds interval = month.grid->interval();
  const bool fits = rule.window >= interval && rule.window % interval == seconds{0} &&
                    rule.window <= kDay && kDay % rule.window == seconds{0};
  return fits ? rule.window : interval;
}

/// Whether slots [begin, begin + width) are measured and consecutive on the wall clock.
bool is_complete_block(const MonthSlots& month, int begin, int width) {
  for (int i = 0; i < width; ++i) {
    const int slot = begin + i;
    if (slot >= month.slots() || !month.is_ok(slot)) return false;
    if (month.grid->time_of_day(slot) != month.grid->time_of_day(begin) + i) return false;
  }
  return true;
}

double block_mean_kW(const MonthSlots& month, int begin, int width) {
  double sum_kW = 0.0;
  for (int slot = begin; slot < begin + width; ++slot) {
    sum_kW += month.measured_kW[static_cast<std::size_t>(slot)];
  }
  return sum_kW / width;
}

struct LongestGap {
  seconds length{0};
  Instant start{};
};

LongestGap longest_gap(const MonthSlots& month) {
  LongestGap longest;
  int begin = 0;
  for (int slot = 0; slot < month.slots(); ++slot) {
    if (month.has_energy(slot)) {
      begin = slot + 1;
      continue;
    }
    const seconds length = (slot + 1 - begin) * month.grid->interval();
    if (length > longest.length) longest = {length, month.grid->start(begin)};
  }
  return longest;
}

template <class... Values>
std::string text(const char* format, Values... values) {
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

/// " (971 suspect: zero_run)" if suspect slots contribute to the problem.
std::string suspects_in_words(const MonthlyFigure& figure) {
  const int suspect = figure.slots_by_validity[static_cast<std::size_t>(Validity::suspect)];
  if (suspect == 0) return {};
  return text(" (%d suspect: ", suspect) + to_string(figure.reasons) + ")";
}

std::string why_unusable(const MonthSlots& month, const MonthlyFigure& figure,
                         const ClosingOptions& options) {
  const bool any = std::any_of(month.measured_kW.begin(), month.measured_kW.end(),
                               [](double value_kW) { return !std::isnan(value_kW); });
  if (!any) return "no readings in this month";
  if (figure.coverage < options.coverage_min) {
    return text("only %.0f %% of the month's intervals are measured, %.0f %% are needed",
                std::floor(100.0 * figure.coverage), 100.0 * options.coverage_min) +
           suspects_in_words(figure);
  }
  if (figure.coverage == 1.0) return {};
  const LongestGap gap = longest_gap(month);
  if (gap.length > options.gap_max) {
    using FractionalDays = std::chrono::duration<double, std::ratio<86'400>>;
    return text("no measurement for %.1f days from ", FractionalDays{gap.length}.count()) +
           to_string(gap.start) +
           text(", %.0f days at most", FractionalDays{options.gap_max}.count()) +
           suspects_in_words(figure);
  }
  return {};
}

void count_slots(const MonthSlots& month, MonthlyFigure& figure) {
  for (std::size_t v = 0; v < figure.slots_by_validity.size(); ++v) {
    figure.slots_by_validity[v] = static_cast<int>(
        std::count(month.validity.begin(), month.validity.end(), static_cast<Validity>(v)));
  }
  for (const Reason reasons : month.reasons) figure.reasons |= reasons;
}

/// Whose values the source has estimated.
double estimated_slots(const MonthSlots& month) {
  int estimated = 0;
  for (int slot = 0; slot < month.slots(); ++slot) {
    const Reason reasons = month.reasons[static_cast<std::size_t>(slot)];
    if (month.has_energy(slot) && has(reasons, Reason::estimated)) ++estimated;
  }
  return estimated;
}

double energy_kWh(const MonthSlots& month) {
  double sum_kW = 0.0;
  for (const double value_kW : month.used_kW) sum_kW += value_kW;
  return sum_kW * month.grid->interval_h();
}

}  // namespace

std::optional<PeakDemand> find_peak(const MonthSlots& month, const PeakRule& rule) {
  const int width = static_cast<int>(peak_window(month, rule) / month.grid->interval());
  const bool whole = std::all_of(month.validity.begin(), month.validity.end(),
                                 [](Validity v) { return v == Validity::ok; });
  double highest_kW = -std::numeric_limits<double>::infinity();
  int highest_slot = -1;
  for (int slot = 0; slot < month.slots(); ++slot) {
    double mean_kW = month.measured_kW[static_cast<std::size_t>(slot)];
    if (width == 1) {
      if (!(mean_kW > highest_kW) || !month.is_ok(slot)) continue;
    } else {
      if (month.grid->time_of_day(slot) % width != 0) continue;
      if (!is_complete_block(month, slot, width)) continue;
      mean_kW = block_mean_kW(month, slot, width);
      if (!(mean_kW > highest_kW)) continue;
    }
    highest_kW = mean_kW;
    highest_slot = slot;
  }
  if (highest_slot < 0) return {};
  return PeakDemand{highest_kW, month.grid->start(highest_slot), !whole};
}

ClosedMonth close_month(std::uint32_t meter_index, MonthSlots received, const Meter& meter,
                        const ValidationContext& context, const ClosingOptions& options) {
  ClosedMonth closed{meter_index, {}, std::move(received)};
  MonthSlots& month = closed.slots;
  MonthlyFigure& figure = closed.figure;
  validate(month, meter, context, options.validation);
  figure.peak = find_peak(month, meter.peak);
  figure.peak_window = peak_window(month, meter.peak);
  const FillResult fill = fill_gaps(month, options.fill);

  const double days = month.grid->days();
  const double slots = month.slots();
  figure.month = month.grid->month();
  figure.slots = month.slots();
  count_slots(month, figure);
  const auto count = [&](Validity v) {
    return figure.slots_by_validity[static_cast<std::size_t>(v)];
  };
  figure.coverage = count(Validity::ok) / slots;
  figure.filled_share = (fill.filled + count(Validity::scaled)) / slots;
  figure.estimated_share = estimated_slots(month) / slots;
  figure.daily_average_kWh = energy_kWh(month) / days;  // NaN if nothing was measured
  figure.daily_average_variance_kWh2 = fill.variance_kWh2 / (days * days);
  figure.unusable_because = why_unusable(month, figure, options);
  figure.usable = figure.unusable_because.empty();
  return closed;
}

}  // namespace recald::metering
