/// Dates that a calendar rule marks, looked up hour by hour.
#pragma once

#include <chrono>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::diagnosis {

/// Marked days of all years that recald accepts.
class DateTable {
 public:
  static constexpr int kFirstYear = static_cast<int>(metering::kFirstKnownYear);
  static constexpr int kLastYear = static_cast<int>(metering::kLastKnownYear);

  void mark(metering::Day first, metering::Day last) {
    for (auto day = std::chrono::sys_days{first}; day <= std::chrono::sys_days{last};
         day += std::chrono::days{1}) {
      const auto at = (day - origin()).count();
      if (0 <= at && at < static_cast<long>(marked_.size())) {
        marked_[static_cast<std::size_t>(at)] = true;
      }
    }
  }
  void mark(metering::Day day) { mark(day, day); }

  [[nodiscard]] bool contains(metering::Day day) const {
    const auto at = (std::chrono::sys_days{day} - origin()).count();
    return 0 <= at && at < static_cast<long>(marked_.size()) &&
           marked_[static_cast<std::size_t>(at)];
  }

 private:
  static constexpr std::chrono::sys_days origin() {
    return std::chrono::year{kFirstYear} / std::chrono::January / 1;
  }
  std::vector<bool> marked_ = std::vector<bool>(366 * (kLastYear - kFirstYear + 1), false);
};

/// @see Meeus (1991), Astronomical Algorithms, chapter 8: Gregorian Easter Sunday. 2024: 31 March.
[[nodiscard]] constexpr std::chrono::sys_days easter_sunday(std::chrono::year year) {
  const int y = static_cast<int>(year);
  const int a = y % 19, b = y / 100, c = y % 100;
  const int h = (19 * a + b - b / 4 - (b - (b + 8) / 25 + 1) / 3 + 15) % 30;
  const int l = (32 + 2 * (b % 4) + 2 * (c / 4) - h - c % 4) % 7;
  const int m = (a + 11 * h + 22 * l) / 451;
  const int day_from_march = h + l - 7 * m + 114;
  return year / (day_from_march / 31) / (day_from_march % 31 + 1);
}

}  // namespace recald::diagnosis
