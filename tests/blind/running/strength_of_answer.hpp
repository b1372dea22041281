/// Parameters of the catalogue in the terms in which answers state strengths.
#pragma once

#include <string_view>

namespace recald::blind {

/// A parameter that is the same quantity as the strength of the hidden effect of that id.
struct StrengthOfAnswer {
  std::string_view effect;
  std::string_view parameter;
  double factor;  ///< strength = factor * parameter + offset
  double offset;
  std::string_view unit;  ///< The answer's, word by word.

  [[nodiscard]] double strength(double parameter_value) const {
    return factor * parameter_value + offset;
  }
};

/// nullptr where the two are different quantities: kW against W/m2, a factor on a leak against the
/// area of a gap. Such an interval cannot be compared with the answer.
[[nodiscard]] const StrengthOfAnswer* strength_of_answer(std::string_view effect);

}  // namespace recald::blind
