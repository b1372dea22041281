#include "core/drift/watch/excess.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace recald::drift {
namespace {

constexpr std::chrono::days kSameChangeWithin{400};
constexpr std::ptrdiff_t kYearOfDays = 365;
constexpr double kHoursADay = 24.0;
/// As the daily watch learns anew after an alarm.
constexpr double kCarriedDays = 60.0;
constexpr double kFactorSd = 0.3;

/// Notices of one change.
struct OneChange {
  metering::Day since;
  metering::Day noticed;  ///< Last.
  int direction;
};

std::vector<WatchedDay> measured_between(std::span<const WatchedDay> days, metering::Day from,
                                         metering::Day to) {
  std::vector<WatchedDay> chosen;
  std::ranges::copy_if(days, std::back_inserter(chosen), [&](const WatchedDay& day) {
    return from <= day.date && day.date < to && !std::isnan(day.measured_kW);
  });
  return chosen;
}

double mean_kW(const std::vector<WatchedDay>& days) {
  double sum = 0.0;
  for (const WatchedDay& day : days) sum += day.measured_kW;
  return days.empty() ? 0.0 : sum / static_cast<double>(days.size());
}

/// (measured - expected) of the days from `from` to before `to`.
double added_kWh(std::span<const WatchedDay> days, const DailyReference& before, metering::Day from,
                 metering::Day to) {
  double expected_kW = 0.0;
  double measured_kW = 0.0;
  double unmeasured_kW = 0.0;
  for (const WatchedDay& day : days) {
    if (day.date < from || day.date >= to) continue;
    const double level = before.expect(day).mean_kW;
    if (std::isnan(day.measured_kW)) {
      unmeasured_kW += level;
      continue;
    }
    expected_kW += level;
    measured_kW += day.measured_kW;
  }
  const double excess_kW = measured_kW - expected_kW;
  const double share = expected_kW > 0.0 ? unmeasured_kW / expected_kW : 0.0;
  return kHoursADay * excess_kW * (1.0 + share);
}

/// (measured - expected) / expected.
double relative(std::span<const WatchedDay> days, const DailyReference& reference) {
  double measured_kW = 0.0;
  double expected_kW = 0.0;
  for (const WatchedDay& day : days) {
    measured_kW += day.measured_kW;
    expected_kW += reference.expect(day).mean_kW;
  }
  return measured_kW / expected_kW - 1.0;
}

/// What a reference learns from: days from one on, and what was known before them.
struct Baseline {
  metering::Day from;
  Coefficients known;
};

/// Whether a change is one against what the meter did before an earlier notice: that notice was
/// none, or what it told of has gone. Then the days before this one are nearer to it than those
/// since.
bool holds_again(const DailyReference& origin, std::span<const WatchedDay> before,
                 std::span<const WatchedDay> since) {
  constexpr std::size_t kSeason = 90;
  const auto lately = before.last(std::min(kSeason, before.size()));
  return std::abs(relative(lately, origin)) < 0.5 * std::abs(relative(since, origin));
}

/// What is added to the last 365 days, whichever of them came before the change.
std::optional<double> added_a_year_kWh(std::span<const WatchedDay> days,
                                       const DailyReference& before, const DailyReference& since) {
  if (std::ssize(days) < kYearOfDays) return std::nullopt;
  double added_kW = 0.0;
  for (const WatchedDay& day : days.last(kYearOfDays)) {
    added_kW += since.expect(day).mean_kW - before.expect(day).mean_kW;
  }
  return kHoursADay * added_kW;
}

/// Which change each notice is of, and the changes in order of time.
struct Grouped {
  std::vector<OneChange> changes;
  std::vector<std::size_t> of_notice;
};

Grouped group(std::span<const NoticedChange> notices) {
  Grouped grouped;
  for (const NoticedChange& notice : notices) {
    const bool goes_on =
        !grouped.changes.empty() && grouped.changes.back().direction == notice.direction &&
        std::chrono::sys_days{notice.since} <=
            std::chrono::sys_days{grouped.changes.back().noticed} + kSameChangeWithin;
    if (goes_on) {
      grouped.changes.back().noticed = notice.since;
      grouped.changes.back().since = std::min(grouped.changes.back().since, notice.since);
    } else {
      grouped.changes.push_back({notice.since, notice.since, notice.direction});
    }
    grouped.of_notice.push_back(grouped.changes.size() - 1);
  }
  return grouped;
}

}  // namespace

std::vector<std::optional<Excess>> excesses_of(std::span<const WatchedDay> days,
                                               std::span<const NoticedChange> notices) {
  if (days.empty()) return std::vector<std::optional<Excess>>(notices.size());
  const metering::Day day_after{std::chrono::sys_days{days.back().date} + std::chrono::days{1}};
  const double scale_kW = mean_kW(measured_between(days, days.front().date, day_after));
  Baseline now{days.front().date, DailyReference::vague()};
  Baseline before_last = now;
  std::optional<DailyReference> last;
  const Grouped grouped = group(notices);
  std::vector<std::optional<Excess>> of_changes;
  for (std::size_t i = 0; i < grouped.changes.size(); ++i) {
    const metering::Day since = grouped.changes[i].since;
    const bool is_last = i + 1 == grouped.changes.size();
    const metering::Day end = is_last ? day_after : grouped.changes[i + 1].since;
    auto days_before = measured_between(days, now.from, since);
    const auto days_since = measured_between(days, since, end);
    if (scale_kW <= 0.0 || days_before.empty() || days_since.empty()) {
      of_changes.emplace_back();
      continue;
    }
    if (last && holds_again(*last, days_before, days_since)) {
      now = before_last;
      days_before = measured_between(days, now.from, since);
    }
    const DailyReference before{days_before, scale_kW, now.known};
    last = before;
    before_last = now;
    const double carried = kCarriedDays / static_cast<double>(days_before.size());
    now = {since, before.after_a_change(std::min(1.0, carried), kFactorSd)};
    const DailyReference after{days_since, scale_kW, now.known};
    of_changes.push_back(
        Excess{.since = since,
               .until = days_since.back().date,
               .has_ended = !is_last,
               .so_far_kWh = added_kWh(days, before, since, end),
               .year_kWh = is_last ? added_a_year_kWh(days, before, after) : std::nullopt});
  }
  std::vector<std::optional<Excess>> of_notices;
  for (const std::size_t change : grouped.of_notice) of_notices.push_back(of_changes[change]);
  return of_notices;
}

}  // namespace recald::drift
