/// Columns that say how good each value is: measured, estimated, missing.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace recald::table {

inline constexpr std::size_t kFlagsMax = 32;  ///< Different flags of a column that are counted.

/// A flag, and how often it stands beside what.
struct FlagCount {
  std::string flag;
  std::uint64_t rows = 0;
  std::uint64_t empty = 0;  ///< Of these, rows whose value is blank or zero.
};

enum class FlagMeaning : std::uint8_t { unknown, measured, estimated, missing };

/// The meaning of one flag among the others of its column, by a table of words in eleven languages
/// and of letters in use. A letter means what the others beside it make of it: F is "final" beside
/// A and "fehlt" beside W, and where that leaves it open, missing if it never has a value.
[[nodiscard]] FlagMeaning meaning_of(const FlagCount& flag, std::span<const FlagCount> all);

/// Whether a header names such a column.
[[nodiscard]] bool is_flag_header(std::string_view header);

/// Whether texts that are all of a column's say how values came about: two or more, each known, and
/// some not only by a letter.
[[nodiscard]] bool are_flags(std::span<const std::string_view> texts);

/// Which flags of a column mean what.
struct FlagMeanings {
  std::vector<std::string> missing;
  std::vector<std::string> estimated;
  std::vector<FlagCount> unknown;
};
[[nodiscard]] FlagMeanings meanings_of(std::span<const FlagCount> flags);

}  // namespace recald::table
