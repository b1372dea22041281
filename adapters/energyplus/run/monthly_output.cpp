#include "adapters/energyplus/run/monthly_output.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <numeric>

#include "core/absent.hpp"
#include "core/statistics/expected_maximum.hpp"

namespace recald::energyplus {
namespace {

using metering::Instant;
using std::chrono::seconds;

std::size_t place_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

/// An output's energy at each step of the run, kWh.
std::vector<double> energy_of(const ModelOutput& output, std::span<const MeterOutput> meters,
                              const std::vector<std::string>& names) {
  std::vector<double> sum_kWh(meters.front().energy_kWh.size(), 0.0);
  for (const SignedMeter& part : output.meters) {
    const std::vector<double>& energy_kWh = meters[place_of(names, part.name)].energy_kWh;
    for (std::size_t i = 0; i < sum_kWh.size(); ++i) sum_kWh[i] += part.sign * energy_kWh[i];
  }
  return sum_kWh;
}

/// A run of a calendar year is in standard time. Where the clock is an hour ahead at New Year, in
/// the south, January's first hour is the run of the year before's, and is not missed.
constexpr seconds kSummerTime{3600};

/// Steps [first, last) of the run that lie in the span, or none where it is not there whole.
struct Steps {
  std::size_t first = 0;
  std::size_t last = 0;
};
Steps steps_in(const std::vector<Instant>& starts, const metering::TimeSpan& span, seconds step) {
  const bool lacks_an_hour = starts.front() - span.begin == kSummerTime;
  const Instant begin = lacks_an_hour ? starts.front() : span.begin;
  const auto first = std::ranges::lower_bound(starts, begin);
  const auto last = std::ranges::lower_bound(starts, span.end);
  const auto count = last - first;
  if (count == 0 || count * step != span.end - begin) return {};
  return {static_cast<std::size_t>(first - starts.begin()),
          static_cast<std::size_t>(last - starts.begin())};
}

/// The month's largest mean over a window, as a meter with noise would show it. A window that is no
/// multiple of the step has its share of the steps at its ends.
double peak_kW(std::span<const double> energy_kWh, seconds step, const ModelOutput& output,
               seconds window) {
  std::vector<double> total_kWh(energy_kWh.size() + 1, 0.0);
  std::partial_sum(energy_kWh.begin(), energy_kWh.end(), total_kWh.begin() + 1);
  const auto until = [&](seconds end) {
    const auto whole = static_cast<std::size_t>(end / step);
    const double part =
        static_cast<double>((end % step).count()) / static_cast<double>(step.count());
    return part == 0.0 ? total_kWh[whole]
                       : total_kWh[whole] + part * (total_kWh[whole + 1] - total_kWh[whole]);
  };
  const double hours = std::chrono::duration<double, std::ratio<3600>>{window}.count();
  const seconds length = step * static_cast<std::int64_t>(energy_kWh.size());
  std::vector<double> means_kW;
  for (seconds begin{0}; begin + window <= length; begin += window) {
    means_kW.push_back((until(begin + window) - until(begin)) / hours);
  }
  const double largest_kW = *std::ranges::max_element(means_kW);
  return expected_maximum(means_kW, output.interval_noise * std::max(largest_kW, 0.0));
}

/// (outputs * spans) output-major: energy in kWh, or the largest mean over the window in kW.
std::vector<double> span_figures(std::span<const MeterOutput> meters,
                                 std::span<const ModelOutput> outputs,
                                 std::span<const metering::TimeSpan> spans, seconds window) {
  const std::vector<std::string> names = meters_of(outputs);
  assert(meters.size() == names.size() && !meters.empty());
  const std::vector<Instant>& starts = meters.front().starts;
  std::vector<double> figures(outputs.size() * spans.size(), kAbsent);
  if (starts.size() < 2) return figures;
  const seconds step = starts[1] - starts[0];
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const std::vector<double> energy_kWh = energy_of(outputs[k], meters, names);
    for (std::size_t i = 0; i < spans.size(); ++i) {
      const Steps steps = steps_in(starts, spans[i], step);
      if (steps.first == steps.last) continue;
      const std::span in_span =
          std::span{energy_kWh}.subspan(steps.first, steps.last - steps.first);
      figures[k * spans.size() + i] = outputs[k].is_peak
                                          ? peak_kW(in_span, step, outputs[k], window)
                                          : std::accumulate(in_span.begin(), in_span.end(), 0.0);
    }
  }
  return figures;
}

}  // namespace

SignedMeter parse_signed_meter(std::string_view text) {
  const bool is_subtracted = text.starts_with('-');
  if (is_subtracted || text.starts_with('+')) text.remove_prefix(1);
  return {std::string{text}, is_subtracted ? -1.0 : 1.0};
}

std::vector<std::string> meters_of(std::span<const ModelOutput> outputs) {
  std::vector<std::string> names;
  for (const ModelOutput& output : outputs) {
    for (const SignedMeter& meter : output.meters) {
      if (std::ranges::find(names, meter.name) == names.end()) names.push_back(meter.name);
    }
  }
  return names;
}

std::vector<double> monthly_figures(std::span<const MeterOutput> meters,
                                    std::span<const ModelOutput> outputs,
                                    std::span<const metering::Month> months,
                                    const metering::LocalCalendar& calendar, seconds window) {
  std::vector<metering::TimeSpan> spans;
  for (const metering::Month month : months) spans.push_back(calendar.month_span(month));
  std::vector<double> figures = span_figures(meters, outputs, spans, window);
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (outputs[k].is_peak) continue;
    for (std::size_t i = 0; i < months.size(); ++i) {
      figures[k * months.size() + i] /= metering::days_in(months[i]);
    }
  }
  return figures;
}

std::vector<double> daily_figures(std::span<const MeterOutput> meters,
                                  std::span<const ModelOutput> outputs,
                                  std::span<const metering::Day> days,
                                  const metering::LocalCalendar& calendar, seconds window) {
  std::vector<metering::TimeSpan> spans;
  for (const metering::Day day : days) spans.push_back(calendar.day_span(day));
  return span_figures(meters, outputs, spans, window);
}

}  // namespace recald::energyplus
