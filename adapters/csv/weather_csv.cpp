#include "adapters/csv/weather_csv.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/line_reader.hpp"

namespace recald::csv {
namespace {

using metering::Instant;
using std::chrono::seconds;
using weather::kWeatherVariables;
using weather::WeatherHour;
using weather::WeatherRecord;

constexpr std::string_view kWeatherHeader =
    "timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2";
constexpr std::size_t kDryBulb = 0;  // index in kWeatherVariables
constexpr std::string_view kDryBulbF = "dry_bulb_F";
constexpr seconds kStepToInfer{1800};

/// The file's column for each variable; absent if the file lacks it.
using WeatherColumns = std::array<std::optional<std::size_t>, kWeatherVariables.size()>;

class WeatherReader {
 public:
  WeatherReader(ByteSource source, std::string_view name, const WeatherCsvOptions& options)
      : lines_{std::move(source)}, name_{name}, options_{options} {
    csv_.issues.listed_max = options.issues_listed_max;
  }

  Result<WeatherCsv> run() {
    Line line{};
    while (lines_.next(line)) {
      if (line.text.empty() && !line.too_long) continue;
      if (!line.text.empty() && line.text.front() == '#') continue;
      if (column_count_ > 0) {
        read_line(line);
      } else if (const auto header = read_header(line.text); !header) {
        return tl::unexpected(header.error());
      }
    }
    if (lines_.error()) return tl::unexpected(*lines_.error());
    if (column_count_ == 0) return wrong_header("", " (the file is empty)");
    return finish();
  }

 private:
  [[nodiscard]] tl::unexpected<Error> wrong_header(std::string_view header,
                                                   const std::string& why) const {
    return failure(ErrorCode::malformed, in_quotes(name_) + ": the header must be like '" +
                                             std::string{kWeatherHeader} + "' but is " +
                                             in_quotes(header.substr(0, 120)) + why);
  }

  Result<bool> read_header(std::string_view header) {
    if (header.find(';') != std::string_view::npos) {
      return wrong_header(header, "; separate fields by commas, not semicolons");
    }
    const std::size_t count = fields_.split(header);
    if (count == 0 || count > FieldSplitter::kFieldsMax || trimmed(fields_[0]) != "timestamp") {
      return wrong_header(header, "");
    }
    for (std::size_t i = 1; i < count; ++i) {
      const std::string_view column = trimmed(fields_[i]);
      const bool is_fahrenheit = column == kDryBulbF;
      const std::string_view name = is_fahrenheit ? kWeatherVariables[kDryBulb].name : column;
      const auto known = std::find_if(kWeatherVariables.begin(), kWeatherVariables.end(),
                                      [&](const auto& v) { return v.name == name; });
      if (known == kWeatherVariables.end()) {
        csv_.ignored_columns.push_back(printable(column));
        continue;
      }
      auto& place = columns_[static_cast<std::size_t>(known - kWeatherVariables.begin())];
      if (place) return wrong_header(header, "; column " + in_quotes(column) + " comes twice");
      place = i;
      in_fahrenheit_ |= is_fahrenheit;
    }
    if (!columns_[kDryBulb]) {
      return wrong_header(header, "; dry_bulb_C (or dry_bulb_F) is missing");
    }
    column_count_ = count;
    return true;
  }

  void read_line(const Line& line) {
    ++csv_.rows;
    if (line.too_long) return bad(line.number, "longer than 64 KiB");
    const std::size_t count = fields_.split(line.text);
    if (count != column_count_) {
      return bad(line.number, count == 0 ? "a quote is not closed"
                                         : std::to_string(count) + " fields instead of " +
                                               std::to_string(column_count_));
    }
    if (!line.terminated) {
      return bad(line.number, "the last line has no line end and may be cut; it is kept out");
    }
    const auto stamp = parse_timestamp(fields_[0]);
    if (!stamp) return bad(line.number, stamp.error().message);
    WeatherRecord record{*stamp, {}};
    for (std::size_t v = 0; v < columns_.size(); ++v) {
      if (!columns_[v]) continue;
      if (!read_value(line.number, v, trimmed(fields_[*columns_[v]]), record.values)) return;
    }
    if (!records_.empty() && record.start == records_.back().start) {
      return bad(line.number,
                 metering::to_string(record.start) + " comes twice; the first row stays");
    }
    if (!records_.empty() && record.start < records_.back().start) {
      bad(line.number, metering::to_string(record.start) + " comes after a later row; sorted");
    }
    records_.push_back(record);
  }

  /// False: do not trust the whole line. A single impossible value becomes a blank instead.
  bool read_value(std::uint64_t line, std::size_t variable, std::string_view text,
                  WeatherHour& values) {
    if (text.empty()) return true;
    const bool is_fahrenheit = variable == kDryBulb && in_fahrenheit_;
    const std::string name{is_fahrenheit ? kDryBulbF : kWeatherVariables[variable].name};
    auto value = parse_number(text);
    if (!value) {
      bad(line, number_problem(name, text));
      return false;
    }
    if (is_fahrenheit) value = (*value - 32.0) / 1.8;
    const weather::WeatherVariable& range = kWeatherVariables[variable];
    if (!range.is_possible(*value)) {
      bad(line, name + " " + std::string{text} + " is impossible; taken as blank");
      return true;
    }
    values.*range.member = std::clamp(*value, range.low, range.high);
    return true;
  }

  Result<WeatherCsv> finish() {
    if (records_.size() < 2) {
      return failure(ErrorCode::not_enough_data,
                     in_quotes(name_) + " has fewer than two usable rows of weather");
    }
    if (!std::ranges::is_sorted(records_, {}, &WeatherRecord::start)) {
      std::ranges::stable_sort(records_, {}, &WeatherRecord::start);
    }
    std::map<seconds, int> steps;
    for (std::size_t i = 1; i < records_.size(); ++i) {
      if (records_[i].start > records_[i - 1].start) {
        ++steps[records_[i].start - records_[i - 1].start];
      }
    }
    csv_.step = std::max_element(steps.begin(), steps.end(), [](const auto& a, const auto& b) {
                  return a.second < b.second;
                })->first;
    if (options_.stamps == Stamps::end) {
      for (WeatherRecord& record : records_) record.start -= csv_.step;
    }
    const auto instant = options_.stamps == Stamps::end ? weather::ValuesStand::at_its_end
                                                        : weather::ValuesStand::at_its_start;
    csv_.values = values_taken(instant);
    const bool instants = csv_.values.values == weather::RecordedValues::instant;
    csv_.series = TRY(weather::to_hourly(
        records_, csv_.step, instants ? instant : weather::ValuesStand::over_the_record));
    return std::move(csv_);
  }

  [[nodiscard]] weather::ValuesTaken values_taken(weather::ValuesStand instant) const {
    using weather::KnownBy;
    using weather::RecordedValues;
    if (options_.values) return {*options_.values, KnownBy::declared};
    // Half of a shorter step does not matter to a building, and is too little to detect.
    if (csv_.step < kStepToInfer) return {RecordedValues::mean, KnownBy::usage};
    if (const auto shown = weather::values_by_the_sun(records_, csv_.step, instant)) {
      return {*shown, KnownBy::inferred};
    }
    const bool is_hourly = csv_.step >= std::chrono::hours{1};
    return {is_hourly ? RecordedValues::instant : RecordedValues::mean, KnownBy::usage};
  }

  void bad(std::uint64_t line, std::string_view reason) { csv_.issues.add(line, reason); }

  LineReader lines_;
  std::string name_;
  const WeatherCsvOptions& options_;
  FieldSplitter fields_;
  WeatherColumns columns_;
  std::size_t column_count_ = 0;
  bool in_fahrenheit_ = false;
  std::vector<WeatherRecord> records_;
  WeatherCsv csv_;
};

}  // namespace

Result<WeatherCsv> read_weather(const std::filesystem::path& file,
                                const WeatherCsvOptions& options) {
  auto source = TRY(open_file(file, "weather file"));
  return WeatherReader{std::move(source), file.string(), options}.run();
}

Result<WeatherCsv> read_weather_text(std::string_view text, std::string_view name,
                                     const WeatherCsvOptions& options) {
  return WeatherReader{bytes_of(text), name, options}.run();
}

}  // namespace recald::csv
