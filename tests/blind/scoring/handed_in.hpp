/// Cases that others hand in: a folder a case, and one truth.json for all of them.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"
#include "tests/blind/scoring/scored_case.hpp"

namespace recald::blind {

/// Writes `<case>.json` for each case of a truth.json such as
/// `{"clinic": {"archetype": "clinic", "weather": "sydney", "effects": {"fouling": {"strength":
/// 0.4, "unit": "share", "share_of_meter": {"electricity": 0.05}}}}}`. `from`, `to` and
/// `moved_share` are optional; without `share_of_meter` the size is unknown and counts as none.
/// @param catalogue  Effects that can be named, with their classes; others are outside it.
/// @return how many cases, or malformed or invalid_value with the case, the key and the value.
[[nodiscard]] Result<std::size_t> write_handed_in(const std::filesystem::path& truth,
                                                  const std::string& world,
                                                  const EffectClasses& catalogue,
                                                  const std::filesystem::path& answers);

}  // namespace recald::blind
