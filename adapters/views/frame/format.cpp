#include "adapters/views/frame/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace recald::views {
namespace {

constexpr const char* kDash = "–";

/// Decimals that leave four significant digits; none for 1000 and more.
int decimals_for(double magnitude) {
  if (magnitude == 0.0 || magnitude >= 1000.0) return 0;
  const int exponent = static_cast<int>(std::floor(std::log10(magnitude)));
  return std::min(3 - exponent, 9);
}

std::string with_thousands(std::string digits) {
  const std::size_t point = std::min(digits.find('.'), digits.size());
  for (std::size_t at = point; at > 3; at -= 3) {
    digits.insert(at - 3, 1, ',');
  }
  return digits;
}

/// A true minus sign, because a hyphen is easily overlooked and allows a line break.
std::string_view sign_text(double value) { return value < 0.0 ? "−" : ""; }

}  // namespace

std::string number_text(double value) {
  if (!std::isfinite(value)) return kDash;
  const double magnitude = std::abs(value);
  std::string digits = fmt::format("{:.{}f}", magnitude, decimals_for(magnitude));
  return fmt::format("{}{}", sign_text(value), with_thousands(std::move(digits)));
}

std::string number_text(std::optional<double> value) {
  return value ? number_text(*value) : std::string(kDash);
}

std::string amount_text(double si, const display::Unit& unit) {
  if (!std::isfinite(si)) return number_text(si);
  return number_text(unit.shown(si)) + "\u00a0" + unit.name;
}

std::string signed_amount_text(double si, const display::Unit& unit) {
  const double shown = unit.shown_difference(si);
  // Small units are whole numbers; in large ones a month may be less than one.
  const std::string number = std::abs(shown) < 10.0 ? number_text(shown) : count_text(shown);
  return (shown > 0.0 ? "+" : "") + number + "\u00a0" + unit.name;
}

std::string count_text(double count) {
  if (!std::isfinite(count)) return kDash;
  return fmt::format("{}{}", sign_text(count),
                     with_thousands(fmt::format("{:.0f}", std::abs(count))));
}

std::string percent_text(double share, int decimals) {
  if (!std::isfinite(share)) return kDash;
  return fmt::format("{}{:.{}f}\u00a0%", sign_text(share), std::abs(share) * 100.0, decimals);
}

std::string probability_text(double probability) {
  if (probability > 0.999) return "over 99.9\u00a0%";
  if (probability < 0.001) return "under 0.1\u00a0%";
  return percent_text(probability);
}

std::string signed_percent_text(double share) {
  if (!std::isfinite(share)) return kDash;
  return fmt::format("{}{}", share > 0.0 ? "+" : "", percent_text(share));
}

std::string month_name(unsigned month) {
  static constexpr std::array<const char*, 12> kNames{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                      "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  return month >= 1 && month <= 12 ? kNames[month - 1] : kDash;
}

std::string month_text(metering::Month month) {
  return fmt::format("{} {}", month_name(unsigned{month.month()}), int{month.year()});
}

std::string month_key(metering::Month month) {
  return fmt::format("{:04}-{:02}", int{month.year()}, unsigned{month.month()});
}

std::string month_text(metering::Month month, const std::string& number) {
  return number.empty() ? month_text(month) : "Month " + number;
}

std::string month_key(metering::Month month, const std::string& number) {
  return number.empty() ? month_key(month) : number;
}

std::string with_unit(const std::string& label, const std::string& unit) {
  return unit.empty() ? label : label + ", " + unit;
}

std::string day_key(metering::Day day) {
  return fmt::format("{:04}-{:02}-{:02}", int{day.year()}, unsigned{day.month()},
                     unsigned{day.day()});
}

std::string part_of_day_text(int part) {
  return fmt::format("{:02}–{:02} h", 4 * part, 4 * part + 4);
}

std::string local_text(metering::Instant t,
                       const std::optional<metering::LocalCalendar>& calendar) {
  const std::chrono::sys_days midnight = std::chrono::floor<std::chrono::days>(t);
  const metering::LocalTime local =
      calendar ? calendar->local_time(t)
               : metering::LocalTime{midnight, static_cast<int>((t - midnight).count() / 60)};
  return fmt::format("{} {:02}:{:02}", day_key(local.date), local.minute_of_day / 60,
                     local.minute_of_day % 60);
}

std::string part_of_week_text(int part) {
  static constexpr std::array<const char*, 7> kDays{"Sun", "Mon", "Tue", "Wed",
                                                    "Thu", "Fri", "Sat"};
  return fmt::format("{} {}", kDays.at(static_cast<std::size_t>(part / 6)),
                     part_of_day_text(part % 6));
}

std::string contraction_sentence(double contraction) {
  if (!std::isfinite(contraction)) return "How much the data say about this is not known.";
  if (contraction < -0.1) {
    return fmt::format(
        "The data left this wider than its prior: its variance grew by {}. Treat it with "
        "suspicion.",
        percent_text(-contraction, 0));
  }
  if (contraction < 0.1) return "The data say nothing about this: what you see is the prior.";
  if (contraction < 0.3) {
    return fmt::format("The data say little about this: they narrowed it by {} of its variance.",
                       percent_text(contraction, 0));
  }
  return fmt::format("The data narrowed this by {} of its variance.", percent_text(contraction, 0));
}

}  // namespace recald::views
