/// A diagnosis in the shape that its page shows.
#pragma once

#include <string>
#include <vector>

#include "adapters/results/run_facts.hpp"
#include "adapters/views/diagnosis/diagnosis_data.hpp"
#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/naming/monthly_vote.hpp"

namespace recald::views {

/// @param generated_at  As it shall stand on the page.
/// @param others        The gap of other models than the hourly one.
/// @pre the diagnosis has a pass.
[[nodiscard]] DiagnosisData diagnosis_report_of(
    SiteLine line, const diagnosis::Diagnosis& diagnosis, const diagnosis::SiteProblem& site,
    const RunFacts& facts, std::string generated_at,
    const std::vector<diagnosis::ModelGap>& others = {});

}  // namespace recald::views
