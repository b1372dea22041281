#include "daemon/gateway/run/weather_wait.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "core/weather/weather_series.hpp"

namespace recald::daemon {
namespace {

using weather::grade_of;
using weather::WeatherGrade;

constexpr std::chrono::hours kLookEvery{1};
/// Looking reads all the weather of years, and weather that is this late will hardly come any more.
constexpr std::chrono::days kHopedFor{60};
constexpr std::chrono::hours kLookAtOldEvery{24};
constexpr int kJobsMax = 20;  // searched for one with known weather

bool is_lacking(const MonthWeather& month) { return grade_of(month.known) < WeatherGrade::good; }

/// From the first of these months to the last.
std::optional<metering::MonthRange> range_of(const std::vector<MonthWeather>& months) {
  std::optional<metering::MonthRange> range;
  for (const MonthWeather& one : months) {
    const auto month = metering::parse_month(one.month);
    if (!month) continue;
    if (!range) range = metering::MonthRange{*month, *month};
    range->first = std::min(range->first, *month);
    range->last = std::max(range->last, *month);
  }
  return range;
}

/// Whether one of the months that lack weather ended recently.
bool has_recent_lack(const std::vector<MonthWeather>& months, metering::Instant now) {
  return std::ranges::any_of(months, [&](const MonthWeather& one) {
    const auto month = metering::parse_month(one.month);
    if (!month || !is_lacking(one)) return false;
    return now - std::chrono::sys_days{metering::next_month(*month) / 1} < kHopedFor;
  });
}

/// An exception while looking counts as no weather.
Result<std::vector<MonthWeather>> look_safely(const CheckWeather& look,
                                              const metering::MonthRange& months) {
  try {
    return look(months);
  } catch (const std::exception& thrown) {
    return failure(ErrorCode::unsupported, thrown.what());
  }
}

}  // namespace

WeatherWait::WeatherWait(Ports ports, CheckWeather look, std::function<void()> ask)
    : ports_(ports), look_(std::move(look)), ask_(std::move(ask)) {}

void WeatherWait::start() { check_every_hour(); }

void WeatherWait::check_every_hour() {
  refresh();
  ports_.loop.after(kLookEvery, alive_.guard([this] { check_every_hour(); }));
}

/// Nothing while a calibration waits or runs: it will see the new weather. One that was cancelled,
/// or failed for another reason, says nothing about the weather.
std::optional<WeatherWait::Known> WeatherWait::last_known() const {
  const auto jobs = ports_.store.jobs(JobKind::calibration, kJobsMax);
  if (!jobs) return {};
  for (const StoredJob& one : *jobs) {
    if (one.state == JobState::cancelled) continue;
    if (one.state != JobState::done && one.state != JobState::failed) return {};
    if (asked_ && asked_->job == one.number) return asked_;
    auto job = ports_.store.job(one.number);
    if (!job || !*job) return {};
    std::vector<MonthWeather>& months = (*job)->result.weather;
    if (!months.empty()) return Known{one.number, std::move(months)};
    if (one.state == JobState::done) return {};
  }
  return {};
}

void WeatherWait::refresh() {
  if (is_looking_) return;
  auto known = last_known();
  if (!known || std::ranges::none_of(known->months, is_lacking)) return;
  // All months, as in the calibration: what is known of one may depend on its neighbours.
  const auto months = range_of(known->months);
  if (!months) return;
  const Moment now = ports_.loop.now();
  const bool is_old = !has_recent_lack(known->months, now.instant());
  if (is_old && looked_at_ && now.monotonic - *looked_at_ < kLookAtOldEvery) return;
  looked_at_ = now.monotonic;
  is_looking_ = true;
  // The work may outlive this object, so it has copies of everything it uses.
  const auto found = std::make_shared<Result<std::vector<MonthWeather>>>();
  ports_.worker.run([look = look_, months = *months, found] { *found = look_safely(look, months); },
                    alive_.guard([this, then = std::move(*known), found] {
                      is_looking_ = false;
                      if (*found) compare(then, std::move(**found));
                    }));
}

void WeatherWait::compare(const Known& then, std::vector<MonthWeather> now) {
  const bool is_better = std::ranges::any_of(then.months, [&](const MonthWeather& before) {
    const auto found = std::ranges::find(now, before.month, &MonthWeather::month);
    return found != now.end() && grade_of(found->known) > grade_of(before.known);
  });
  if (!is_better) return;
  asked_ = Known{then.job, std::move(now)};
  ask_();
}

}  // namespace recald::daemon
