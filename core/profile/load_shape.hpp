/// What a meter's hours alone tell: its usual day, and the load that is always there.
#pragma once

#include <array>
#include <span>

#include "core/model/electricity_profile.hpp"
#include "core/model/schedule.hpp"

namespace recald::profile {

struct LoadShape {
  model::HourlySchedule mean_kW;             ///< NaN where a kind of day has no such hour.
  std::array<int, model::kDayTypes> days{};  ///< Days with a measured hour, by kind of day.
  double base_kW;     ///< Exceeded in 95 % of the hours; NaN below a week of hours.
  double base_share;  ///< Of the mean load, 0…1; NaN where the meter also counts backwards.
};

/// Hours that are not half measured, or suspect, do not count.
[[nodiscard]] LoadShape load_shape(std::span<const model::HourlyLoad> loads,
                                   const model::Holidays& holidays);

}  // namespace recald::profile
