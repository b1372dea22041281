#include "daemon/gateway/registers/register_watch.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/drift/month_hindcast.hpp"
#include "daemon/gateway/ingest/meter_watch.hpp"
#include "daemon/gateway/registers/drift_facts.hpp"
#include "daemon/gateway/registers/register_table.hpp"
#include "daemon/gateway/serve/api/readiness.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::milliseconds;

constexpr milliseconds kRenewEvery{2'000};
constexpr milliseconds kBetweenMeters{10};  // other work comes first
constexpr std::chrono::hours kLookAnewEvery{6};
constexpr std::chrono::hours kExpectedFor{3};  // an older hour says nothing of now

MeterState state_of(const MeterStatus* status) {
  if (status == nullptr) return MeterState::recorded;
  if (!status->poll) return MeterState::pushed;
  switch (status->poll->state) {
    case UnitState::up:
      return MeterState::up;
    case UnitState::degraded:
      return MeterState::degraded;
    case UnitState::down:
      break;
  }
  return MeterState::down;
}

/// When the meter last gave a value, or since when it is waited for.
Instant heard_from(const MeterStatus& status, std::chrono::seconds interval, Instant started) {
  Instant heard = started;
  const auto note = [&](std::optional<Instant> at) { heard = std::max(heard, at.value_or(heard)); };
  note(status.poll ? status.live.measured_at : status.live.read_at);
  if (status.last_interval) note(status.last_interval->start + interval);
  return heard;
}

QuantileFacts quantiles_of(const StoredForecast& one) { return {one.q05, one.q50, one.q95}; }

/// Where one meter stands above another: an open alarm above a rising evidence.
int urgency(const DriftFacts& drift) {
  // A meter that is set aside is known; an alarm that is open is not.
  if (drift.state == DriftState::set_aside) return static_cast<int>(DriftState::rising);
  return static_cast<int>(drift.state);
}

void add_site_drift(SiteFacts& facts) {
  for (std::size_t i = 0; i < facts.meters.size(); ++i) {
    const DriftFacts& drift = facts.meters[i].drift;
    if (urgency(drift) <= urgency(facts.drift) && i > 0) continue;
    facts.drift = drift;
    facts.alarm_meter =
        drift.alarm == AlarmCode::none ? std::uint16_t{0} : static_cast<std::uint16_t>(i + 1);
  }
}

}  // namespace

RegisterWatch::RegisterWatch(Loop& loop, Served served, Publish publish)
    : loop_(loop), served_(std::move(served)), publish_(std::move(publish)) {}

void RegisterWatch::start() {
  renew();
  refresh_every_six_hours();
}

void RegisterWatch::refresh() {
  results_are_due_ = true;
  for (auto& [id, months] : months_) months.is_due = true;
}

void RegisterWatch::refresh_every_six_hours() {
  refresh();
  loop_.after(kLookAnewEvery, alive_.guard([this] { refresh_every_six_hours(); }));
}

void RegisterWatch::renew() {
  loop_.after(kRenewEvery, alive_.guard([this] { renew(); }));
  if (std::exchange(results_are_due_, false)) read_results();
  const GatewayStatus status = served_.status();
  publish_(facts_of(status));
  // Without a clock there is no month.
  if (!status.clock_ok || is_reading_) return;
  note_news(status);
  is_reading_ = true;
  next_ = 0;
  read_next();
}

void RegisterWatch::note_news(const GatewayStatus& status) {
  for (const MeterStatus& meter : status.meters) {
    if (!meter.last_interval || !meter.weather.empty()) continue;
    MeterMonths& months = months_[meter.id];
    months.has_news |= months.last_start != meter.last_interval->start;
    months.last_start = meter.last_interval->start;
  }
}

/// What cannot be read stays as it was; that the store cannot be read is reported elsewhere.
void RegisterWatch::read_results() {
  if (const auto job = served_.store.last_accepted(JobKind::calibration); job && *job) {
    results_.calibrated = (*job)->ended;
    results_.drift = (*job)->result.drift;
  }
  if (const auto job = served_.store.last_accepted(JobKind::diagnosis); job && *job) {
    results_.named = named_in((*job)->result.document);
  }
  if (auto forecasts = served_.store.forecasts()) results_.forecasts = std::move(*forecasts);
}

/// Reads one meter that has news, and goes on in another step of the loop.
void RegisterWatch::read_next() {
  const auto& meters = served_.site.meters;
  for (; next_ < meters.size(); ++next_) {
    const MeterConfig& config = meters[next_];
    if (!config.is_stored()) continue;
    MeterMonths& months = months_[config.meter.id];
    if (!months.has_news && !months.is_due) continue;
    read(config, months);
    loop_.after(kBetweenMeters, alive_.guard([this] { read_next(); }));
    return;
  }
  is_reading_ = false;
}

void RegisterWatch::read(const MeterConfig& config, MeterMonths& months) {
  const metering::Month month = served_.calendar.month_of(served_.now());
  const bool is_anew = months.is_due || !months.open || months.open->month() != month;
  months.has_news = months.is_due = false;
  if (is_anew) months.open.emplace(config.meter, served_.calendar, month);
  const auto number = served_.store.find_meter(config.meter.id);
  if (!number || !*number) return;
  (void)served_.store.for_each_interval(
      **number, {months.open->next(), months.open->span().end},
      [&](const StoredInterval& interval) { months.open->take(interval.reading); });
  if (!is_anew) return;
  if (const auto closed = served_.store.months(**number); closed && !closed->empty()) {
    months.closed = closed->back().figure;
  }
}

SiteFacts RegisterWatch::facts_of(const GatewayStatus& status) const {
  SiteFacts facts;
  facts.time = served_.now();
  facts.uptime = facts.time - served_.started;
  facts.is_clock_ok = status.clock_ok;
  facts.is_store_ok = status.no_store.empty() && !status.store.is_degraded;
  if (reasons_not_ready(status).empty()) {
    facts.quality = reasons_to_look(status).empty() ? SiteQuality::good : SiteQuality::to_look_at;
  }
  if (results_.calibrated) {
    using Days = std::chrono::duration<double, std::chrono::days::period>;
    facts.model_age_days = Days{facts.time - *results_.calibrated}.count();
  }
  if (results_.drift) facts.alarms = static_cast<std::uint16_t>(results_.drift->alarms.size());
  facts.named = results_.named;
  std::unordered_map<std::string_view, const MeterStatus*> by_id;
  for (const MeterStatus& meter : status.meters) by_id.emplace(meter.id, &meter);
  for (const MeterConfig& config : served_.site.meters) {
    const auto found = by_id.find(config.meter.id);
    facts.meters.push_back(facts_of(config, found == by_id.end() ? nullptr : found->second));
  }
  add_site_drift(facts);
  return facts;
}

MeterFacts RegisterWatch::facts_of(const MeterConfig& config, const MeterStatus* status) const {
  MeterFacts facts;
  facts.state = state_of(status);
  if (status != nullptr) {
    const Instant heard = heard_from(*status, config.meter.interval, served_.started);
    facts.is_silent = served_.now() - heard >
                      meter_silence_max(config.meter.interval, config.source != MeterSource::http);
    // The last value of a meter that does not answer is no value.
    const bool answers = facts.state != MeterState::down;
    facts.power_kW = answers ? status->live.power_kW.value_or(kAbsent) : kAbsent;
    facts.register_kWh = status->live.register_kWh.value_or(kAbsent);
    facts.open.coverage = status->open_month_coverage;
    if (status->last_interval) {
      const metering::Reading& last = *status->last_interval;
      facts.quality = static_cast<std::uint16_t>(1 + static_cast<int>(last.validity));
      facts.interval_mean_kW = last.mean_kW;
      facts.interval_start = last.start;
    }
  }
  add_months(config, facts);
  add_expected(config.meter.id, facts);
  if (results_.drift) facts.drift = drift_of(*results_.drift, config.meter.id);
  return facts;
}

void RegisterWatch::add_months(const MeterConfig& config, MeterFacts& facts) const {
  const auto known = months_.find(config.meter.id);
  if (known == months_.end()) return;
  if (const auto& open = known->second.open) {
    facts.open.month = open->month();
    facts.open.daily_average_kWh = open->daily_average_kWh();
    facts.open.peak_kW = open->peak_kW();
  }
  if (const auto& closed = known->second.closed) {
    facts.closed = {.month = closed->month,
                    .daily_average_kWh = closed->daily_average_kWh,
                    .peak_kW = closed->peak ? closed->peak->kW : kAbsent,
                    .coverage = closed->coverage,
                    .is_usable = closed->usable,
                    .forecast_kWh = {}};
    const std::string output = config.meter.id + "_daily_kWh";
    // The first of its revisions was made before the month was known.
    const auto forecast = std::ranges::find_if(results_.forecasts, [&](const StoredForecast& one) {
      return one.month == closed->month && one.output == output;
    });
    if (forecast != results_.forecasts.end()) facts.closed.forecast_kWh = quantiles_of(*forecast);
  }
}

void RegisterWatch::add_expected(const std::string& meter, MeterFacts& facts) const {
  if (!served_.expected) return;
  const std::vector<ExpectedMeter>& all = served_.expected();
  const auto found = std::ranges::find(all, meter, &ExpectedMeter::meter);
  if (found == all.end()) return;
  if (found->month) add_forecast(*found->month, facts);
  if (found->hours.empty()) return;
  const ExpectedHour& last = found->hours.back();
  if (served_.now() - last.start > kExpectedFor) return;
  facts.expected_hour = last.start;
  facts.expected_kW = {last.load.q05_kW, last.load.q50_kW, last.load.q95_kW};
}

void RegisterWatch::add_forecast(const ExpectedMonth& month, MeterFacts& facts) const {
  constexpr double kHoursPerDay = 24.0;
  if (facts.open.month != month.month) return;
  const metering::TimeSpan span = served_.calendar.month_span(month.month);
  const double elapsed =
      metering::in_hours(month.rest_from - span.begin) / metering::in_hours(span.length());
  const double so_far_kW = facts.open.daily_average_kWh / kHoursPerDay;
  const double mean_kW =
      (elapsed > 0.0 ? elapsed * so_far_kW : 0.0) + (1.0 - elapsed) * month.rest_kW;
  const double scale_kW = drift::forecast_scale_kW(mean_kW, month.mean_kW);
  const auto daily_kWh = [&](double error) { return kHoursPerDay * (mean_kW + error * scale_kW); };
  facts.open.forecast_kWh = {daily_kWh(month.error_q05), daily_kWh(month.error_q50),
                             daily_kWh(month.error_q95)};
}

}  // namespace recald::daemon
