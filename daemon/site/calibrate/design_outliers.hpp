/// Runs of a design that a meta-model had better not learn from.
#pragma once

#include <string>
#include <vector>

#include "adapters/doe/design_folder.hpp"

namespace recald::daemon {

/// Takes the runs out that stand far from all others (regression::outlying_runs), so that they set
/// neither scale nor fit nor range. Where they are more than a tenth, they are no accident: all
/// stay.
/// @return a sentence for each of the worst, and one for the others.
std::vector<std::string> set_aside_outliers(doe::DesignFolder& design);

}  // namespace recald::daemon
