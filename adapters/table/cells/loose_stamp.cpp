#include "adapters/table/cells/loose_stamp.hpp"

#include <algorithm>
#include <array>

#include "adapters/table/cells/stamp_parts.hpp"
#include "adapters/table/cells/words.hpp"
#include "core/text/ascii.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::days;
using std::chrono::seconds;

constexpr seconds kRangeMax{7200};  // of a range of times of day

/// Letters without accents, blanks of one kind, "~" for what is longer than a hyphen; nothing
/// that is not seen, no quotes.
class PlainText {
 public:
  explicit PlainText(std::string_view text) {
    while (!text.empty() && fits_) add(take_character(text));
    Scanner scan{std::string_view{letters_.data(), size_}};
    scan.skip(" ");
    text_ = scan.rest();
    while (!text_.empty() && text_.back() == ' ') text_.remove_suffix(1);
    if (!fits_) text_ = {};
  }
  PlainText(const PlainText&) = delete;
  PlainText& operator=(const PlainText&) = delete;

  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  void add(std::uint32_t point) {
    const bool is_quote = point == '"' || point == '\'' || point == '`' || point == 0xAB ||
                          point == 0xBB || (point >= 0x2018 && point <= 0x201F);
    const bool is_long_dash = (point >= 0x2012 && point <= 0x2015) || point == 0x2192;
    if (is_quote) return;
    if (is_long_dash) return add(std::string_view{"~"});
    if (point == 0x2010 || point == 0x2011 || point == 0x2212) return add(std::string_view{"-"});
    if (point < 0x20 || point == '=' || is_wide_blank(point)) return add(std::string_view{" "});
    if (point >= 0x80) return add(plain_letters(point));
    const char c = static_cast<char>(point);
    add(std::string_view{&c, 1});
  }

  void add(std::string_view letters) {
    fits_ = fits_ && size_ + letters.size() <= letters_.size();
    if (!fits_) return;
    std::copy(letters.begin(), letters.end(),
              letters_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += letters.size();
  }

  std::array<char, 128> letters_{};
  std::size_t size_ = 0;
  bool fits_ = true;
  std::string_view text_;
};

template <std::size_t N>
bool is_among(const std::array<std::string_view, N>& words, std::string_view word) {
  const std::string lower = to_lower(word.substr(0, 15));
  return std::find(words.begin(), words.end(), lower) != words.end();
}

constexpr auto kBefore = std::to_array<std::string_view>(
    {"from", "between", "von",   "vom",  "zwischen", "du",  "de",
     "del",  "desde",   "entre", "dal",  "dalle",    "van", "vanaf",
     "das",  "fra",     "fraan", "fran", "mellem",   "od",  "feira"});
constexpr auto kBetween = std::to_array<std::string_view>(
    {"to",  "until", "till", "thru", "through", "and", "bis", "und", "a",
     "au",  "et",    "al",   "alle", "hasta",   "y",   "e",   "tot", "en",
     "ate", "as",    "til",  "og",   "och",     "do",  "i",   "ja"});
constexpr auto kBeforeTime = std::to_array<std::string_view>(
    {"t", "at", "um", "a", "as", "la", "las", "om", "kl", "klo", "o", "godz", "alle", "ore", "h"});
constexpr auto kAfterTime =
    std::to_array<std::string_view>({"uhr", "h", "hrs", "hours", "godz", "uur"});

/// Takes words of one kind, and what is between them.
template <std::size_t N>
void skip_words(Scanner& scan, const std::array<std::string_view, N>& words) {
  while (scan.is_at_letter()) {
    Scanner ahead = scan;
    if (!is_among(words, ahead.word())) return;
    ahead.skip(" .,:");
    scan = ahead;
  }
}

/// @param letters_min  Two letters are a day only in front: "to" is one in Danish.
void skip_weekday(Scanner& scan, std::size_t letters_min) {
  Scanner ahead = scan;
  const bool is_in_brackets = ahead.take('(');
  const std::string day = to_lower(ahead.word().substr(0, 15));
  if (day.size() < letters_min || !is_weekday(day)) return;
  if (is_in_brackets && !ahead.take(')')) return;
  ahead.skip(" .,-");
  scan = ahead;
}

void skip_brackets(Scanner& scan) {
  scan.skip(" ");
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    const std::size_t end = scan.rest().find(close);
    if (scan.front() == open && end != std::string_view::npos) {
      scan = Scanner{scan.rest().substr(end + 1)};
    }
  }
}

/// A time and the zone behind it.
struct TimeWithZone {
  seconds time{0};
  std::optional<seconds> utc_offset;
  bool is_zone_named = false;
  bool is_hour = false;
};

/// An offset or letters of a zone; other text stays where it is.
void take_zone(Scanner& scan, TimeWithZone& time, TimeFormat format, bool is_iso) {
  if (!is_iso && is_at_end_of_range(scan.rest(), format)) return;
  scan.skip(" ");
  if (const auto offset = take_numeric_offset(scan, 2)) {
    time.utc_offset = offset;
    return skip_brackets(scan);
  }
  Scanner ahead = scan;
  const std::string_view letters = ahead.word();
  const auto offset = letters.empty() ? std::nullopt : offset_named(letters);
  if (!offset) return;
  time.utc_offset = offset;
  const std::string name = to_lower(letters);
  const bool is_universal = name == "utc" || name == "gmt" || name == "z" || name == "ut";
  time.is_zone_named = !is_universal;
  scan = ahead;
  if (is_universal) {
    if (const auto more = take_numeric_offset(scan, 1)) time.utc_offset = more;
  }
  skip_brackets(scan);
}

/// An hour without minutes, which nothing but a zone or an end may follow.
std::optional<seconds> take_hour(Scanner& scan) {
  const auto hour = scan.number(2);
  if (!hour || *hour > 24 || scan.is_at_figure()) return {};
  return std::chrono::hours{*hour};
}

std::optional<TimeWithZone> take_clock(Scanner& scan, TimeFormat format, bool is_iso) {
  skip_words(scan, kBeforeTime);
  TimeWithZone clock;
  Scanner ahead = scan;
  auto time = take_time(ahead);
  if (!time) {
    ahead = scan;
    time = take_hour(ahead);
    clock.is_hour = true;
  }
  if (!time) return {};
  clock.time = *time;
  scan = ahead;
  scan.skip(" ");
  skip_words(scan, kAfterTime);
  take_zone(scan, clock, format, is_iso);
  return clock;
}

WrittenTime joined(std::chrono::sys_days date, const std::optional<TimeWithZone>& clock) {
  WrittenTime written{.clock = Instant{date}, .has_time = clock.has_value()};
  if (!clock) return written;
  written.clock += clock->time;
  written.utc_offset = clock->utc_offset;
  written.is_zone_named = clock->is_zone_named;
  return written;
}

/// A date with or without a time, whichever comes first.
/// @param may_be_weekday  Of the word in front: "mar" is March, or Tuesday in three languages.
std::optional<WrittenTime> take_moment(Scanner& scan, TimeFormat format, bool may_be_weekday) {
  skip_words(scan, kBefore);
  if (may_be_weekday) skip_weekday(scan, 2);
  skip_words(scan, kBefore);
  std::optional<TimeWithZone> clock;
  Scanner ahead = scan;
  if (const auto first = take_time(ahead); first && ahead.front() == ' ') {
    ahead.skip(" ,");
    Scanner behind = ahead;
    if (take_date(behind, format)) {
      clock = TimeWithZone{.time = *first};
      scan = ahead;
    }
  }
  const auto date = take_date(scan, format);
  if (!date) return {};
  if (clock) return joined(*date, clock);
  const bool is_iso = scan.take('T');
  scan.skip(" ,");
  skip_weekday(scan, 3);
  ahead = scan;
  clock = take_clock(ahead, format, is_iso);
  if (clock) scan = ahead;
  return joined(*date, clock);
}

bool take_range_sign(Scanner& scan) {
  scan.skip(" ");
  for (const std::string_view sign : {"~", "-->", "->", "--", "..", "-", "/", ">"}) {
    if (!scan.take(sign)) continue;
    scan.skip(" ");
    return true;
  }
  Scanner ahead = scan;
  if (!ahead.is_at_letter() || !is_among(kBetween, ahead.word())) return false;
  ahead.skip(" ");
  scan = ahead;
  return true;
}

/// Whether the text is the end of a range that begins at `first`: a later stamp, a time, or the
/// duration of ISO 8601.
bool is_range_end(Scanner scan, const WrittenTime& first, TimeFormat format) {
  if (scan.take('P')) return !scan.is_done() && scan.rest().find(' ') == std::string_view::npos;
  skip_words(scan, kBetween);
  Scanner as_stamp = scan;
  const auto second = take_moment(as_stamp, format, true);
  if (second && as_stamp.is_done()) {
    return second->clock + std::chrono::hours{2} > first.clock &&
           second->clock <= first.clock + days{366};
  }
  return first.has_time && take_clock(scan, format, false) && scan.is_done();
}

LooseStamp read_stamp(std::string_view text, TimeFormat format, bool may_be_weekday) {
  Scanner scan{text};
  auto first = take_moment(scan, format, may_be_weekday);
  if (!first) return {};
  scan.skip(" ");
  if (scan.is_done()) return {first, ""};
  const std::string_view rest = scan.rest();
  if (take_range_sign(scan) && is_range_end(scan, *first, format)) {
    first->is_range = true;
    return {first, ""};
  }
  const bool is_word = std::all_of(rest.begin(), rest.end(), [](char c) {
    return (to_lower(c) >= 'a' && to_lower(c) <= 'z') || c == '/' || c == '_' || c == ' ';
  });
  return {{}, is_word && first->has_time ? std::string{rest} : ""};
}

/// "00-01", "23 - 24": the hours that follow each other.
std::optional<WrittenClock> read_hours(std::string_view text) {
  Scanner scan{text};
  const auto first = take_hour(scan);
  if (!first) return {};
  WrittenClock clock{.time = *first, .utc_offset = {}, .is_hour = true};
  scan.skip(" ");
  if (scan.is_done()) return clock;
  if (!take_range_sign(scan)) return {};
  const auto second = take_hour(scan);
  const seconds next = *first + std::chrono::hours{1};
  if (!second || !scan.is_done() || (*second != next && *second + days{1} != next)) return {};
  clock.is_range = true;
  return clock;
}

}  // namespace

bool is_at_end_of_range(std::string_view rest, TimeFormat format) {
  Scanner scan{rest};
  if (!scan.take('-')) return false;
  const auto hour = scan.number(2);
  if (!hour || !scan.take(':')) return false;
  const auto minute = scan.number(2);
  if (!minute || scan.digits() != 2) return false;
  if (format != TimeFormat::year_first || *hour > 12) return true;
  return (*hour == 0 && *minute != 0) || (*minute != 0 && *minute != 30);
}

LooseStamp parse_loosely(std::string_view text, TimeFormat format) {
  const auto figures =
      std::count_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (figures < 4) return {};
  const PlainText plain{text};
  LooseStamp found = read_stamp(plain.text(), format, false);
  if (found.time || !found.odd_end.empty()) return found;
  return read_stamp(plain.text(), format, true);
}

std::optional<WrittenClock> parse_clock_loosely(std::string_view text) {
  const PlainText plain{text};
  if (const auto hour = read_hours(plain.text())) return hour;
  Scanner scan{plain.text()};
  skip_words(scan, kBefore);
  const auto first = take_clock(scan, TimeFormat::day_first, false);
  if (!first || first->is_hour) return {};
  WrittenClock clock{first->time, first->utc_offset, false, first->is_zone_named};
  scan.skip(" ");
  if (scan.is_done()) return clock;
  if (!take_range_sign(scan)) return {};
  skip_words(scan, kBetween);
  clock.is_range = true;
  const auto end = take_clock(scan, TimeFormat::day_first, false);
  if (!end || !scan.is_done()) return {};
  // A longer one may be an offset: 00:15:00-05:00.
  const seconds length = (end->time - first->time + days{1}) % days{1};
  return length > seconds{0} && length <= kRangeMax ? std::optional{clock} : std::nullopt;
}

bool says_winter_time(std::string_view header) {
  constexpr std::array<std::string_view, 20> kWords{
      " standard time ",  " winter time ",      " wintertime ",    " winterzeit ",
      " normalzeit ",     " heure d hiver ",    " heure hiver ",   " heure normale ",
      " heure standard ", " hora de invierno ", " hora estandar ", " hora de inverno ",
      " hora padrao ",    " ora solare ",       " wintertijd ",    " standaardtijd ",
      " vintertid ",      " normaltid ",        " talviaika ",     " czas zimowy "};
  const std::string words = folded(header);
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](std::string_view word) { return words.find(word) != std::string::npos; });
}

std::optional<seconds> offset_said(std::string_view header) {
  const std::string words = folded(header);
  const std::string lower = to_lower(header);
  for (const std::string word : {"utc", "gmt", "zulu"}) {
    const std::size_t at = lower.find(word);
    if (at == std::string::npos || words.find(" " + word + " ") == std::string::npos) continue;
    Scanner scan{header.substr(at + word.size())};
    scan.skip(" ");
    return take_numeric_offset(scan, 1).value_or(seconds{0});
  }
  return {};
}

}  // namespace recald::table
