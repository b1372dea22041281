/// Stamps that are written in more ways than most: with words, named zones, ends of ranges.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "adapters/table/cells/stamps.hpp"

namespace recald::table {

struct LooseStamp {
  std::optional<WrittenTime> time;
  std::string odd_end;  ///< Letters behind a time that are no known zone.
};

/// @param format  An order of parts. @see parse_stamp
[[nodiscard]] LooseStamp parse_loosely(std::string_view text, TimeFormat format);

/// @see parse_clock
[[nodiscard]] std::optional<WrittenClock> parse_clock_loosely(std::string_view text);

/// Whether "-01:00" directly behind a time is the end of a range, and not an offset: offsets stand
/// behind dates that begin with the year, and are no quarter of an hour.
[[nodiscard]] bool is_at_end_of_range(std::string_view rest, TimeFormat format);

}  // namespace recald::table
