#include "core/weather/daily_inputs.hpp"

#include <algorithm>
#include <cmath>

#include "core/weather/psychrometrics.hpp"

namespace recald::weather {
namespace {

using metering::Day;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::sys_days;

constexpr double kMemory_days = 3.0;
constexpr int kDaysBack = 12;  // exp(-12 / 3) = 2 %: what lies before no longer counts
constexpr double kStandardPressure_Pa = 101'325.0;
constexpr int kHoursMax = 25;  // of a day on which the clock is set back

double above(double value, double threshold) { return std::max(value - threshold, 0.0); }
double below(double value, double threshold) { return std::max(threshold - value, 0.0); }

/// A local day's hours. On the two days on which the clock is set, hours are counted from midnight.
struct DayHours {
  using Hours = std::array<double, kHoursMax>;
  int count = 0;
  Hours dry_bulb_C;
  Hours humidity_g_kg;
  double sun_mean_W_m2 = 0.0;
  double sun_max_W_m2 = 0.0;
  double wind_mean_m_s = 0.0;

  /// Mean of f(value) over hours [first, last).
  template <class F>
  [[nodiscard]] double mean(const Hours& values, int first, int last, F f) const {
    last = std::min(last, count);
    double sum = 0.0;
    for (int h = first; h < last; ++h) sum += f(values[static_cast<std::size_t>(h)]);
    return sum / (last - first);
  }
  [[nodiscard]] double mean(const Hours& values) const {
    return mean(values, 0, count, [](double value) { return value; });
  }
  [[nodiscard]] double max(const Hours& values) const {
    return *std::max_element(values.begin(), values.begin() + count);
  }
};

/// A day without all its hours has a count of 0.
DayHours hours_of(const WeatherSeries& weather, const metering::TimeSpan& span) {
  DayHours day;
  const double n = std::max(metering::in_hours(span.length()), 1.0);
  for (Instant t = std::chrono::ceil<hours>(span.begin); t < span.end; t += hours{1}) {
    const WeatherHour* hour = weather.find(t);
    if (hour == nullptr || day.count == kHoursMax) return {};
    const double pressure_Pa =
        std::isfinite(hour->pressure_Pa) ? hour->pressure_Pa : kStandardPressure_Pa;
    const auto h = static_cast<std::size_t>(day.count++);
    day.dry_bulb_C[h] = hour->dry_bulb_C;
    day.humidity_g_kg[h] =
        1000.0 * humidity_ratio(hour->dry_bulb_C,
                                std::clamp(hour->rel_humidity_pct / 100.0, 0.0, 1.0), pressure_Pa);
    day.sun_mean_W_m2 += hour->ghi_W_m2 / n;
    day.sun_max_W_m2 = std::max(day.sun_max_W_m2, hour->ghi_W_m2);
    day.wind_mean_m_s += hour->wind_speed_m_s / n;
    const double all =
        day.dry_bulb_C[h] + day.humidity_g_kg[h] + day.sun_mean_W_m2 + day.wind_mean_m_s;
    if (!std::isfinite(all)) return {};
  }
  // A day of a few hours only occurs where a zone has skipped a date.
  return day.count < 20 ? DayHours{} : day;
}

struct DayMean {
  bool is_known = false;
  double dry_bulb_C = 0.0;
  double sun_W_m2 = 0.0;
};

/// The hours and the past of a run of days, each looked up once.
class Past {
 public:
  Past(const WeatherSeries& weather, const metering::LocalCalendar& calendar, sys_days first,
       sys_days last)
      : first_{first} {
    for (sys_days day = first; day <= last; day += days{1}) {
      hours_.push_back(hours_of(weather, calendar.day_span(Day{day})));
      const DayHours& of_day = hours_.back();
      means_.push_back(of_day.count == 0
                           ? DayMean{}
                           : DayMean{true, of_day.mean(of_day.dry_bulb_C), of_day.sun_mean_W_m2});
    }
  }

  [[nodiscard]] const DayHours& hours(sys_days day) const { return hours_[at(day)]; }
  /// The day before; where it is not known, the day itself.
  [[nodiscard]] const DayMean& yesterday(sys_days day) const {
    const DayMean& before = means_[at(day) - 1];
    return before.is_known ? before : means_[at(day)];
  }
  /// Fading mean of the days before: weight exp(-k / 3 days) for k days ago, over the days known.
  [[nodiscard]] DayMean memory(sys_days day) const {
    DayMean sum;
    double weights = 0.0;
    for (std::size_t k = 1; k <= kDaysBack; ++k) {
      const DayMean& before = means_[at(day) - k];
      if (!before.is_known) continue;
      const double weight = std::exp(-static_cast<double>(k) / kMemory_days);
      sum.dry_bulb_C += weight * before.dry_bulb_C;
      sum.sun_W_m2 += weight * before.sun_W_m2;
      weights += weight;
    }
    if (weights == 0.0) return means_[at(day)];
    return {true, sum.dry_bulb_C / weights, sum.sun_W_m2 / weights};
  }

 private:
  [[nodiscard]] std::size_t at(sys_days day) const {
    return static_cast<std::size_t>((day - first_).count());
  }

  sys_days first_;
  std::vector<DayHours> hours_;
  std::vector<DayMean> means_;
};

// Thresholds, °C and g/kg. Those of buildings differ; a response bends where two neighbours do.
constexpr std::array kAboveByDay = {-5.0, 0.0, 5.0, 10.0, 14.0, 18.0, 22.0, 26.0};
constexpr std::array kAbove = {14.0, 22.0};
constexpr std::array kBelow = {0.0, 5.0, 10.0, 15.0, 18.0};
constexpr std::array kHumidityAbove = {8.0, 11.0};
constexpr std::array kWindBelow = {10.0, 18.0};
constexpr std::array kYesterdayAbove = {5.0, 10.0, 15.0, 20.0, 25.0};
constexpr std::array kMemoryBelow = {0.0, 5.0, 10.0, 15.0, 20.0};
constexpr std::array kMorningBelow = {-5.0, 5.0, 12.0, 18.0};
constexpr std::array kHighestAbove = {5.0, 12.0, 18.0, 22.0, 26.0, 30.0};
constexpr std::array kHighestHumidityAbove = {10.0, 13.0};
constexpr std::size_t kPlainTerms = 11;
constexpr std::size_t kTerms = kPlainTerms + kAboveByDay.size() + kAbove.size() + kBelow.size() +
                               kHumidityAbove.size() + kWindBelow.size() + kYesterdayAbove.size() +
                               kMemoryBelow.size() + kMorningBelow.size() + kHighestAbove.size() +
                               kHighestHumidityAbove.size();

std::array<double, kTerms> terms_of(const DayHours& day, const DayMean& yesterday,
                                    const DayMean& memory) {
  std::array<double, kTerms> terms;
  std::size_t next = 0;
  const auto add = [&](double value) { terms[next++] = value; };
  const auto over = [&](const DayHours::Hours& values, int first, int last, double threshold) {
    return day.mean(values, first, last, [&](double value) { return above(value, threshold); });
  };
  const double mean_C = day.mean(day.dry_bulb_C);
  const double morning_C = day.mean(day.dry_bulb_C, 5, 9, [](double value) { return value; });
  const double highest_C = day.max(day.dry_bulb_C);
  const double highest_g_kg = day.max(day.humidity_g_kg);
  for (const double value :
       {mean_C, day.sun_mean_W_m2, day.sun_mean_W_m2 * std::clamp(mean_C / 20.0, 0.0, 1.5),
        yesterday.dry_bulb_C, yesterday.sun_W_m2, memory.dry_bulb_C, memory.sun_W_m2, morning_C,
        highest_C, day.sun_max_W_m2, highest_g_kg}) {
    add(value);
  }
  for (const double b : kAboveByDay) add(over(day.dry_bulb_C, 7, 19, b));
  for (const double b : kAbove) add(over(day.dry_bulb_C, 0, day.count, b));
  for (const double b : kBelow) {
    add(day.mean(day.dry_bulb_C, 0, day.count, [&](double value) { return below(value, b); }));
  }
  for (const double b : kHumidityAbove) add(over(day.humidity_g_kg, 0, day.count, b));
  for (const double b : kWindBelow) add(day.wind_mean_m_s * below(mean_C, b));
  for (const double b : kYesterdayAbove) add(above(yesterday.dry_bulb_C, b));
  for (const double b : kMemoryBelow) add(below(memory.dry_bulb_C, b));
  for (const double b : kMorningBelow) add(below(morning_C, b));
  for (const double b : kHighestAbove) add(above(highest_C, b));
  for (const double b : kHighestHumidityAbove) add(above(highest_g_kg, b));
  return terms;
}

}  // namespace

DailyInputs daily_inputs(const WeatherSeries& weather, const metering::LocalCalendar& calendar,
                         const std::vector<Day>& wanted) {
  const auto n = static_cast<Eigen::Index>(wanted.size());
  DailyInputs inputs{
      wanted, Eigen::MatrixXd::Constant(n, static_cast<Eigen::Index>(kTerms), kAbsent),
      Eigen::MatrixXd::Constant(n, static_cast<Eigen::Index>(kDayMeans.size()), kAbsent)};
  if (wanted.empty()) return inputs;
  const auto [first, last] = std::ranges::minmax(wanted);
  const Past past{weather, calendar, sys_days{first} - days{kDaysBack}, sys_days{last}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const sys_days day{wanted[static_cast<std::size_t>(i)]};
    const DayHours& of_day = past.hours(day);
    if (of_day.count == 0) continue;
    const auto terms = terms_of(of_day, past.yesterday(day), past.memory(day));
    inputs.terms.row(i) =
        Eigen::Map<const Eigen::RowVectorXd>(terms.data(), static_cast<Eigen::Index>(kTerms));
    inputs.means.row(i) << of_day.mean(of_day.dry_bulb_C), of_day.sun_mean_W_m2,
        of_day.mean(of_day.humidity_g_kg), of_day.wind_mean_m_s;
  }
  return inputs;
}

std::vector<Day> days_of(const std::vector<metering::Month>& months) {
  std::vector<Day> all;
  for (const metering::Month month : months) {
    const auto count = static_cast<unsigned>(metering::days_in(month));
    for (unsigned day = 1; day <= count; ++day) all.push_back(month / std::chrono::day{day});
  }
  return all;
}

}  // namespace recald::weather
