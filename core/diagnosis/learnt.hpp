/// Figures of effects learnt from a training population.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

namespace recald::diagnosis {

struct Learnt {
  std::string_view effect;
  double value;
};

/// @param otherwise  For an effect about which the population showed nothing.
[[nodiscard]] inline double learnt_of(std::span<const Learnt> table, std::string_view effect,
                                      double otherwise) {
  const auto found = std::ranges::find(table, effect, &Learnt::effect);
  return found == table.end() ? otherwise : found->value;
}

}  // namespace recald::diagnosis
