/// Whether an effect that the hourly model was given also helps the monthly model that the site is
/// calibrated with.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/naming/monthly_vote.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

/// @param problem  Of the site, as the diagnosis had it: months and their roles are taken from it.
/// @param added    With η at their modes, one on top of the other.
/// @return the gap; or
///         unsupported      the monthly model cannot be made of this site;
///         not_enough_data  fewer than two months shown, or too few to fit; no electricity meter.
/// @note   Maximum a posteriori, Gauss-Newton: well under a second. Same input, same bytes.
[[nodiscard]] Result<diagnosis::MonthlyVote> epc_gap(
    const SiteConfig& site, const metering::LocalCalendar& calendar, const Recording& recording,
    const SiteWeather& weather, const diagnosis::SiteProblem& problem,
    std::span<const diagnosis::Addition> added, std::uint64_t seed = 1);

}  // namespace recald::daemon
