#include "adapters/doe/design_month.hpp"

#include <charconv>

#include "core/metering/civil_time.hpp"

namespace recald::doe {

Result<DesignMonth> DesignMonth::parse(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc{} && end == text.data() + text.size() && 0 <= number && number <= 9999) {
    return DesignMonth{false, number};
  }
  if (const auto month = metering::parse_month(text)) {
    return DesignMonth{true, 12 * static_cast<int>(month->year()) +
                                 static_cast<int>(static_cast<unsigned>(month->month())) - 1};
  }
  return failure(ErrorCode::malformed, "month '" + std::string{text} +
                                           "' is neither YYYY-MM nor a number from 0 to 9999");
}

std::string DesignMonth::text() const {
  if (!is_calendar_) return std::to_string(order_);
  return metering::to_string(std::chrono::year{order_ / 12} /
                             std::chrono::month{static_cast<unsigned>(order_ % 12 + 1)});
}

}  // namespace recald::doe
