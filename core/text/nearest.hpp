/// Which known name somebody probably meant.
#pragma once

#include <span>
#include <string_view>

namespace recald {

/// The candidate with the smallest edit distance (Levenshtein, 1966) to `text`; empty when even
/// that one is further away than half its length, so that a guess is never absurd.
///
/// @param wrong_share_max  Of a name's letters; among hundreds of candidates some name is always
/// near.
[[nodiscard]] std::string_view nearest_name(std::string_view text,
                                            std::span<const std::string_view> candidates,
                                            double wrong_share_max = 0.5);

}  // namespace recald
