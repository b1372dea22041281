/// A diagnosis in the shape that its page shows.
#pragma once

#include <string>
#include <vector>

#include "adapters/report/diagnosis_data.hpp"
#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/naming/monthly_vote.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/model/run_facts.hpp"

namespace recald::daemon {

/// @param generated_at  As it shall stand on the page.
/// @param others        The gap of other models than the hourly one.
/// @pre the diagnosis has a pass.
[[nodiscard]] report::DiagnosisData diagnosis_report_of(
    const SiteConfig& config, const diagnosis::Diagnosis& diagnosis,
    const diagnosis::SiteProblem& site, const RunFacts& facts, std::string generated_at,
    const std::vector<diagnosis::ModelGap>& others = {});

}  // namespace recald::daemon
