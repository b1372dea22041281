#include "simulators/footprint/meter_key.hpp"

#include <algorithm>

namespace recald::simulators {

std::string in_words(std::string_view snake_case) {
  std::string words(snake_case);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string_view colour_of(Utility utility) {
  // Distinguishable with colour blindness: Okabe, Ito (2008), Color Universal Design.
  switch (utility) {
    case Utility::electricity:
      return "#4d4d4d";
    case Utility::cooling:
      return "#0072b2";
    case Utility::heat:
      return "#d55e00";
  }
  return kInk;
}

Point draw_key(Svg& svg, Point at, std::span<const KeyEntry> entries) {
  constexpr TextStyle style{.size = 13.0, .bold = true};
  constexpr double bold_is_wider = 1.1;
  for (const KeyEntry& entry : entries) {
    svg.rectangle({at.x, at.y - 10.0, 11.0, 11.0}, colour_of(entry.utility));
    at.x += 17.0;
    svg.text(at, entry.text, style);
    at.x += bold_is_wider * text_width(entry.text, style.size) + 22.0;
  }
  return at;
}

}  // namespace recald::simulators
