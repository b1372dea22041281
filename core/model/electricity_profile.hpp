/// Lighting and plug schedules read off the electricity meter, then fixed.
///
/// The seed fits them by hand before anything thermal is calibrated; they are inputs afterwards,
/// never parameters, and a new fit is a new version.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/metering/months/month_slots.hpp"
#include "core/model/drivers.hpp"
#include "core/model/schedule.hpp"
#include "core/result.hpp"

namespace recald::model {

/// Mean measured power over one local hour.
struct HourlyLoad {
  metering::Day date;
  int hour;         ///< 0…23
  double mean_kW;   ///< NaN where nothing valid was measured.
  double ok_share;  ///< Of the hour's slots.
  bool suspect;     ///< Some slot failed a check.
};

/// Hours of a closed month, in order. The hour that a clock change repeats is one entry, the one
/// it skips none.
[[nodiscard]] std::vector<HourlyLoad> hourly_loads(const metering::MonthSlots& month);

/// What of the meter is known from drawings. All kW at the meter.
struct KnownLoads {
  double exterior_kW = 0.0;
  HourlySchedule fans_and_pumps_kW;
  double lighting_W_m2 = 0.0;  ///< Only their ratio matters.
  double plugs_W_m2 = 0.0;
};

/// How far one profile for the whole year tells the meter's months.
struct ProfileCheck {
  double monthly_cvrmse = 0.0;  ///< Profile against meter, share of the mean.
  bool constant = true;         ///< Within 5 %: one profile serves all months.
  bool uses_month_factors = false;
  std::string words;
};

struct ElectricityProfile {
  HourlySchedule measured_kW;        ///< 10 %-trimmed mean by kind of day and hour.
  HourlySchedule standard_error_kW;  ///< From weekly means; NaN below three weeks.
  ElectricLoads loads;               ///< Lights and plugs, standby among the plugs.
  double standby_kW = 0.0;           ///< Part of the plugs that never goes out.
  KnownLoads known;
  ProfileCheck check;
  int hours_used = 0;
};

/// Splits the measured profile: exterior lights and fans as known, standby as the median of
/// 02–05 h on non-working days, the rest to lights and plugs in the ratio of their installed power.
///
/// Where the year is not told by one profile within 5 % of CV(RMSE), each calendar month gets a
/// factor of its own (1 where the record lacks it).
/// @return not_enough_data when a kind of day has fewer than eight valid hours at some hour of day.
[[nodiscard]] Result<ElectricityProfile> fit_profile(std::span<const HourlyLoad> loads,
                                                     const Holidays& holidays,
                                                     const KnownLoads& known);

}  // namespace recald::model
