/// What the words of headers mean, in the languages that exports are written in: English, German,
/// French, Spanish, Italian, Dutch, Portuguese, Danish, Swedish, Finnish and Polish.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace recald::table {

/// The text in lower case, without accents and signs, its words set apart by one blank and with
/// one at each end: "MeterReading (Zähler-Nr.)" is " meter reading zaehler nr ".
[[nodiscard]] std::string folded(std::string_view text);

/// The letter or letters that a character is written with where there are no accents: "ae" for
/// "ä", "eur" for the euro sign, a blank for what is none.
[[nodiscard]] std::string_view plain_letters(std::uint32_t point);

/// Reads one character of UTF-8 from the front of `text`, or a byte of Latin-1 where it is none.
[[nodiscard]] std::uint32_t take_character(std::string_view& text);

/// A blank of any width: U+00A0, U+2009, U+202F and others.
[[nodiscard]] bool is_wide_blank(std::uint32_t point);

/// Marks that are not seen: of byte order, of the direction of writing, of zero width.
[[nodiscard]] bool is_unseen(std::uint32_t point);

enum class Meaning : std::uint16_t {
  time = 1,            ///< A date, a time or both.
  from = 2,            ///< The start of something.
  to = 4,              ///< The end.
  clock = 8,           ///< A time of day, or the number of an hour or interval.
  use = 16,            ///< Energy, power, consumption, the reading of a register.
  cost = 32,           ///< Money or what is asked for a unit.
  identifier = 64,     ///< Number of a meter, a place, a contract or a customer.
  meter = 128,         ///< What names a meter: a point, a channel, a series.
  tariff = 256,        ///< A period or a rate of a tariff.
  status = 512,        ///< Quality, method, remark.
  unit = 1024,         ///< The unit of something.
  other = 2048,        ///< Another quantity: temperature, voltage, reactive power, emissions.
  counts = 4096,       ///< The number of a row.
  date_part = 8192,    ///< A year, a month, a weekday.
  emission = 16384,    ///< Of carbon dioxide.
  other_time = 32768,  ///< When something was written, sent or changed.
};

class Meanings {
 public:
  void add(Meaning meaning) { bits_ |= static_cast<std::uint16_t>(meaning); }
  [[nodiscard]] bool has(Meaning meaning) const {
    return (bits_ & static_cast<std::uint16_t>(meaning)) != 0;
  }
  [[nodiscard]] bool has_any(std::initializer_list<Meaning> meanings) const {
    for (const Meaning meaning : meanings) {
      if (has(meaning)) return true;
    }
    return false;
  }

 private:
  std::uint16_t bits_ = 0;
};

/// All that the words of a header may mean; none if it has no known word.
[[nodiscard]] Meanings meanings_of(std::string_view header);

/// 1…12 by the beginning of a month's name; 0: no month. @param word  Letters without accents
[[nodiscard]] int month_named(std::string_view word);

/// Whether a word, without accents, is a day of the week or its usual beginning.
[[nodiscard]] bool is_weekday(std::string_view word);

/// Whether a cell is a word for "no value", of people or of devices: "n/a", "keine Daten",
/// "unavailable", "{fault}", "#N/A". A blank cell is one too.
[[nodiscard]] bool is_word_for_nothing(std::string_view cell);

}  // namespace recald::table
