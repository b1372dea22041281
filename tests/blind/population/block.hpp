/// What kind of case it is; the blocks are drawn and scored apart.
#pragma once

#include <array>
#include <string_view>

namespace recald::blind {

enum class Block { no_effect, single, out_of_catalogue, pair };

/// As answers spell it (records.py).
[[nodiscard]] inline std::string_view block_name(Block block) {
  constexpr std::array<std::string_view, 4> names{"no_effect", "single", "out_of_catalogue",
                                                  "pair"};
  return names.at(static_cast<std::size_t>(block));
}

}  // namespace recald::blind
