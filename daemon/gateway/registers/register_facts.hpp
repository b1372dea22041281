/// What the registers tell, before it is numbers in registers.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/absent.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/gateway/registers/alarm_codes.hpp"

namespace recald::daemon {

/// Numbers are what registers have: they never change their meaning.
enum class SiteQuality : std::uint16_t { good = 0, to_look_at = 1, not_ready = 2 };
enum class MeterState : std::uint16_t { recorded = 0, up = 1, degraded = 2, down = 3, pushed = 4 };
enum class DriftState : std::uint16_t {
  not_followed = 0,
  as_forecast = 1,
  rising = 2,
  alarm = 3,
  set_aside = 4,
};

struct QuantileFacts {
  double q05 = kAbsent;
  double q50 = kAbsent;
  double q95 = kAbsent;
};

struct MonthFacts {
  std::optional<metering::Month> month;
  double daily_average_kWh = kAbsent;
  double peak_kW = kAbsent;
  double coverage = kAbsent;   ///< 0…1
  bool is_usable = false;      ///< Of a closed month.
  QuantileFacts forecast_kWh;  ///< Of the daily average.
};

struct DriftFacts {
  DriftState state = DriftState::not_followed;
  AlarmCode alarm = AlarmCode::none;
  std::optional<metering::Month> since;
  double probability = kAbsent;  ///< Of the cause, 0…1.
  double evidence = kAbsent;     ///< Log evidence over the threshold of an alarm.
};

struct MeterFacts {
  MeterState state = MeterState::recorded;
  bool is_silent = false;
  std::uint16_t quality = 0;  ///< 0: no interval yet; else 1 + Validity.
  double power_kW = kAbsent;
  double register_kWh = kAbsent;  ///< Of its counter; no register, since a float has 7 digits.
  double interval_mean_kW = kAbsent;
  std::optional<metering::Instant> interval_start;
  QuantileFacts expected_kW;
  std::optional<metering::Instant> expected_hour;  ///< Start of the hour that it is of.
  MonthFacts open;
  MonthFacts closed;
  DriftFacts drift;
};

struct SiteFacts {
  std::chrono::seconds uptime{0};
  metering::Instant time{};
  SiteQuality quality = SiteQuality::not_ready;
  bool is_clock_ok = false;
  bool is_store_ok = false;
  DriftFacts drift;               ///< The open alarm that is likeliest; else the highest state.
  std::uint16_t alarm_meter = 0;  ///< Its number, from 1 on; 0: none.
  std::uint16_t alarms = 0;       ///< In the months followed so far, also those that are over.
  double model_age_days = kAbsent;
  AlarmCode named = AlarmCode::none;  ///< What the newest diagnosis has named.
  std::vector<MeterFacts> meters;     ///< In the order of the site file.
};

}  // namespace recald::daemon
