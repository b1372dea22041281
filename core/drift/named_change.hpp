/// What the hours of a record say of a change that its months have noticed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/drift/cause.hpp"
#include "core/drift/watch/watch.hpp"

namespace recald::drift {

/// An effect that may have begun.
struct NamedEffect {
  std::string effect;  ///< Id in the catalogue.
  std::string title;
  int output;  ///< Whose meter it falsifies; -1: it is one of the building.
  double probability;
};

/// Probabilities add up to 1: that something has changed is known from elsewhere.
struct NamedChange {
  std::vector<NamedEffect> effects;
  double unknown = 0.0;
};

/// Asked for a change with the months from `first`, before which the building was another one, to
/// `until`; nothing where the hours cannot tell, or when `proceed` says that it is enough.
using AskHours = std::function<std::optional<NamedChange>(const Alarm& alarm, int first, int until,
                                                          const std::function<bool()>& proceed)>;

/// Puts names to causes. Hours and months are the same readings, and hours say more of them: which
/// meter or which effect of the building it is. Months say whether it is anything at all, by how
/// much a meter is off, and what it may be where the hours know no name.
/// @param causes  Of the months, adding up to 1.
/// @return the likeliest first, adding up to 1.
[[nodiscard]] std::vector<Cause> with_names(std::vector<Cause> causes, const NamedChange& names);

}  // namespace recald::drift
