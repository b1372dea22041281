/// What screening and meta-models leave behind: screen.json, metamodel.json and their tables.
#pragma once

#include <string>
#include <vector>

#include "core/model/parameter.hpp"
#include "core/screening/screen.hpp"
#include "daemon/site/calibrate/design_metamodel.hpp"
#include "daemon/site/model/run_facts.hpp"

namespace recald::daemon {

/// One JSON object as text, indented.
[[nodiscard]] std::string screen_json(const screening::Screening& screening,
                                      const std::vector<Parameter>& parameters,
                                      const std::vector<std::string>& notes, const RunFacts& facts);

/// Parameters by their share of an output's spread, largest first, with the verdict and how sure it
/// is; then how well each output's lasso does.
[[nodiscard]] std::string screen_table(const screening::Screening& screening,
                                       const std::vector<Parameter>& parameters,
                                       const std::vector<std::string>& notes);

/// `terms` are those of the chosen form. Seed: by meter, one coefficient each. Monthly: by output,
/// one coefficient a month. Variables are scaled to [0, 1] by `scaling`, outputs likewise.
[[nodiscard]] std::string metamodel_json(
    const FittedMetamodel& fitted, const std::vector<std::string>& notes, const RunFacts& facts,
    const std::vector<regression::CheckedOutput>& checked = {});

/// Both forms by output, in sample and left out, and which was chosen.
[[nodiscard]] std::string metamodel_table(
    const FittedMetamodel& fitted, const std::vector<std::string>& notes,
    const std::vector<regression::CheckedOutput>& checked = {});

}  // namespace recald::daemon
