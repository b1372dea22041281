#include "core/drift/watch/watch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace recald::drift {
namespace {

/// Two-sided CUSUM limits for k = 1/2 by the mean number of months between false alarms of one
/// output; between and beyond them linear in the logarithm. The middle one is tested.
double cusum_limit(double months) {
  constexpr double kMonths[] = {60.0, 240.0, 720.0};
  constexpr double kLimits[] = {3.02, 4.34, 5.45};
  const std::size_t segment = months < kMonths[1] ? 0 : 1;
  const double share = (std::log(months) - std::log(kMonths[segment])) /
                       (std::log(kMonths[segment + 1]) - std::log(kMonths[segment]));
  return kLimits[segment] + share * (kLimits[segment + 1] - kLimits[segment]);
}

}  // namespace

Watch::Watch(int outputs, const WatchOptions& options)
    : options_(options), outputs_(static_cast<std::size_t>(outputs), watched(outputs, options)) {
  assert(outputs > 0 && options.months_between_false_alarms > 1.0);
}

Watch::Watched Watch::watched(int outputs, const WatchOptions& options) {
  const double months = options.months_between_false_alarms * outputs;
  return {EDetector{1.0 / months}, Cusum{cusum_limit(months)}, ChangePoint{}, {}, {}};
}

void Watch::begin_anew() {
  std::ranges::fill(outputs_, watched(static_cast<int>(outputs_.size()), options_));
}

std::vector<Alarm> Watch::observe(int month, const std::vector<std::optional<double>>& surprises) {
  assert(surprises.size() == outputs_.size());
  std::vector<Alarm> alarms;
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    if (!surprises[k]) continue;
    Watched& watched = outputs_[k];
    assert(watched.months.empty() || month > watched.months.back());
    watched.surprises.push_back(*surprises[k]);
    watched.months.push_back(month);
    watched.change.observe(*surprises[k]);
    (void)watched.cusum.observe(*surprises[k]);
    if (!watched.detector.observe(*surprises[k])) continue;
    // A change that came `run` observations ago began with the first of them.
    const auto first_month = [&](std::size_t run) {
      const std::size_t count = watched.months.size();
      return watched.months[count - std::clamp<std::size_t>(run, 1, count)];
    };
    const auto since = watched.change.since();
    alarms.push_back({.month = month,
                      .output = static_cast<int>(k),
                      .direction = watched.detector.likeliest_shift() > 0.0 ? 1 : -1,
                      .evidence = std::exp(watched.detector.log_evidence()),
                      .since = first_month(since.likeliest),
                      .since_earliest = first_month(since.longest),
                      .since_latest = first_month(since.shortest),
                      .is_calibrated = is_calibrated(watched)});
  }
  return alarms;
}

/// Judged by the months before the change that is suspected: the change itself is no fault of the
/// forecasts.
bool Watch::is_calibrated(const Watched& watched) const {
  const auto since = watched.change.since();
  const std::size_t count = watched.surprises.size();
  const std::size_t before = count - std::min(since.longest, count);
  const auto check = check_calibration({watched.surprises.data(), before});
  return !check || check->pvalue >= options_.calibrated_pvalue_min;
}

WatchState Watch::state(int output) const {
  const Watched& watched = outputs_[static_cast<std::size_t>(output)];
  WatchState state{.log_evidence = watched.detector.log_evidence(),
                   .log_threshold = watched.detector.log_threshold(),
                   .cusum_upper = watched.cusum.upper(),
                   .cusum_lower = watched.cusum.lower(),
                   .change_within_year = watched.change.change_within(12),
                   .calibration = std::nullopt};
  if (const auto check = check_calibration(watched.surprises)) state.calibration = *check;
  return state;
}

}  // namespace recald::drift
