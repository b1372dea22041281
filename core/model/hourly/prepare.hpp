/// Derives the loads of the hourly model from a site's electricity record.
#pragma once

#include <span>
#include <vector>

#include "core/model/electricity_profile.hpp"
#include "core/model/epc/prepare.hpp"

namespace recald::model::hourly {

/// Fits the electricity profile to the meter without the building's own fans, pumps and chiller.
/// These are subtracted hour by hour, as the hourly model expects them at its design values, so
/// that the profile does not count them again. They depend on the loads and the loads on them: each
/// round leaves about a third of the error.
/// @param months  The months of the loads; the weather must cover them.
/// @return the profile, with the mean of the subtracted loads among the known loads and in
///         `measured_kW`; its check is for the months without them.
[[nodiscard]] Result<model::ElectricityProfile> fit_profile_without_plant(
    std::span<const model::HourlyLoad> loads, const Building& building, const epc::Place& place,
    const std::vector<metering::Month>& months);

}  // namespace recald::model::hourly
