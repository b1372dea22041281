/// Whether an effect that the hourly model was given also helps a site's EnergyPlus model.
#pragma once

#include <cstdint>
#include <span>

#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/naming/monthly_vote.hpp"
#include "core/result.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Both models are the meta-model of one design that varies the effects too: once with them at
/// their neutral values, and once where the diagnosis found them. Influential parameters are fitted
/// to both; the others stay at their prior means.
/// @param on_runs  The site with its EnergyPlus model, which was given the effects
///                 (`take_in_effects`) and has all its runs.
/// @param problem  As the diagnosis had it.
/// @return the vote; or what `prepare_on_runs` finds; not_enough_data: as `require_enough`;
///         not_found: months of the diagnosis that the runs do not cover.
[[nodiscard]] Result<diagnosis::MonthlyVote> energyplus_gap(
    const ModelledSite& on_runs, const diagnosis::SiteProblem& problem,
    std::span<const diagnosis::Addition> added, std::uint64_t seed = 1);

}  // namespace recald::daemon
