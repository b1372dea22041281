#include "adapters/energyplus/monthly_output.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "core/absent.hpp"

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

/// Steps [first, last) of the run that lie in the month, or none where it is not there whole.
struct Steps {
  std::size_t first = 0;
  std::size_t last = 0;
};
Steps steps_in(const std::vector<Instant>& starts, const metering::TimeSpan& span, seconds step) {
  const auto first = std::ranges::lower_bound(starts, span.begin);
  const auto last = std::ranges::lower_bound(starts, span.end);
  const auto count = last - first;
  if (count == 0 || count * step != span.length()) return {};
  return {static_cast<std::size_t>(first - starts.begin()),
          static_cast<std::size_t>(last - starts.begin())};
}

double peak_kW(std::span<const double> energy_kWh, std::size_t per_window, seconds window) {
  const double hours = std::chrono::duration<double, std::ratio<3600>>{window}.count();
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + per_window <= energy_kWh.size(); i += per_window) {
    double sum_kWh = 0.0;
    for (std::size_t k = i; k < i + per_window; ++k) sum_kWh += energy_kWh[k];
    highest = std::max(highest, sum_kWh / hours);
  }
  return highest;
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
  const std::vector<std::string> names = meters_of(outputs);
  assert(meters.size() == names.size() && !meters.empty());
  const std::vector<Instant>& starts = meters.front().starts;
  std::vector<double> figures(outputs.size() * months.size(), kAbsent);
  if (starts.size() < 2) return figures;
  const seconds step = starts[1] - starts[0];
  const auto per_window = static_cast<std::size_t>(std::max<std::int64_t>(window / step, 1));
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const std::vector<double> energy_kWh = energy_of(outputs[k], meters, names);
    for (std::size_t i = 0; i < months.size(); ++i) {
      const Steps steps = steps_in(starts, calendar.month_span(months[i]), step);
      if (steps.first == steps.last) continue;
      const std::span in_month =
          std::span{energy_kWh}.subspan(steps.first, steps.last - steps.first);
      double sum_kWh = 0.0;
      for (const double energy : in_month) sum_kWh += energy;
      figures[k * months.size() + i] = outputs[k].is_peak ? peak_kW(in_month, per_window, window)
                                                          : sum_kWh / metering::days_in(months[i]);
    }
  }
  return figures;
}

}  // namespace recald::energyplus
