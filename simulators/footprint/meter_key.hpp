/// The names and colours of meters in all figures.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "simulators/building/plant.hpp"
#include "simulators/footprint/svg.hpp"

namespace recald::simulators {

/// "chilled_water" in words.
[[nodiscard]] std::string in_words(std::string_view snake_case);

[[nodiscard]] std::string_view colour_of(Utility utility);

struct KeyEntry {
  Utility utility;
  std::string text;
};

/// One line of coloured squares with their texts.
/// @param at  Start of its base line.
/// @return where more text could follow
Point draw_key(Svg& svg, Point at, std::span<const KeyEntry> entries);

}  // namespace recald::simulators
