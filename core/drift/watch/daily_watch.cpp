#include "core/drift/watch/daily_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace recald::drift {
namespace {

/// Larger steps are seen by it as well, within days; a larger one would answer to a few odd days.
constexpr double kLargestShift = 1.0;
constexpr double kLevelAfterAnAlarm = 0.3;
constexpr std::size_t kDatedDays = 730;  // that a change is sought in
constexpr std::size_t kFewestDays = 5;   // of a month, to judge it
constexpr double kLagMax = 0.9;
constexpr double kMonthMax = 3.0;  // sd: a change must not pass for scatter of months

double standardised(const DailyReference& reference, const WatchedDay& day) {
  const auto expected = reference.expect(day);
  return (day.measured_kW - expected.mean_kW) / expected.sd_kW;
}

std::vector<double> all_standardised(const DailyReference& reference,
                                     const std::vector<WatchedDay>& days) {
  std::vector<double> values;
  for (const WatchedDay& day : days) values.push_back(standardised(reference, day));
  return values;
}

}  // namespace

DailyWatch::DailyWatch(std::vector<WatchedDay> days, int learning_months,
                       const DailyWatchOptions& options)
    : options_(options),
      days_(std::move(days)),
      detector_(1.0 / options.days_between_false_alarms, kLargestShift) {
  const auto first = measured([&](const WatchedDay& day) { return day.month < learning_months; });
  double sum = 0.0;
  for (const WatchedDay& day : first) sum += day.measured_kW;
  is_able_ = std::ssize(first) >= options.days_to_learn && sum > 0.0;
  if (!is_able_) return;
  scale_ = sum / static_cast<double>(first.size());
  learn(learning_months);
}

template <class Belongs>
std::vector<WatchedDay> DailyWatch::measured(Belongs belongs) const {
  std::vector<WatchedDay> chosen;
  std::ranges::copy_if(days_, std::back_inserter(chosen), [&](const WatchedDay& day) {
    return !std::isnan(day.measured_kW) && belongs(day);
  });
  return chosen;
}

std::vector<double> DailyWatch::whitened(const std::vector<double>& standardised) const {
  std::vector<double> white;
  for (std::size_t i = 0; i < standardised.size(); ++i) {
    const double value = i == 0 ? standardised[i]
                                : (standardised[i] - lag_one_ * standardised[i - 1]) /
                                      std::sqrt(1.0 - lag_one_ * lag_one_);
    white.push_back(std::clamp(value, -options_.surprise_max, options_.surprise_max));
  }
  return white;
}

/// Each learning month as if it were to come: told by the others.
void DailyWatch::learn(int learning_months) {
  std::vector<std::vector<double>> months;
  for (int month = 0; month < learning_months; ++month) {
    const auto others = measured(
        [&](const WatchedDay& day) { return day.month < learning_months && day.month != month; });
    const auto left_out = measured([&](const WatchedDay& day) { return day.month == month; });
    if (left_out.size() < kFewestDays) continue;
    months.push_back(all_standardised(DailyReference{others, scale_, before_}, left_out));
  }
  double products = 0.0;
  double squares = 0.0;
  for (const std::vector<double>& values : months) {
    for (std::size_t i = 1; i < values.size(); ++i) {
      const double before = std::clamp(values[i - 1], -4.0, 4.0);
      products += before * std::clamp(values[i], -4.0, 4.0);
      squares += before * before;
    }
  }
  lag_one_ = squares > 0.0 ? std::clamp(products / squares, 0.0, kLagMax) : 0.0;
  for (const std::vector<double>& values : months) take_month(whitened(values));
}

void DailyWatch::take_month(const std::vector<double>& white) {
  const double sum = std::accumulate(white.begin(), white.end(), 0.0);
  const double square = sum * sum / static_cast<double>(white.size());
  squares_ += std::min(square, kMonthMax * kMonthMax * month_factor() * month_factor());
  months_ += 1.0;
}

double DailyWatch::month_factor() const {
  const double prior = options_.month_variance_months;
  return std::sqrt((prior * options_.month_variance + squares_) / (prior + months_));
}

void DailyWatch::begin_at(metering::Day since, double level_sd) {
  const auto known = measured(
      [&](const WatchedDay& day) { return day.date < since && (!begun_ || day.date >= *begun_); });
  if (!known.empty()) {
    const double share = std::min(1.0, options_.days_carried / static_cast<double>(known.size()));
    before_ = DailyReference{known, scale_, before_}.after_a_change(share, level_sd);
  }
  begun_ = since;
  detector_ = EDetector{1.0 / options_.days_between_false_alarms, kLargestShift};
  seen_.clear();
}

/// Given that there was one change, by about a day's scatter, any day alike beforehand.
DailyWatch::ChangeDays DailyWatch::date_change() const {
  const std::size_t first = seen_.size() - std::min(seen_.size(), kDatedDays);
  std::vector<double> logs(seen_.size() - first);
  double sum = 0.0;
  for (std::size_t i = seen_.size(); i-- > first;) {
    sum += seen_[i].white;
    const double precision = 1.0 + static_cast<double>(seen_.size() - i);
    logs[i - first] = 0.5 * (sum * sum / precision - std::log(precision));
  }
  const auto likeliest = std::ranges::max_element(logs);
  double total = 0.0;
  for (const double one : logs) total += std::exp(one - *likeliest);
  ChangeDays since{first + static_cast<std::size_t>(likeliest - logs.begin()), first, first};
  double below = 0.0;
  for (std::size_t i = 0; i < logs.size() && below < 0.95 * total; ++i) {
    if (below < 0.05 * total) since.earliest = first + i;
    since.latest = first + i;
    below += std::exp(logs[i] - *likeliest);
  }
  return since;
}

DailyAlarm DailyWatch::alarm_of(int month) const {
  const ChangeDays since = date_change();
  double measured_kW = 0.0;
  double expected_kW = 0.0;
  for (std::size_t i = since.likeliest; i < seen_.size(); ++i) {
    measured_kW += seen_[i].measured_kW;
    expected_kW += seen_[i].expected_kW;
  }
  return {.raised = seen_.back().date,
          .month = month,
          .since = seen_[since.likeliest].date,
          .since_earliest = seen_[since.earliest].date,
          .since_latest = seen_[since.latest].date,
          .direction = detector_.likeliest_shift() > 0.0 ? 1 : -1,
          .evidence = std::exp(detector_.log_evidence()),
          .excess = measured_kW / expected_kW - 1.0};
}

std::optional<DailyAlarm> DailyWatch::evaluate(int month) {
  if (!is_able_) return std::nullopt;
  const auto days = measured([&](const WatchedDay& day) {
    return day.month == month && (!begun_ || day.date >= *begun_);
  });
  const auto known = measured(
      [&](const WatchedDay& day) { return day.month < month && (!begun_ || day.date >= *begun_); });
  if (days.size() < kFewestDays || (begun_ && std::ssize(known) < options_.days_to_learn_anew)) {
    return std::nullopt;
  }
  const DailyReference reference{known, scale_, before_};
  const auto white = whitened(all_standardised(reference, days));
  const double factor = month_factor();
  for (std::size_t i = 0; i < days.size(); ++i) {
    seen_.push_back(
        {days[i].date, days[i].measured_kW, reference.expect(days[i]).mean_kW, white[i] / factor});
    if (!detector_.observe(white[i] / factor)) continue;
    const DailyAlarm alarm = alarm_of(month);
    begin_at(alarm.since, kLevelAfterAnAlarm);
    return alarm;
  }
  take_month(white);
  return std::nullopt;
}

}  // namespace recald::drift
