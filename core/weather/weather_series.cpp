#include "core/weather/weather_series.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/absent.hpp"

namespace recald::weather {
namespace {

using metering::LocalCalendar;
using metering::Month;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr std::size_t kVariables = kWeatherVariables.size();
constexpr double kRadianPerDegree = std::numbers::pi / 180.0;
constexpr double kCalm_m_s = 0.1;  // a direction seen in a calm still counts a little

bool is_direction(const WeatherVariable& variable) {
  return variable.member == &WeatherHour::wind_dir_deg;
}

Instant full_hour_before(Instant t) { return std::chrono::floor<hours>(t); }

/// A weighted mean; directions are averaged as vectors.
class Mean {
 public:
  void add(double value, double weight) {
    sum_ += weight * value;
    weight_ += weight;
  }
  void add_direction(double deg, double weight, double vector_weight) {
    east_ += weight * vector_weight * std::sin(deg * kRadianPerDegree);
    north_ += weight * vector_weight * std::cos(deg * kRadianPerDegree);
    weight_ += weight;
  }
  [[nodiscard]] double weight() const { return weight_; }
  [[nodiscard]] double value(bool direction) const {
    if (weight_ <= 0.0) return kAbsent;
    if (!direction) return sum_ / weight_;
    if (std::hypot(east_, north_) < 1e-9 * weight_) return kAbsent;  // winds that cancel
    const double deg = std::atan2(east_, north_) / kRadianPerDegree;
    return deg < 0.0 ? deg + 360.0 : deg;
  }

 private:
  double sum_ = 0.0;
  double weight_ = 0.0;
  double east_ = 0.0;
  double north_ = 0.0;
};

using HourMeans = std::array<Mean, kVariables>;

bool is_irradiance(const WeatherVariable& variable) {
  return variable.member == &WeatherHour::ghi_W_m2 || variable.member == &WeatherHour::dni_W_m2 ||
         variable.member == &WeatherHour::dhi_W_m2;
}

/// What of a record is added: all, what is a mean in any case, or what may be an instant.
enum class Part : std::uint8_t { all, irradiance, air };

void add_to(HourMeans& means, const WeatherHour& values, double weight, Part part = Part::all) {
  for (std::size_t v = 0; v < kVariables; ++v) {
    if (part != Part::all && is_irradiance(kWeatherVariables[v]) != (part == Part::irradiance)) {
      continue;
    }
    const double value = values.*kWeatherVariables[v].member;
    if (!std::isfinite(value)) continue;
    if (is_direction(kWeatherVariables[v])) {
      const double speed_m_s = values.wind_speed_m_s;
      means[v].add_direction(value, weight,
                             std::isfinite(speed_m_s) ? std::max(speed_m_s, kCalm_m_s) : 1.0);
    } else {
      means[v].add(value, weight);
    }
  }
}

/// `values`, as far as `other` has them too, or as far as it lacks them.
WeatherHour only_with(const WeatherHour& values, const WeatherHour& other, bool other_has) {
  WeatherHour kept = values;
  for (const WeatherVariable& variable : kWeatherVariables) {
    if (std::isfinite(other.*variable.member) != other_has) kept.*variable.member = kAbsent;
  }
  return kept;
}

/// Adds part of a record whose values are instants. @param share  How far the middle of that part
/// lies on the way from this record's instant to the neighbour's.
void add_instants(HourMeans& means, const WeatherHour& own, const WeatherHour* neighbour,
                  double share, double weight) {
  add_to(means, own, weight, Part::irradiance);
  if (neighbour == nullptr) return add_to(means, own, weight, Part::air);
  add_to(means, only_with(own, *neighbour, true), weight * (1.0 - share), Part::air);
  add_to(means, only_with(*neighbour, own, true), weight * share, Part::air);
  add_to(means, only_with(own, *neighbour, false), weight, Part::air);
}

WeatherHour to_hour(const HourMeans& means) {
  constexpr double covered_min = 0.5 - 1e-9;
  WeatherHour hour;
  for (std::size_t v = 0; v < kVariables; ++v) {
    if (means[v].weight() < covered_min) continue;
    hour.*kWeatherVariables[v].member = means[v].value(is_direction(kWeatherVariables[v]));
  }
  return hour;
}

std::vector<WeatherRecord> in_order_without_repeats(std::span<const WeatherRecord> records) {
  std::vector<WeatherRecord> sorted{records.begin(), records.end()};
  std::stable_sort(
      sorted.begin(), sorted.end(),
      [](const WeatherRecord& a, const WeatherRecord& b) { return a.start < b.start; });
  const auto repeated = std::unique(
      sorted.begin(), sorted.end(),
      [](const WeatherRecord& a, const WeatherRecord& b) { return a.start == b.start; });
  sorted.erase(repeated, sorted.end());
  return sorted;
}

/// The shorter way round from one direction to another.
double direction_between(double from_deg, double to_deg, double share) {
  const double turn = std::remainder(to_deg - from_deg, 360.0);
  return std::fmod(from_deg + share * turn + 360.0, 360.0);
}

/// What happened to one variable at one hour.
enum class Origin : std::uint8_t { absent, measured, interpolated, typical };

/// Fills one variable of a series whose months are whole.
class VariableFiller {
 public:
  VariableFiller(WeatherSeries& series, std::size_t variable, const std::vector<int>& month_of_hour,
                 const std::vector<int>& local_hour)
      : series_{series},
        member_{kWeatherVariables[variable].member},
        direction_{is_direction(kWeatherVariables[variable])},
        month_of_hour_{month_of_hour},
        local_hour_{local_hour},
        origin_(series.hours.size(), Origin::absent) {
    for (std::size_t i = 0; i < origin_.size(); ++i) {
      if (std::isfinite(value(i))) origin_[i] = Origin::measured;
    }
  }

  std::vector<Origin> run(std::size_t interpolated_hours_max, int months) {
    learn_typical_hours(months);
    std::size_t i = 0;
    while (i < origin_.size()) {
      std::size_t end = i;
      while (end < origin_.size() && origin_[end] == Origin::absent) ++end;
      if (end > i) fill(i, end, interpolated_hours_max);
      i = end + 1;
    }
    return std::move(origin_);
  }

 private:
  double& value(std::size_t i) { return series_.hours[i].*member_; }

  void learn_typical_hours(int months) {
    typical_.resize(static_cast<std::size_t>(months) * 24);
    for (std::size_t i = 0; i < origin_.size(); ++i) {
      if (origin_[i] != Origin::measured) continue;
      Mean& mean = typical_[cell(i)];
      if (direction_) {
        mean.add_direction(value(i), 1.0, 1.0);
      } else {
        mean.add(value(i), 1.0);
      }
    }
  }

  [[nodiscard]] std::size_t cell(std::size_t i) const {
    return static_cast<std::size_t>(month_of_hour_[i] * 24 + local_hour_[i]);
  }

  void fill(std::size_t begin, std::size_t end, std::size_t interpolated_hours_max) {
    const bool bridged = begin > 0 && end < origin_.size() && end - begin <= interpolated_hours_max;
    for (std::size_t i = begin; i < end; ++i) {
      if (bridged) {
        const double share =
            static_cast<double>(i - begin + 1) / static_cast<double>(end - begin + 1);
        value(i) = between(value(begin - 1), value(end), share);
        origin_[i] = Origin::interpolated;
      } else {
        value(i) = typical_[cell(i)].value(direction_);
        if (std::isfinite(value(i))) origin_[i] = Origin::typical;
      }
    }
  }

  [[nodiscard]] double between(double from, double to, double share) const {
    return direction_ ? direction_between(from, to, share) : from + share * (to - from);
  }

  WeatherSeries& series_;
  double WeatherHour::*member_;
  bool direction_;
  const std::vector<int>& month_of_hour_;
  const std::vector<int>& local_hour_;
  std::vector<Origin> origin_;
  std::vector<Mean> typical_;
};

/// The series over whole local months; hours that the records lack are absent.
WeatherSeries over_whole_months(const WeatherSeries& series, const LocalCalendar& calendar) {
  const Month first = calendar.month_of(series.begin);
  const Month last = calendar.month_of(series.end() - seconds{1});
  const Instant begin = full_hour_before(calendar.month_span(first).begin + minutes{30});
  const Instant end = full_hour_before(calendar.month_span(last).end + minutes{30});
  WeatherSeries whole;
  whole.begin = std::min(begin, series.begin);
  whole.hours.resize(
      static_cast<std::size_t>((std::max(end, series.end()) - whole.begin) / hours{1}));
  const auto offset = (series.begin - whole.begin) / hours{1};
  std::copy(series.hours.begin(), series.hours.end(), whole.hours.begin() + offset);
  return whole;
}

void count(std::vector<WeatherCoverage>& coverage, std::size_t variable,
           const std::vector<Origin>& origin, const std::vector<int>& month_of_hour) {
  std::vector<double> hours_in_month(coverage.size(), 0.0);
  for (const int month : month_of_hour) hours_in_month[static_cast<std::size_t>(month)] += 1.0;
  for (std::size_t i = 0; i < origin.size(); ++i) {
    const auto m = static_cast<std::size_t>(month_of_hour[i]);
    const double share = 1.0 / hours_in_month[m];
    if (origin[i] == Origin::measured) coverage[m].measured[variable] += share;
    if (origin[i] == Origin::interpolated) coverage[m].interpolated[variable] += share;
    if (origin[i] == Origin::typical) coverage[m].typical[variable] += share;
  }
}

/// The instant at the other end of a record; null where the file has none there.
const WeatherHour* neighbour_of(std::span<const WeatherRecord> records, std::size_t i, seconds step,
                                ValuesStand stand) {
  if (stand == ValuesStand::over_the_record) return nullptr;
  const bool before = stand == ValuesStand::at_its_end;
  if (before ? i == 0 : i + 1 == records.size()) return nullptr;
  const WeatherRecord& other = records[before ? i - 1 : i + 1];
  const seconds apart = before ? records[i].start - other.start : other.start - records[i].start;
  return apart == step ? &other.values : nullptr;
}

}  // namespace

const WeatherHour* WeatherSeries::find(Instant t) const {
  if (t < begin || t >= end()) return nullptr;
  return &hours[static_cast<std::size_t>((t - begin) / std::chrono::hours{1})];
}

Result<WeatherSeries> to_hourly(std::span<const WeatherRecord> records, seconds step,
                                ValuesStand stand) {
  if (records.empty()) return failure(ErrorCode::not_enough_data, "no weather records");
  assert(step > seconds{0});
  std::vector<WeatherRecord> sorted;  // years of records are large: copied only where they must be
  const auto is_late = [](const auto& a, const auto& b) { return b.start <= a.start; };
  if (std::ranges::adjacent_find(records, is_late) != records.end()) {
    sorted = in_order_without_repeats(records);
    records = sorted;
  }
  const seconds length = std::min<seconds>(step, hours{1});
  WeatherSeries series;
  series.begin = full_hour_before(records.front().start);
  const Instant last = full_hour_before(records.back().start + length - seconds{1});
  series.hours.reserve(static_cast<std::size_t>((last - series.begin) / hours{1}) + 1);
  // A record lies in one hour or in two that follow each other, and none comes back to one before:
  // years of sums would be larger than the records themselves.
  Instant open_hour = series.begin;
  std::array<HourMeans, 2> open{};
  const auto close_until = [&](Instant hour) {
    for (; open_hour < hour; open_hour += hours{1}) {
      series.hours.push_back(to_hour(open[0]));
      open[0] = std::exchange(open[1], {});
    }
  };
  for (std::size_t i = 0; i < records.size(); ++i) {
    const WeatherRecord& record = records[i];
    const WeatherHour* neighbour = neighbour_of(records, i, step, stand);
    const Instant end = record.start + length;
    close_until(full_hour_before(record.start));
    for (Instant hour = full_hour_before(record.start); hour < end; hour += hours{1}) {
      const Instant from = std::max(hour, record.start);
      const seconds overlap = std::min<Instant>(hour + hours{1}, end) - from;
      HourMeans& mean = open[hour == open_hour ? 0 : 1];
      const double weight = metering::in_hours(overlap);
      if (stand == ValuesStand::over_the_record) {
        add_to(mean, record.values, weight);
        continue;
      }
      const double past = metering::in_hours(from - record.start) + weight / 2.0;
      const double share = past / metering::in_hours(step);
      add_instants(mean, record.values, neighbour,
                   stand == ValuesStand::at_its_end ? 1.0 - share : share, weight);
    }
  }
  close_until(last + hours{1});
  return series;
}

WeatherGrade grade_of(double known_share) {
  constexpr double kLeastShare = 0.5;
  constexpr double kGoodShare = 0.9;
  if (known_share < kLeastShare) return WeatherGrade::unknown;
  return known_share < kGoodShare ? WeatherGrade::patchy : WeatherGrade::good;
}

FilledWeather fill_gaps(const WeatherSeries& series, const LocalCalendar& calendar,
                        seconds interpolate_max) {
  assert(!series.hours.empty());
  FilledWeather filled;
  filled.series = over_whole_months(series, calendar);

  std::vector<int> month_of_hour;
  std::vector<int> local_hour;
  const Month first = calendar.month_of(filled.series.begin + minutes{30});
  for (std::size_t i = 0; i < filled.series.hours.size(); ++i) {
    // An hour belongs where its middle lies: zones at half hours cut their months inside one.
    const Instant middle = filled.series.begin + hours{i} + minutes{30};
    const Month month = calendar.month_of(middle);
    month_of_hour.push_back(metering::months_between(first, month));
    local_hour.push_back(calendar.local_time(middle).minute_of_day / 60);
    if (filled.coverage.empty() || filled.coverage.back().month != month) {
      filled.coverage.push_back({month, {}, {}, {}});
    }
  }
  const int months = static_cast<int>(filled.coverage.size());
  const auto interpolated_hours_max = static_cast<std::size_t>(interpolate_max / hours{1});
  for (std::size_t v = 0; v < kVariables; ++v) {
    VariableFiller filler{filled.series, v, month_of_hour, local_hour};
    count(filled.coverage, v, filler.run(interpolated_hours_max, months), month_of_hour);
  }
  return filled;
}

WeatherSeries continued(const WeatherSeries& series, Instant from, Instant known_until,
                        Instant until) {
  constexpr std::size_t kWeek = 7 * 24;
  const Instant begin =
      std::max<Instant>(series.begin, std::chrono::floor<std::chrono::hours>(from));
  const Instant end =
      std::min<Instant>(series.end(), std::chrono::ceil<std::chrono::hours>(known_until));
  WeatherSeries longer{.begin = begin, .hours = {}};
  if (end <= begin) return longer;
  const auto first = series.hours.begin() + (begin - series.begin) / std::chrono::hours{1};
  longer.hours.assign(first, first + (end - begin) / std::chrono::hours{1});
  if (longer.hours.size() < kWeek) return longer;
  while (longer.end() < until) longer.hours.push_back(longer.hours[longer.hours.size() - kWeek]);
  return longer;
}

}  // namespace recald::weather
