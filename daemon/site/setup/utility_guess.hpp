/// What a meter probably measures, by its name and its unit.
#pragma once

#include <string>
#include <string_view>

#include "core/metering/reading.hpp"

namespace recald::daemon {

struct UtilityGuess {
  metering::Utility utility;
  std::string because;  ///< "its name", "its unit", "nothing says otherwise"
};

[[nodiscard]] UtilityGuess guess_utility(std::string_view name, std::string_view unit);

}  // namespace recald::daemon
