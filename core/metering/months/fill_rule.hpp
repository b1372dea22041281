/// How slots without measurements are estimated: the rule a site chooses, and the method used.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace recald::metering {

enum class FillRule : std::uint8_t {
  same_time,     ///< Mean of the same time of day in the same month, for any gap (the seed).
  linear_short,  ///< A straight line across gaps up to `line_max`, same_time beyond.
};
inline constexpr std::array<std::string_view, 2> kFillRules = {"same_time", "linear_short"};

/// How a slot's energy was determined.
enum class FillMethod : std::uint8_t {
  none,                 ///< Measured, or unknown.
  same_time,            ///< Mean of the same time of day in the same month (the seed).
  same_time_like_days,  ///< … over days of the same type, working or not.
  neighbouring_times,   ///< Fewer than three such days: one interval before and after as well.
  month_mean,           ///< Nothing measured near that time of day in the month.
  line,                 ///< Straight line between the good neighbours of a short gap.
};

}  // namespace recald::metering
