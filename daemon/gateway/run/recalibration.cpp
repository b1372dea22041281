#include "daemon/gateway/run/recalibration.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace recald::daemon {
namespace {

/// Waits use the monotonic clock and schedules the wall clock, which may be set
/// meanwhile, so check again.
constexpr std::chrono::milliseconds kLookAgain{60'000};
/// The months of many meters close one after the other.
constexpr std::chrono::milliseconds kTogether{60'000};

/// The last month that all of these meters have closed. @return nothing if one of them has none.
Result<std::optional<metering::Month>> last_common_month(Store& store, const SiteConfig& site,
                                                         std::span<const std::string> meters) {
  std::optional<metering::Month> common;
  for (const MeterConfig& config : site.meters) {
    if (std::ranges::find(meters, config.meter.id) == meters.end()) continue;
    if (!config.is_stored()) return std::nullopt;
    const auto number = TRY(store.meter_number(config.meter.id, config.meter.interval));
    const auto months = TRY(store.months(number));
    if (months.empty()) return std::nullopt;
    const metering::Month last = months.back().figure.month;
    common = common ? std::min(*common, last) : last;
  }
  return common;
}

}  // namespace

Recalibration::Recalibration(Loop& loop, const SiteConfig& site, metering::LocalCalendar calendar,
                             std::function<void(const std::string&)> ask)
    : loop_(loop),
      schedule_(site.model ? site.recalibration.schedule : Schedule{}),
      modelled_meters_(site.model ? site.without_sums(site.model->outputs)
                                  : std::vector<std::string>{}),
      calendar_(std::move(calendar)),
      ask_(std::move(ask)) {}

void Recalibration::start() {
  if (!schedule_.times) return;
  if (const auto next = schedule_.times->next(loop_.now().instant(), calendar_)) {
    return wait_for(*next);
  }
  loop_.after(kLookAgain, alive_.guard([this] { start(); }));  // the clock may be decades ahead
}

Result<void> Recalibration::catch_up(Store& store, const SiteConfig& site) {
  if (!schedule_.when_a_month_closes) return {};
  const auto month = TRY(last_common_month(store, site, modelled_meters_));
  if (!month) return {};
  const auto jobs = TRY(store.jobs(JobKind::calibration, 1));
  const auto closed = calendar_.month_span(*month).end + site.closing.watermark;
  if (jobs.empty() || jobs.front().asked < closed) ask_("month");
  return {};
}

void Recalibration::wait_for(metering::Instant next) {
  const auto left = next - loop_.now().wall;
  if (left.count() <= 0) {
    start();  // first, so that the next time comes even if asking throws
    return ask_("schedule");
  }
  loop_.after(std::min(std::chrono::ceil<std::chrono::milliseconds>(left), kLookAgain),
              alive_.guard([this, next] {
                // Of a clock that was set back the next time comes sooner.
                const auto anew = schedule_.times->next(loop_.now().instant(), calendar_);
                wait_for(std::min(next, anew.value_or(next)));
              }));
}

void Recalibration::month_closed(const std::string& meter) {
  if (!schedule_.when_a_month_closes || is_asking_) return;
  if (std::ranges::find(modelled_meters_, meter) == modelled_meters_.end()) return;
  is_asking_ = true;
  loop_.after(kTogether, alive_.guard([this] {
    is_asking_ = false;
    ask_("month");
  }));
}

}  // namespace recald::daemon
