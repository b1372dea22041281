#include "daemon/gateway/run/weather_wait.hpp"

#include <algorithm>
#include <exception>
#include <iterator>
#include <optional>
#include <utility>

#include "core/weather/weather_series.hpp"

namespace recald::daemon {
namespace {

using weather::grade_of;
using weather::WeatherGrade;

constexpr std::chrono::hours kLookEvery{1};

/// The months of the newest calibration whose weather is not all known. Empty while one waits or
/// runs: it will see what there is.
Result<std::vector<MonthWeather>> lacking_months(Store& store) {
  const auto jobs = store.jobs(JobKind::calibration, 1);
  if (!jobs) return tl::unexpected(jobs.error());
  std::vector<MonthWeather> lacking;
  if (jobs->empty()) return lacking;
  const JobState state = jobs->front().state;
  if (state != JobState::done && state != JobState::failed) return lacking;
  const auto job = store.job(jobs->front().number);
  if (!job) return tl::unexpected(job.error());
  if (!*job) return lacking;
  std::ranges::copy_if(
      (*job)->result.weather, std::back_inserter(lacking),
      [](const MonthWeather& month) { return grade_of(month.known) < WeatherGrade::good; });
  return lacking;
}

/// From the first of them to the last; months in between are looked at too.
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

/// What looking throws is no weather.
Result<std::vector<MonthWeather>> look_safely(const LookAtWeather& look,
                                              const metering::MonthRange& months) {
  try {
    return look(months);
  } catch (const std::exception& thrown) {
    return failure(ErrorCode::unsupported, thrown.what());
  }
}

}  // namespace

WeatherWait::WeatherWait(Ports ports, LookAtWeather look, std::function<void()> ask)
    : ports_(ports),
      look_(std::move(look)),
      ask_(std::move(ask)),
      self_(std::make_shared<WeatherWait*>(this)) {}

void WeatherWait::start() { look_every_hour(); }

void WeatherWait::look_every_hour() {
  look_again();
  ports_.loop.after(kLookEvery, [weak = std::weak_ptr{self_}] {
    if (const auto self = weak.lock()) (*self)->look_every_hour();
  });
}

void WeatherWait::look_again() {
  if (is_looking_) return;
  const auto lacking = lacking_months(ports_.store);
  const auto months = lacking ? range_of(*lacking) : std::nullopt;
  if (!months) return;
  is_looking_ = true;
  // The work may outlive this: it has copies of all it uses.
  const auto found = std::make_shared<Result<std::vector<MonthWeather>>>();
  ports_.worker.run([look = look_, months = *months, found] { *found = look_safely(look, months); },
                    [weak = std::weak_ptr{self_}, then = *lacking, found] {
                      const auto self = weak.lock();
                      if (!self) return;
                      (*self)->is_looking_ = false;
                      if (*found) (*self)->compare(then, **found);
                    });
}

void WeatherWait::compare(const std::vector<MonthWeather>& then,
                          const std::vector<MonthWeather>& now) const {
  const bool is_better = std::ranges::any_of(then, [&](const MonthWeather& before) {
    const auto found = std::ranges::find(now, before.month, &MonthWeather::month);
    return found != now.end() && grade_of(found->known) > grade_of(before.known);
  });
  if (is_better) ask_();
}

}  // namespace recald::daemon
