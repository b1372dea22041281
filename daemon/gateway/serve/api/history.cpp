#include "daemon/gateway/serve/api/history.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/absent.hpp"

namespace recald::daemon {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::seconds;

constexpr std::array<seconds, 5> kSteps{hours{1}, hours{6}, days{1}, days{7}, days{28}};
constexpr seconds kLongStep = days{364};  // And whole numbers of it.

struct Sum {
  double least_kW = kAbsent;
  double most_kW = kAbsent;
  double sum_kW = 0.0;
  int valid = 0;

  void add(double kW) {
    least_kW = valid > 0 ? std::min(least_kW, kW) : kW;
    most_kW = valid > 0 ? std::max(most_kW, kW) : kW;
    sum_kW += kW;
    ++valid;
  }
};

}  // namespace

seconds history_step(const metering::TimeSpan& span, metering::Instant origin, seconds interval,
                     int points_max) {
  const auto fits = [&](seconds step) {
    const metering::Instant begin = origin + (span.begin - origin) / step * step;
    return (span.end - begin + step - seconds{1}) / step <= points_max;
  };
  if (fits(interval)) return interval;
  const auto step = std::ranges::find_if(
      kSteps, [&](seconds one) { return one % interval == seconds{0} && fits(one); });
  if (step != kSteps.end()) return *step;
  seconds longest = kLongStep;
  while (!fits(longest)) longest += kLongStep;
  return longest;
}

Result<History> read_history(IntervalStore& store, std::uint32_t meter, seconds interval,
                             const metering::TimeSpan& span, int points_max) {
  const auto extent = TRY(store.interval_extent(meter));
  if (!extent) return History{interval, {}};
  const metering::TimeSpan there{extent->begin, extent->end + interval};
  metering::TimeSpan asked{std::max(span.begin, there.begin), std::min(span.end, there.end)};
  History history{history_step(asked, span.begin, interval, points_max), {}};
  if (asked.end <= asked.begin) return history;
  const seconds step = history.step;
  // In whole steps from where the span begins, so that a day of a chart is a day.
  asked.begin = span.begin + (asked.begin - span.begin) / step * step;
  std::vector<Sum> sums(
      static_cast<std::size_t>((asked.end - asked.begin + step - seconds{1}) / step));
  TRY(store.for_each_interval(meter, asked, [&](const StoredInterval& one) {
    if (one.reading.validity != metering::Validity::ok || !std::isfinite(one.reading.mean_kW)) {
      return;
    }
    sums[static_cast<std::size_t>((one.reading.start - asked.begin) / step)].add(
        one.reading.mean_kW);
  }));
  const double expected = static_cast<double>(step.count()) / static_cast<double>(interval.count());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Sum& sum = sums[i];
    history.points.push_back({asked.begin + step * static_cast<std::int64_t>(i), sum.least_kW,
                              sum.valid > 0 ? sum.sum_kW / sum.valid : kAbsent, sum.most_kW,
                              std::min(sum.valid / expected, 1.0)});
  }
  return history;
}

}  // namespace recald::daemon
