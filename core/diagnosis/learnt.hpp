/// Figures of effects that a training population taught.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

namespace recald::diagnosis {

struct Learnt {
  std::string_view effect;
  double value;
};

/// @param otherwise  For an effect that the population had no say about.
[[nodiscard]] inline double learnt_of(std::span<const Learnt> table, std::string_view effect,
                                      double otherwise) {
  const auto found = std::ranges::find(table, effect, &Learnt::effect);
  return found == table.end() ? otherwise : found->value;
}

}  // namespace recald::diagnosis
