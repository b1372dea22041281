#include "adapters/epw/epw.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/line_reader.hpp"

namespace recald::epw {
namespace {

using csv::FieldSplitter;
using csv::in_quotes;
using metering::Instant;
using std::chrono::seconds;
using weather::kWeatherVariables;
using weather::ValuesStand;
using weather::WeatherHour;
using weather::WeatherRecord;
using weather::WeatherVariable;

constexpr std::array<std::string_view, 8> kHeaderLines{"LOCATION",
                                                       "DESIGN CONDITIONS",
                                                       "TYPICAL/EXTREME PERIODS",
                                                       "GROUND TEMPERATURES",
                                                       "HOLIDAYS/DAYLIGHT SAVINGS",
                                                       "COMMENTS 1",
                                                       "COMMENTS 2",
                                                       "DATA PERIODS"};
constexpr std::size_t kFieldsNeeded = 22;  // up to wind speed; the rest is not used
constexpr int kLeapYear = 2000;
constexpr int kPlainYear = 2001;

/// A field of a row: its place, its variable, and the code from which on it is missing.
struct Field {
  std::size_t place;
  double missing_from;
  std::size_t variable;  ///< Of `kWeatherVariables`.
};
constexpr std::array<Field, kWeatherVariables.size()> kFields{{
    {6, 99.9, 0},
    {8, 999.0, 1},
    {21, 999.0, 2},
    {20, 999.0, 3},
    {13, 9999.0, 4},
    {14, 9999.0, 5},
    {15, 9999.0, 6},
    {9, 999999.0, 7},
}};
constexpr double kCodeMax = 1e6;  // of something missing: they are nines, 999999 at most
constexpr std::size_t kHumidity = 1;
/// More hours than these are no outliers, but a column in another unit or of another meaning.
constexpr double kImpossibleShareMax = 0.05;

std::string at_line(std::string_view name, std::uint64_t line) {
  return in_quotes(name) + " line " + std::to_string(line) + ": ";
}

/// The hour that the next row must be; this check shows whether rows are missing.
struct YearHour {
  int month;
  int day;
  int hour;  // 1…24
  bool operator==(const YearHour&) const = default;
};

std::string in_words(const YearHour& at) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "month %d, day %d, hour %d", at.month, at.day, at.hour);
  return text.data();
}

YearHour hour_after(YearHour at, bool leap_day) {
  if (++at.hour <= 24) return at;
  at.hour = 1;
  const auto year = std::chrono::year{leap_day ? kLeapYear : kPlainYear};
  if (++at.day <= metering::days_in(year / at.month)) return at;
  at.day = 1;
  ++at.month;
  return at;
}

std::optional<int> whole_number(std::string_view text) {
  const auto value = csv::parse_number(csv::trimmed(text));
  if (!value || *value != std::floor(*value) || std::abs(*value) > 1e6) return {};
  return static_cast<int>(*value);
}

class EpwReader {
 public:
  EpwReader(csv::ByteSource source, std::string_view name, weather::RecordedValues values)
      : lines_{std::move(source)},
        name_{name},
        stand_{values == weather::RecordedValues::instant ? ValuesStand::at_its_end
                                                          : ValuesStand::over_the_record} {}

  Result<EpwWeather> run(std::optional<int> year) {
    TRY(read_headers());
    TRY(read_rows());
    if (next_.month <= 12) return ends_early();
    TRY(check_possible());
    return lay_on(year);
  }

 private:
  struct Impossible {
    int hours = 0;
    std::string first = {};
    std::uint64_t line = 0;
  };
  struct Row {
    YearHour at;
    WeatherHour values;
  };

  Result<bool> read_headers() {
    for (const std::string_view expected : kHeaderLines) {
      const bool more = lines_.next(line_);
      if (lines_.error()) return tl::unexpected(*lines_.error());
      const bool found = more && line_.text.substr(0, expected.size()) == expected;
      if (!found) {
        return failure(ErrorCode::malformed,
                       at_line(name_, more ? line_.number : line_.number + 1) +
                           "this header line of an EPW file must begin with '" +
                           std::string{expected} + "'");
      }
      const std::size_t count = fields_.split(line_.text);
      if (expected == "LOCATION") {
        if (const auto location = read_location(count); !location) return location;
      }
      if (expected == "DATA PERIODS" && (count < 3 || whole_number(fields_[2]) != 1)) {
        return failure(ErrorCode::unsupported, at_line(name_, line_.number) +
                                                   "only files with one record an hour are read");
      }
    }
    return true;
  }

  Result<bool> read_location(std::size_t count) {
    EpwLocation& place = weather_.location;
    std::array<double, 4> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto number =
          count < 10 ? std::nullopt : csv::parse_number(csv::trimmed(fields_[6 + i]));
      if (!number) {
        return failure(ErrorCode::malformed,
                       at_line(name_, line_.number) +
                           "LOCATION must give latitude, longitude, UTC offset and elevation");
      }
      numbers[i] = *number;
    }
    place = {std::string{fields_[1]},
             std::string{fields_[3]},
             numbers[0],
             numbers[1],
             numbers[2],
             numbers[3]};
    typical_source_ = fields_[4].find("TMY") != std::string_view::npos ||
                      fields_[4].find("IWEC") != std::string_view::npos;
    if (std::abs(place.latitude_deg) > 90.0 || std::abs(place.longitude_deg) > 180.0 ||
        std::abs(place.utc_offset_h) > 14.0) {
      return failure(ErrorCode::malformed,
                     at_line(name_, line_.number) + "LOCATION is not a place on Earth");
    }
    return true;
  }

  Result<bool> read_rows() {
    while (lines_.next(line_)) {
      if (csv::trimmed(line_.text).empty() && !line_.too_long) continue;
      const std::size_t count = fields_.split(line_.text);
      // A row cut off by the end of the file does not count; missing rows are reported below.
      if (!line_.terminated && count <= kFieldsNeeded) return true;
      if (count < kFieldsNeeded || count > FieldSplitter::kFieldsMax) {
        return failure(ErrorCode::malformed, at_line(name_, line_.number) +
                                                 "an hour has at least 22 fields, this one " +
                                                 std::to_string(count));
      }
      if (const auto row = read_row(); !row) return row;
    }
    if (lines_.error()) return tl::unexpected(*lines_.error());
    return true;
  }

  Result<bool> read_row() {
    const auto year = whole_number(fields_[0]);
    const auto month = whole_number(fields_[1]);
    const auto day = whole_number(fields_[2]);
    const auto hour = whole_number(fields_[3]);
    if (!year || !month || !day || !hour) {
      return failure(ErrorCode::malformed, at_line(name_, line_.number) +
                                               "year, month, day and hour must be whole numbers");
    }
    const YearHour at{*month, *day, *hour};
    if (next_ == YearHour{3, 1, 1} && at == YearHour{2, 29, 1}) {
      weather_.leap_day = true;
      next_ = at;
    }
    if (next_.month > 12 || at != next_) {
      return failure(ErrorCode::malformed,
                     at_line(name_, line_.number) + "found " + in_words(at) + ", expected " +
                         (next_.month > 12 ? "the end of the file" : in_words(next_)));
    }
    next_ = hour_after(next_, weather_.leap_day);
    if (!first_year_) first_year_ = *year;
    several_years_ = several_years_ || *year != *first_year_;
    Row row{at, {}};
    for (const Field& field : kFields) {
      const auto value = csv::parse_number(csv::trimmed(fields_[field.place]));
      if (!value) {
        return failure(ErrorCode::malformed,
                       at_line(name_, line_.number) + "field " + std::to_string(field.place + 1) +
                           " " + in_quotes(fields_[field.place]) + " is not a number");
      }
      if (*value < field.missing_from || *value > kCodeMax) put(field, *value, row.values);
    }
    rows_.push_back(row);
    return true;
  }

  void put(const Field& field, double value, WeatherHour& values) {
    const WeatherVariable& variable = kWeatherVariables[field.variable];
    Impossible& impossible = impossible_[field.variable];
    if (!variable.is_possible(value)) {
      if (impossible.hours++ == 0) {
        impossible.first = std::string{csv::trimmed(fields_[field.place])};
        impossible.line = line_.number;
      }
      return;
    }
    if (field.variable == kHumidity && value > variable.high) ++weather_.humidity_clipped;
    values.*variable.member = std::clamp(value, variable.low, variable.high);
  }

  /// Values that cannot occur are absent; where there are many, nothing of the file is believed.
  Result<void> check_possible() {
    for (std::size_t v = 0; v < impossible_.size(); ++v) {
      const Impossible& one = impossible_[v];
      if (one.hours == 0) continue;
      const WeatherVariable& variable = kWeatherVariables[v];
      std::array<char, 200> words{};
      std::snprintf(
          words.data(), words.size(),
          "%.*s lies between %g and %g, and %d of %zu hours have other values, the first ",
          static_cast<int>(variable.name.size()), variable.name.data(), variable.low, variable.high,
          one.hours, rows_.size());
      const std::string sentence =
          words.data() + in_quotes(one.first) + " on line " + std::to_string(one.line);
      if (one.hours > kImpossibleShareMax * static_cast<double>(rows_.size())) {
        return failure(ErrorCode::invalid_value,
                       in_quotes(name_) + ": " + sentence +
                           "; is the column in another unit (°F, kPa)? What was not measured has a "
                           "code in EPW, such as 99.9 or 999999");
      }
      weather_.notes.push_back(sentence + "; they are taken as not measured");
    }
    return {};
  }

  [[nodiscard]] tl::unexpected<Error> ends_early() const {
    const std::size_t expected = weather_.leap_day ? 8784 : 8760;
    return failure(ErrorCode::not_enough_data,
                   in_quotes(name_) + " ends early: the first missing hour is " + in_words(next_) +
                       "; " + std::to_string(rows_.size()) + " of " + std::to_string(expected) +
                       " hours are there");
  }

  Result<EpwWeather> lay_on(std::optional<int> wanted) {
    weather_.year = wanted.value_or(*first_year_);
    weather_.typical = several_years_ || typical_source_;
    if (weather_.year < 1972 || weather_.year > 2036) {
      return failure(ErrorCode::out_of_range,
                     in_quotes(name_) + ": year " + std::to_string(weather_.year) +
                         " lies outside 1972 to 2036; ask for the year to lay the weather on");
    }
    if (!weather_.typical && weather_.year != *first_year_) {
      weather_.notes.push_back("measured in " + std::to_string(*first_year_) + " but laid on " +
                               std::to_string(weather_.year));
    }
    if (weather_.humidity_clipped > 0) {
      weather_.notes.push_back(std::to_string(weather_.humidity_clipped) +
                               " hours with a relative humidity above 100 % were set to 100 %");
    }
    const std::vector<WeatherRecord> records = records_of_year();
    weather_.series = TRY(weather::to_hourly(records, std::chrono::hours{1}, stand_));
    return std::move(weather_);
  }

  std::vector<WeatherRecord> records_of_year() {
    const auto year = std::chrono::year{weather_.year};
    if (year.is_leap() && !weather_.leap_day) repeat_28_february();
    if (!year.is_leap() && weather_.leap_day) drop_29_february();
    const seconds offset{std::lround(weather_.location.utc_offset_h * 3600.0)};
    Instant start = Instant{std::chrono::sys_days{year / 1 / 1}} - offset;
    std::vector<WeatherRecord> records;
    records.reserve(rows_.size());
    for (const Row& row : rows_) {
      records.push_back({start, row.values});
      start += std::chrono::hours{1};
    }
    return records;
  }

  void repeat_28_february() {
    const auto first = std::find_if(rows_.begin(), rows_.end(), [](const Row& row) {
      return row.at == YearHour{2, 28, 1};
    });
    const std::vector<Row> day(first, first + 24);
    rows_.insert(first + 24, day.begin(), day.end());
    weather_.notes.push_back("the file has no 29 February: the 28th stands for it");
  }

  void drop_29_february() {
    std::erase_if(rows_, [](const Row& row) { return row.at.month == 2 && row.at.day == 29; });
    weather_.notes.push_back(
        "29 February of the file is left out: " + std::to_string(weather_.year) + " has none");
  }

  csv::LineReader lines_;
  std::string name_;
  ValuesStand stand_;
  csv::Line line_{};
  FieldSplitter fields_;
  EpwWeather weather_{};
  std::vector<Row> rows_;
  std::array<Impossible, kWeatherVariables.size()> impossible_{};
  YearHour next_{1, 1, 1};
  std::optional<int> first_year_;
  bool several_years_ = false;
  bool typical_source_ = false;
};

}  // namespace

Result<EpwWeather> read_epw(const std::filesystem::path& file, std::optional<int> year,
                            weather::RecordedValues values) {
  auto source = TRY(csv::open_file(file, "EPW file"));
  return EpwReader{std::move(source), file.string(), values}.run(year);
}

Result<EpwWeather> read_epw_text(std::string_view text, std::string_view name,
                                 std::optional<int> year, weather::RecordedValues values) {
  return EpwReader{csv::bytes_of(text), name, values}.run(year);
}

}  // namespace recald::epw
