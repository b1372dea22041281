/// The months of a design: calendar months, or the numbers 1, 2, … of months that have no calendar.
#pragma once

#include <compare>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace recald::doe {

/// Ordered by time. A folder uses only one of the two kinds.
class DesignMonth {
 public:
  /// "2016-03", or a whole number such as "3". @return malformed for anything else.
  [[nodiscard]] static Result<DesignMonth> parse(std::string_view text);

  [[nodiscard]] bool is_calendar() const { return is_calendar_; }
  /// "2016-03" or "3".
  [[nodiscard]] std::string text() const;

  auto operator<=>(const DesignMonth&) const = default;

 private:
  DesignMonth(bool is_calendar, int order) : is_calendar_{is_calendar}, order_{order} {}

  bool is_calendar_;
  int order_;  ///< Months since year 0, or the number itself.
};

}  // namespace recald::doe
