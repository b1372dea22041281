/// A diagnosis as files have it.
#pragma once

#include <string>
#include <vector>

#include "adapters/results/run_facts.hpp"
#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/naming/monthly_vote.hpp"

namespace recald::views {

/// `diagnosis.json`.
/// @param others   Entries of `gap` beside the hourly model's.
/// @pre the diagnosis has a pass.
[[nodiscard]] std::string diagnosis_json(const diagnosis::Diagnosis& diagnosis,
                                         const diagnosis::SiteProblem& site, const RunFacts& facts,
                                         const std::vector<diagnosis::ModelGap>& others = {});

}  // namespace recald::views
