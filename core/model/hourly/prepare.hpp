/// From a site's electricity record to the loads of the hourly model.
#pragma once

#include <span>
#include <vector>

#include "core/model/epc/prepare.hpp"
#include "core/profile/electricity_profile.hpp"

namespace recald::model::hourly {

/// Fits the electricity profile to what the meter reads without the building's own fans, pumps and
/// chiller, taken off hour by hour as the hourly model expects them at its design values, so that
/// the profile does not count them once more. They need loads and loads need them: each round
/// leaves about a third of the error before it.
/// @param months  Those the loads come from; the weather must cover them.
/// @return the profile with the mean of what was taken off among the known loads and in
///         `measured_kW`; its check is of the months without it.
[[nodiscard]] Result<profile::ElectricityProfile> fit_profile_without_plant(
    std::span<const profile::HourlyLoad> loads, const Building& building, const epc::Place& place,
    const std::vector<metering::Month>& months);

}  // namespace recald::model::hourly
