#include "core/weather/recorded_values.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string_view>
#include <vector>

namespace recald::weather {
namespace {

using std::chrono::seconds;

constexpr double kDaylight_W_m2 = 20.0;
constexpr std::ptrdiff_t kDaysOfOneCourse = 30;
constexpr seconds kDaylightNeeded{30 * 6 * 3600};
constexpr int kParts = 6;  // of a record, in which the air follows the sun
constexpr std::array<double, 5> kFollows_h{0.25, 0.5, 1.0, 2.0, 4.0};
/// The better answer leaves so much less of the variance unexplained.
constexpr double kClearlyBetter = 0.98;

/// Values on the grid of the record without the mean course of the day, by months or so.
std::vector<double> anomalies(const std::vector<double>& values, std::ptrdiff_t times_of_day) {
  std::vector<double> rest(values.size(), kAbsent);
  const std::ptrdiff_t block = kDaysOfOneCourse * times_of_day;
  for (std::ptrdiff_t begin = 0; begin < std::ssize(values); begin += block) {
    const std::ptrdiff_t end = std::min(begin + block, std::ssize(values));
    for (std::ptrdiff_t first = begin; first < std::min(begin + times_of_day, end); ++first) {
      double sum = 0.0;
      int known = 0;
      for (std::ptrdiff_t i = first; i < end; i += times_of_day) {
        const double value = values[static_cast<std::size_t>(i)];
        if (std::isnan(value)) continue;
        sum += value;
        ++known;
      }
      for (std::ptrdiff_t i = first; i < end && known > 0; i += times_of_day) {
        rest[static_cast<std::size_t>(i)] = values[static_cast<std::size_t>(i)] - sum / known;
      }
    }
  }
  return rest;
}

/// Changes of temperature from record to record, and where both are in daylight.
struct Changes {
  std::vector<double> change_K;  ///< Up to the record, without the daily course.
  std::vector<double> sun_W_m2;  ///< Likewise; 0 where unknown.
  std::vector<std::size_t> in_daylight;
};

Changes changes_of(const std::vector<double>& dry_bulb_C, const std::vector<double>& ghi_W_m2,
                   std::ptrdiff_t times_of_day) {
  Changes made;
  std::vector<double> change_K(dry_bulb_C.size(), kAbsent);
  for (std::size_t i = 1; i < change_K.size(); ++i) {
    change_K[i] = dry_bulb_C[i] - dry_bulb_C[i - 1];
  }
  made.change_K = anomalies(change_K, times_of_day);
  made.sun_W_m2 = anomalies(ghi_W_m2, times_of_day);
  for (double& sun_W_m2 : made.sun_W_m2) {
    if (std::isnan(sun_W_m2)) sun_W_m2 = 0.0;
  }
  for (std::size_t i = 1; i + 1 < change_K.size(); ++i) {
    const bool is_day = ghi_W_m2[i - 1] > kDaylight_W_m2 && ghi_W_m2[i] > kDaylight_W_m2 &&
                        ghi_W_m2[i + 1] > kDaylight_W_m2;
    if (is_day && !std::isnan(made.change_K[i])) made.in_daylight.push_back(i);
  }
  return made;
}

/// Air that follows the sun with a delay, as it is at the end of each record and on average.
struct Follower {
  std::vector<double> at_end;
  std::vector<double> mean;
};

Follower follow(const std::vector<double>& sun_W_m2, double step_h, double delay_h) {
  const double kept = std::exp(-step_h / (kParts * delay_h));
  Follower made;
  double now = 0.0;
  for (std::size_t i = 0; i < sun_W_m2.size(); ++i) {
    const double last_W_m2 = sun_W_m2[i == 0 ? 0 : i - 1];
    const double next_W_m2 = sun_W_m2[std::min(i + 1, sun_W_m2.size() - 1)];
    double sum = 0.0;
    for (int part = 0; part < kParts; ++part) {
      const double from_middle = (part + 0.5) / kParts - 0.5;
      const double here_W_m2 = sun_W_m2[i] + (next_W_m2 - last_W_m2) / 2.0 * from_middle;
      const double before = now;
      now = kept * now + (1.0 - kept) * here_W_m2;
      sum += (before + now) / 2.0;
    }
    made.at_end.push_back(now);
    made.mean.push_back(sum / kParts);
  }
  return made;
}

/// Share of the variance of the changes that those of a follower leave unexplained, 0…1.
/// @param later  1: a record shows what the follower was at the end of the record before.
double unexplained(const Changes& changes, const std::vector<double>& follower,
                   std::size_t later = 0) {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const std::size_t i : changes.in_daylight) {
    if (i < later + 1) continue;
    const double x = follower[i - later] - follower[i - later - 1];
    xx += x * x;
    xy += x * changes.change_K[i];
    yy += changes.change_K[i] * changes.change_K[i];
  }
  return xy > 0.0 && yy > 0.0 ? 1.0 - xy * xy / (xx * yy) : 1.0;
}

}  // namespace

std::string to_string(const ValuesTaken& taken) {
  constexpr std::array<std::string_view, 3> by{"declared", "inferred", "default"};
  return std::string{taken.values == RecordedValues::instant ? "instant" : "mean"} + " (" +
         std::string{by[static_cast<std::size_t>(taken.known_by)]} + ")";
}

std::optional<RecordedValues> values_by_the_sun(std::span<const WeatherRecord> records,
                                                seconds step, ValuesStand instant) {
  assert(instant != ValuesStand::over_the_record);
  if (records.empty() || metering::kDay % step != seconds{0}) return {};
  const auto count = (records.back().start - records.front().start) / step + 1;
  std::vector<double> dry_bulb_C(static_cast<std::size_t>(count), kAbsent);
  std::vector<double> ghi_W_m2 = dry_bulb_C;
  for (const WeatherRecord& record : records) {
    const seconds past = record.start - records.front().start;
    if (past < seconds{0} || past % step != seconds{0}) continue;
    const auto i = static_cast<std::size_t>(past / step);
    dry_bulb_C[i] = record.values.dry_bulb_C;
    ghi_W_m2[i] = record.values.ghi_W_m2;
  }
  const Changes changes = changes_of(dry_bulb_C, ghi_W_m2, metering::kDay / step);
  if (std::ssize(changes.in_daylight) * step < kDaylightNeeded) return {};
  double of_means = 1.0;
  double of_instants = 1.0;
  for (const double delay_h : kFollows_h) {
    const Follower air = follow(changes.sun_W_m2, metering::in_hours(step), delay_h);
    of_means = std::min(of_means, unexplained(changes, air.mean));
    const std::size_t later = instant == ValuesStand::at_its_start ? 1 : 0;
    of_instants = std::min(of_instants, unexplained(changes, air.at_end, later));
  }
  if (of_means < kClearlyBetter * of_instants) return RecordedValues::mean;
  if (of_instants < kClearlyBetter * of_means) return RecordedValues::instant;
  return {};
}

}  // namespace recald::weather
