/// How all figures name meters and tell them apart.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "simulators/building/plant.hpp"
#include "simulators/footprint/svg.hpp"

namespace recald::simulators {

/// "chilled_water" as people write it.
[[nodiscard]] std::string in_words(std::string_view snake_case);

[[nodiscard]] std::string_view colour_of(Utility utility);

struct KeyEntry {
  Utility utility;
  std::string text;
};

/// One line of coloured squares with their texts.
/// @param at  where its base line begins
/// @return where the next text could follow
Point draw_key(Svg& svg, Point at, std::span<const KeyEntry> entries);

}  // namespace recald::simulators
