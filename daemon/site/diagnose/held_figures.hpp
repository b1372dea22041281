/// A site's monthly figures, as a monthly model's vote on a diagnosis reads them.
#pragma once

#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/diagnosis/naming/monthly_vote.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"

namespace recald::daemon {

/// @param site  Its model's outputs are measured.
/// @return (months of `problem`) with their roles there.
[[nodiscard]] diagnosis::MonthlyFigures held_figures(const SiteConfig& site,
                                                     const Recording& recording,
                                                     const diagnosis::SiteProblem& problem);

}  // namespace recald::daemon
