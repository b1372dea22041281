#include "core/metering/zone_rule.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <utility>

namespace recald::metering {
namespace {

using std::chrono::days;
using std::chrono::seconds;
using std::chrono::sys_days;

/// A day of each year, and a time of the wall clock as the clock shows before it changes.
struct YearlyChange {
  enum class Day { of_month, without_leap_day, of_year } counted = Day::of_month;
  unsigned month = 0;    ///< 1…12
  unsigned week = 0;     ///< 1…5, the last
  unsigned weekday = 0;  ///< 0…6, from Sunday
  int day = 0;           ///< Of the year: from 1 without leap days, or else from 0.
  seconds time{7'200};

  [[nodiscard]] Instant wall_time(std::chrono::year year) const {
    const sys_days begin = year / std::chrono::January / 1;
    if (counted == Day::of_year) return begin + days{day} + time;
    if (counted == Day::without_leap_day) {
      const int leap_day = year.is_leap() && day >= 60 ? 1 : 0;
      return begin + days{day - 1 + leap_day} + time;
    }
    const auto at = year / std::chrono::month{month};
    const std::chrono::weekday wanted{weekday};
    return (week == 5 ? sys_days{at / wanted[std::chrono::last]} : sys_days{at / wanted[week]}) +
           time;
  }
};

/// Reads a rule from its beginning; what does not fit makes it fail for good.
class RuleText {
 public:
  explicit RuleText(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] bool is_at_end() const { return rest_.empty(); }
  [[nodiscard]] bool is_next(char c) const { return rest_.starts_with(c); }
  bool skip(char c) {
    if (!is_next(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char c) { failed_ = !skip(c) || failed_; }

  /// "CET" or "<+0330>"
  void name() {
    const auto end = is_next('<') ? rest_.find('>') : rest_.find_first_of("0123456789+-,");
    const auto length = end == std::string_view::npos ? rest_.size() : end;
    failed_ = failed_ || length < 3;
    rest_.remove_prefix(std::min(rest_.size(), is_next('<') ? length + 1 : length));
  }
  unsigned number(unsigned least, unsigned most) {
    unsigned value = 0;
    const auto read = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    failed_ = failed_ || read.ec != std::errc{} || value < least || value > most;
    rest_.remove_prefix(static_cast<std::size_t>(read.ptr - rest_.data()));
    return value;
  }
  /// "-1", "2:45", "+10:30:00"
  seconds time() {
    const bool is_negative = skip('-');
    if (!is_negative) skip('+');
    seconds value = std::chrono::hours{number(0, 167)};
    if (skip(':')) value += std::chrono::minutes{number(0, 59)};
    if (skip(':')) value += seconds{number(0, 59)};
    return is_negative ? -value : value;
  }
  /// "M3.5.0/-1", "J60", "0/0"
  YearlyChange change() {
    YearlyChange read;
    if (skip('M')) {
      read.month = number(1, 12);
      expect('.');
      read.week = number(1, 5);
      expect('.');
      read.weekday = number(0, 6);
    } else {
      const bool is_julian = skip('J');
      read.counted = is_julian ? YearlyChange::Day::without_leap_day : YearlyChange::Day::of_year;
      read.day = static_cast<int>(number(is_julian ? 1 : 0, 365));
    }
    if (skip('/')) read.time = time();
    return read;
  }

 private:
  std::string_view rest_;
  bool failed_ = false;
};

}  // namespace

// The zone library reads the same file for LocalCalendar::open, and keeps its rule to itself.
std::string zone_rule_of(const std::string& zone_name) {
  std::ifstream in{"/usr/share/zoneinfo/" + zone_name, std::ios::binary};
  const std::string bytes{std::istreambuf_iterator<char>{in}, {}};
  const bool has_rule = bytes.starts_with("TZif") && bytes.size() > 4 && bytes[4] >= '2';
  if (!has_rule || !bytes.ends_with('\n')) return {};
  const auto begin = bytes.rfind('\n', bytes.size() - 2);
  return bytes.substr(begin + 1, bytes.size() - begin - 2);
}

std::vector<OffsetChange> zone_rule_changes(std::string_view rule) {
  RuleText text{rule};
  text.name();
  const seconds standard = -text.time();
  if (text.failed() || text.is_at_end()) return {};
  text.name();
  const seconds summer = text.is_next(',') ? standard + std::chrono::hours{1} : -text.time();
  text.expect(',');
  const YearlyChange to_summer = text.change();
  text.expect(',');
  const YearlyChange to_standard = text.change();
  if (text.failed() || !text.is_at_end()) return {};
  std::vector<OffsetChange> changes;
  for (auto year = kFirstKnownYear; year <= kLastKnownYear; ++year) {
    changes.push_back({to_summer.wall_time(year) - standard, summer});
    changes.push_back({to_standard.wall_time(year) - summer, standard});
  }
  std::ranges::stable_sort(changes, {}, &OffsetChange::at);
  return changes;
}

}  // namespace recald::metering
