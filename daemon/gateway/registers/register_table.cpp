#include "daemon/gateway/registers/register_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace recald::daemon {
namespace {

using enum RegisterType;
using SiteRegister = RegisterEntry<SiteFacts>;
using MeterRegister = RegisterEntry<MeterFacts>;

constexpr std::array kNoYes{RegisterWord{0, "no"}, RegisterWord{1, "yes"}};
constexpr std::array kQualities{RegisterWord{0, "good"},
                                RegisterWord{1, "something should be looked at"},
                                RegisterWord{2, "not ready: readings cannot be stamped or stored"}};
constexpr std::array kDriftStates{
    RegisterWord{0, "not followed"}, RegisterWord{1, "as forecast"},
    RegisterWord{2, "evidence of a change, half of an alarm's or more"},
    RegisterWord{3, "an alarm is open"}, RegisterWord{4, "a meter is set aside since an alarm"}};
constexpr std::array kMeterStates{RegisterWord{0, "not live: in files, or a sum"},
                                  RegisterWord{1, "answers"}, RegisterWord{2, "answers sometimes"},
                                  RegisterWord{3, "does not answer"}, RegisterWord{4, "pushed"}};
constexpr std::array kValidities{RegisterWord{0, "none yet"}, RegisterWord{1, "ok"},
                                 RegisterWord{2, "missing"},  RegisterWord{3, "filled"},
                                 RegisterWord{4, "scaled"},   RegisterWord{5, "suspect"}};

double number_of(std::optional<metering::Month> month) {
  if (!month) return 0.0;
  return 100.0 * static_cast<int>(month->year()) + static_cast<unsigned>(month->month());
}

double number_of(std::optional<metering::Instant> time) {
  return time ? static_cast<double>(time->time_since_epoch().count()) : 0.0;
}

template <class Code>
double number_of(Code code) {
  return static_cast<double>(static_cast<std::uint16_t>(code));
}

constexpr std::array kSite{
    SiteRegister{0, u16, "map_version", "", "of this map",
                 [](const SiteFacts&) -> double { return kMapVersion; }},
    SiteRegister{1, u16, "meters", "", "number of blocks of meters",
                 [](const SiteFacts& s) {
                   return static_cast<double>(std::min<std::size_t>(s.meters.size(), kMetersMax));
                 }},
    SiteRegister{2, u32, "uptime", "s",
                 "of the daemon; it counts up with every renewal, every two seconds, so one that "
                 "stands still is a daemon that hangs",
                 [](const SiteFacts& s) { return static_cast<double>(s.uptime.count()); }},
    SiteRegister{4, u32, "time", "s", "of the values, since 1970-01-01 UTC",
                 [](const SiteFacts& s) { return number_of(std::optional{s.time}); }},
    SiteRegister{6, u16, "quality", "", "of the site's data",
                 [](const SiteFacts& s) { return number_of(s.quality); }, kQualities},
    SiteRegister{7, u16, "clock_ok", "", "readings can be stamped",
                 [](const SiteFacts& s) { return s.is_clock_ok ? 1.0 : 0.0; }, kNoYes},
    SiteRegister{8, u16, "store_ok", "", "readings can be stored",
                 [](const SiteFacts& s) { return s.is_store_ok ? 1.0 : 0.0; }, kNoYes},
    SiteRegister{9, u16, "meters_silent", "",
                 "live meters without a value for half an hour and two intervals; pushed ones for "
                 "36 hours",
                 [](const SiteFacts& s) {
                   return static_cast<double>(
                       std::ranges::count_if(s.meters, &MeterFacts::is_silent));
                 }},
    SiteRegister{10, u16, "drift_state", "", "the highest of all meters",
                 [](const SiteFacts& s) { return number_of(s.drift.state); }, kDriftStates},
    SiteRegister{11, u16, "alarm_code", "",
                 "likeliest cause of the open alarm, see the codes; 0 without one",
                 [](const SiteFacts& s) { return number_of(s.drift.alarm); }},
    SiteRegister{12, u16, "alarms", "",
                 "in the months followed so far, also those that are over: one more is a new one",
                 [](const SiteFacts& s) { return static_cast<double>(s.alarms); }},
    SiteRegister{13, u16, "alarm_meter", "", "number of the open alarm's meter, from 1; 0: none",
                 [](const SiteFacts& s) { return static_cast<double>(s.alarm_meter); }},
    SiteRegister{14, u32, "alarm_since", "", "month since when, as YYYYMM; 0: none",
                 [](const SiteFacts& s) { return number_of(s.drift.since); }},
    SiteRegister{16, f32, "alarm_probability", "1", "of that cause, 0 to 1",
                 [](const SiteFacts& s) { return s.drift.probability; }},
    SiteRegister{18, f32, "model_age", "d", "since the calibration in use was made",
                 [](const SiteFacts& s) { return s.model_age_days; }},
    SiteRegister{20, u16, "named_effect", "",
                 "what the newest diagnosis has found missing from the model, see the codes; "
                 "0: nothing",
                 [](const SiteFacts& s) { return number_of(s.named); }},
};

constexpr std::array kMeter{
    MeterRegister{0, u16, "state", "", "of the meter",
                  [](const MeterFacts& m) { return number_of(m.state); }, kMeterStates},
    MeterRegister{1, u16, "quality", "", "of the last interval",
                  [](const MeterFacts& m) { return static_cast<double>(m.quality); }, kValidities},
    MeterRegister{2, f32, "power", "kW", "at the last answer of a polled meter, while it answers",
                  [](const MeterFacts& m) { return m.power_kW; }},
    MeterRegister{4, f32, "interval_mean", "kW", "of the last interval",
                  [](const MeterFacts& m) { return m.interval_mean_kW; }},
    MeterRegister{6, u32, "interval_start", "s", "since 1970-01-01 UTC; 0: none",
                  [](const MeterFacts& m) { return number_of(m.interval_start); }},
    MeterRegister{8, f32, "expected_q05", "kW",
                  "load expected in the newest hour of which the weather is known, 5 % quantile; "
                  "only of a site with a [building]",
                  [](const MeterFacts& m) { return m.expected_kW.q05; }},
    MeterRegister{10, f32, "expected_q50", "kW", "the same, median",
                  [](const MeterFacts& m) { return m.expected_kW.q50; }},
    MeterRegister{12, f32, "expected_q95", "kW", "the same, 95 % quantile",
                  [](const MeterFacts& m) { return m.expected_kW.q95; }},
    MeterRegister{14, u32, "month", "", "this local month, as YYYYMM; 0: the clock is not set",
                  [](const MeterFacts& m) { return number_of(m.open.month); }},
    MeterRegister{16, f32, "month_daily_average", "kWh/d", "this month's so far",
                  [](const MeterFacts& m) { return m.open.daily_average_kWh; }},
    MeterRegister{18, f32, "month_peak", "kW", "this month's so far",
                  [](const MeterFacts& m) { return m.open.peak_kW; }},
    MeterRegister{20, f32, "month_coverage", "1",
                  "share of this month's intervals so far that are measured, 0 to 1",
                  [](const MeterFacts& m) { return m.open.coverage; }},
    MeterRegister{
        22, f32, "month_forecast_q05", "kWh/d",
        "forecast of the daily average of this whole month, 5 % quantile; only of a site with a "
        "[building]",
        [](const MeterFacts& m) { return m.open.forecast_kWh.q05; }},
    MeterRegister{24, f32, "month_forecast_q50", "kWh/d", "the same, median",
                  [](const MeterFacts& m) { return m.open.forecast_kWh.q50; }},
    MeterRegister{26, f32, "month_forecast_q95", "kWh/d", "the same, 95 % quantile",
                  [](const MeterFacts& m) { return m.open.forecast_kWh.q95; }},
    MeterRegister{28, u32, "closed_month", "", "last closed month, as YYYYMM; 0: none",
                  [](const MeterFacts& m) { return number_of(m.closed.month); }},
    MeterRegister{30, f32, "closed_daily_average", "kWh/d", "of that month",
                  [](const MeterFacts& m) { return m.closed.daily_average_kWh; }},
    MeterRegister{32, f32, "closed_peak", "kW", "of that month",
                  [](const MeterFacts& m) { return m.closed.peak_kW; }},
    MeterRegister{34, f32, "closed_coverage", "1", "share of that month that is measured, 0 to 1",
                  [](const MeterFacts& m) { return m.closed.coverage; }},
    MeterRegister{36, u16, "closed_usable", "", "enough of that month is measured",
                  [](const MeterFacts& m) { return m.closed.is_usable ? 1.0 : 0.0; }, kNoYes},
    MeterRegister{38, f32, "closed_forecast_q05", "kWh/d",
                  "what the model forecast for that month before it was known, 5 % quantile",
                  [](const MeterFacts& m) { return m.closed.forecast_kWh.q05; }},
    MeterRegister{40, f32, "closed_forecast_q50", "kWh/d", "the same, median",
                  [](const MeterFacts& m) { return m.closed.forecast_kWh.q50; }},
    MeterRegister{42, f32, "closed_forecast_q95", "kWh/d", "the same, 95 % quantile",
                  [](const MeterFacts& m) { return m.closed.forecast_kWh.q95; }},
    MeterRegister{44, u16, "drift_state", "", "of the meter",
                  [](const MeterFacts& m) { return number_of(m.drift.state); }, kDriftStates},
    MeterRegister{45, u16, "alarm_code", "",
                  "likeliest cause of its open alarm, see the codes; 0 without one",
                  [](const MeterFacts& m) { return number_of(m.drift.alarm); }},
    MeterRegister{46, u32, "alarm_since", "", "month since when, as YYYYMM; 0: none",
                  [](const MeterFacts& m) { return number_of(m.drift.since); }},
    MeterRegister{48, f32, "alarm_probability", "1", "of that cause, 0 to 1",
                  [](const MeterFacts& m) { return m.drift.probability; }},
    MeterRegister{50, f32, "drift_evidence", "1", "that something has changed; 1 raises an alarm",
                  [](const MeterFacts& m) { return m.drift.evidence; }},
    MeterRegister{52, u32, "expected_hour", "s",
                  "start of the hour of the expected load, since 1970-01-01 UTC; 0: none",
                  [](const MeterFacts& m) { return number_of(m.expected_hour); }},
};

void put(std::span<std::uint16_t> at, std::uint32_t bits) {
  at[0] = static_cast<std::uint16_t>(bits >> 16);
  at[1] = static_cast<std::uint16_t>(bits & 0xFFFF);
}

void put(std::span<std::uint16_t> at, RegisterType type, double value) {
  if (type == f32) {
    // A quiet NaN without a sign, as clients show it; one of ours may have any other bits.
    constexpr std::uint32_t kNaN = 0x7FC00000;
    const bool fits = std::abs(value) <= std::numeric_limits<float>::max();
    return put(at, fits ? std::bit_cast<std::uint32_t>(static_cast<float>(value)) : kNaN);
  }
  const double most = type == u16 ? std::numeric_limits<std::uint16_t>::max()
                                  : std::numeric_limits<std::uint32_t>::max();
  const auto whole = static_cast<std::uint32_t>(std::clamp(value, 0.0, most));
  if (type == u32) return put(at, whole);
  at[0] = static_cast<std::uint16_t>(whole);
}

template <class Facts>
void put_all(std::span<std::uint16_t> block, std::span<const RegisterEntry<Facts>> entries,
             const Facts& facts) {
  for (const auto& entry : entries) {
    put(block.subspan(static_cast<std::size_t>(entry.at)), entry.type, entry.value(facts));
  }
}

}  // namespace

std::string_view name_of(RegisterType type) {
  switch (type) {
    case u16:
      return "u16";
    case u32:
      return "u32";
    case f32:
      break;
  }
  return "f32";
}

int registers_of(RegisterType type) { return type == u16 ? 1 : 2; }

std::span<const SiteRegister> site_registers() { return kSite; }
std::span<const MeterRegister> meter_registers() { return kMeter; }

std::vector<std::uint16_t> register_values(const SiteFacts& site) {
  const std::size_t meters = std::min<std::size_t>(site.meters.size(), kMetersMax);
  std::vector<std::uint16_t> values(static_cast<std::size_t>(meter_at(meters)));
  put_all<SiteFacts>(values, kSite, site);
  for (std::size_t i = 0; i < meters; ++i) {
    const std::span all{values};
    put_all<MeterFacts>(all.subspan(static_cast<std::size_t>(meter_at(i)), kMeterBlock), kMeter,
                        site.meters[i]);
  }
  return values;
}

}  // namespace recald::daemon
