/// A diagnosis as files and words have it.
#pragma once

#include <string>

#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/model_version.hpp"
#include "daemon/config/site_config.hpp"
#include "daemon/results/run_facts.hpp"

namespace recald::daemon {

/// `diagnosis.json`. @param applied  Version that was put in force; empty: none.
[[nodiscard]] std::string diagnosis_json(const diagnosis::Diagnosis& diagnosis,
                                         const diagnosis::SiteProblem& site, const RunFacts& facts,
                                         const std::string& applied);

/// For the person who runs the building.
[[nodiscard]] std::string diagnosis_words(const diagnosis::Diagnosis& diagnosis,
                                          const diagnosis::SiteProblem& site);

/// The model's next version: the parent and what the diagnosis added.
[[nodiscard]] diagnosis::ModelVersion next_version(const diagnosis::Diagnosis& diagnosis,
                                                   const diagnosis::SiteProblem& site,
                                                   const diagnosis::ModelVersion& parent,
                                                   const RunFacts& facts, const std::string& at);

}  // namespace recald::daemon
