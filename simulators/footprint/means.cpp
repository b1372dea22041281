#include "simulators/footprint/means.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "simulators/building/hidden_effect.hpp"

namespace recald::simulators {
namespace {

constexpr double kInterval_h = kInterval / std::chrono::duration<double, std::ratio<3600>>{1.0};
constexpr auto kIntervalsAnHour = static_cast<std::size_t>(std::chrono::hours{1} / kInterval);

template <class Visit>
void for_each_interval(const IntervalSeries& series, const metering::LocalCalendar& calendar,
                       Visit visit) {
  metering::Instant start = series.begin;
  for (const double mean : series.means) {
    visit(calendar.local_time(start), mean);
    start += kInterval;
  }
}

}  // namespace

bool DayGroup::contains(metering::Day day) const {
  if ((from && day < *from) || (to && day > *to)) return false;
  const bool in_summer = day.month() >= std::chrono::April && day.month() <= std::chrono::September;
  const unsigned weekday = std::chrono::weekday{std::chrono::sys_days{day}}.iso_encoding();
  return in_summer == (half_year == HalfYear::summer) &&
         (weekday >= 6) == (part_of_week == PartOfWeek::weekend);
}

std::optional<MeanDay> mean_day(const IntervalSeries& series, const DayGroup& group,
                                const metering::LocalCalendar& calendar) {
  MeanDay sum{};
  std::array<int, 24> count{};
  for_each_interval(series, calendar, [&](const metering::LocalTime& local, double mean) {
    if (!group.contains(local.date)) return;
    const auto hour = static_cast<std::size_t>(local.minute_of_day / 60);
    sum[hour] += mean;
    ++count[hour];
  });
  if (std::ranges::find(count, 0) != count.end()) return std::nullopt;
  for (std::size_t hour = 0; hour < sum.size(); ++hour) sum[hour] /= count[hour];
  return sum;
}

MonthlySum monthly_kWh(const IntervalSeries& series_kW, const metering::LocalCalendar& calendar) {
  MonthlySum sum_kWh{};
  for_each_interval(series_kW, calendar, [&](const metering::LocalTime& local, double power_kW) {
    sum_kWh[static_cast<unsigned>(local.date.month()) - 1] += power_kW * kInterval_h;
  });
  return sum_kWh;
}

std::vector<double> hourly_means(const IntervalSeries& series, metering::Day first, int days,
                                 const metering::LocalCalendar& calendar) {
  const metering::Day after{std::chrono::sys_days{first} + std::chrono::days{days}};
  const metering::Instant begin = calendar.day_span(first).begin;
  const metering::Instant end = calendar.day_span(after).begin;
  assert(begin >= series.begin && begin <= end);
  const auto skipped = static_cast<std::size_t>((begin - series.begin) / kInterval);
  const auto intervals = static_cast<std::size_t>((end - begin) / kInterval);
  assert(skipped + intervals <= series.means.size());
  std::vector<double> hours;
  for (std::size_t at = skipped; at < skipped + intervals; at += kIntervalsAnHour) {
    const auto hour = series.means.subspan(at, kIntervalsAnHour);
    hours.push_back(std::accumulate(hour.begin(), hour.end(), 0.0) /
                    static_cast<double>(kIntervalsAnHour));
  }
  return hours;
}

}  // namespace recald::simulators
