/// The parts of a written time, taken from the front of a text one after the other.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "adapters/table/cells/stamps.hpp"

namespace recald::table {

/// Reads a text from its front.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_{text} {}

  [[nodiscard]] bool is_done() const { return text_.empty(); }
  [[nodiscard]] char front() const { return text_.empty() ? '\0' : text_.front(); }
  [[nodiscard]] bool is_at_figure() const { return front() >= '0' && front() <= '9'; }
  [[nodiscard]] bool is_at_letter() const {
    return (front() >= 'A' && front() <= 'Z') || (front() >= 'a' && front() <= 'z');
  }
  [[nodiscard]] std::string_view rest() const { return text_; }

  bool take(char c) {
    if (front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool take(std::string_view sign) {
    if (text_.substr(0, sign.size()) != sign) return false;
    text_.remove_prefix(sign.size());
    return true;
  }

  void skip(std::string_view signs) {
    while (!text_.empty() && signs.find(text_.front()) != std::string_view::npos) {
      text_.remove_prefix(1);
    }
  }

  /// Up to `most` digits as a number, or nothing if there are none.
  std::optional<int> number(std::size_t most);
  [[nodiscard]] std::size_t digits() const { return digits_; }  ///< In the last number read.

  /// The letters at the front.
  std::string_view word();

 private:
  std::string_view text_;
  std::size_t digits_ = 0;
};

/// A date whose parts stand in the order of `format`. @return malformed if there is none
[[nodiscard]] std::optional<std::chrono::sys_days> take_date(Scanner& scan, TimeFormat format);

/// "14:15:00.0", "2:15 PM", "2:15 p. m.", "14.15", "1415". @return nothing for any other text
[[nodiscard]] std::optional<std::chrono::seconds> take_time(Scanner& scan);

/// "+01:00", "-0800", "+01". @return nothing for any other text, which then is not taken
/// @param hour_digits_min  1 takes "+1" too.
[[nodiscard]] std::optional<std::chrono::seconds> take_numeric_offset(Scanner& scan,
                                                                      std::size_t hour_digits_min);

/// The offset that the letters of a time zone stand for, in any case: "EDT", "CEST", "UTC".
[[nodiscard]] std::optional<std::chrono::seconds> offset_named(std::string_view letters);

}  // namespace recald::table
