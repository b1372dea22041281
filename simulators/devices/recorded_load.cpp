#include "simulators/devices/recorded_load.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include "core/metering/units.hpp"

namespace recald::simulators {
namespace {

using std::chrono::seconds;

constexpr std::string_view kReadingsHeader = "timestamp,meter,value,unit";

struct RecordedValue {
  metering::Instant begin;
  std::optional<double> value;  ///< Absent: blank.
  std::string unit;
};

std::optional<int> two_digits(std::string_view text, int end) {
  int value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size()) return {};
  return value >= 0 && value < end ? std::optional{value} : std::nullopt;
}

/// Accepts exactly the form "2021-01-31T05:15:00Z".
std::optional<metering::Instant> parse_stamp(std::string_view text) {
  if (text.size() != 20 || text[10] != 'T' || text[13] != ':' || text[16] != ':' ||
      text[19] != 'Z') {
    return {};
  }
  const auto day = metering::parse_day(text.substr(0, 10));
  const auto hour = two_digits(text.substr(11, 2), 24);
  const auto minute = two_digits(text.substr(14, 2), 60);
  const auto second = two_digits(text.substr(17, 2), 60);
  if (!day || !hour || !minute || !second) return {};
  return std::chrono::sys_days{*day} + std::chrono::hours{*hour} + std::chrono::minutes{*minute} +
         seconds{*second};
}

std::optional<std::array<std::string_view, 4>> four_fields(std::string_view line) {
  std::array<std::string_view, 4> fields;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::size_t comma = line.find(',');
    const bool is_last = i + 1 == fields.size();
    if (is_last != (comma == std::string_view::npos)) return {};
    fields[i] = line.substr(0, comma);
    if (!is_last) line.remove_prefix(comma + 1);
  }
  return fields;
}

/// Nothing for a line that is not a reading.
std::optional<RecordedValue> parse_value(const std::array<std::string_view, 4>& fields) {
  const auto begin = parse_stamp(fields[0]);
  if (!begin) return {};
  RecordedValue reading{*begin, {}, std::string{fields[3]}};
  if (const std::string_view text = fields[2]; !text.empty()) {
    double value = 0.0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc{} || read.ptr != text.data() + text.size() || !std::isfinite(value)) {
      return {};
    }
    reading.value = value;
  }
  return reading;
}

/// The readings of one meter, in order of time.
Result<std::vector<RecordedValue>> read_values(const std::filesystem::path& file,
                                               std::string_view meter) {
  std::ifstream in{file};
  std::string line;
  if (!in || !std::getline(in, line)) {
    return failure(ErrorCode::not_found,
                   fmt::format("cannot read the recording {}; check its path", file.string()));
  }
  const auto wrong = [&](int number, std::string_view what) {
    return failure(ErrorCode::malformed, fmt::format("{}:{}: {}", file.string(), number, what));
  };
  if (line != kReadingsHeader)
    return wrong(1, fmt::format("the header must be {}", kReadingsHeader));
  std::vector<RecordedValue> values;
  for (int number = 2; std::getline(in, line); ++number) {
    const auto fields = four_fields(line);
    if (!fields) return wrong(number, "a line needs four fields");
    if ((*fields)[1] != meter) continue;
    auto value = parse_value(*fields);
    if (!value) {
      return wrong(number,
                   "write a UTC stamp such as 2021-01-31T05:15:00Z and a number or nothing");
    }
    if (!values.empty() && value->begin <= values.back().begin) {
      return wrong(number, "this stamp is not later than the one before");
    }
    values.push_back(std::move(*value));
  }
  return values;
}

}  // namespace

Result<LoadShape> read_recorded_load(const std::filesystem::path& file, std::string_view meter) {
  const auto values = TRY(read_values(file, meter));
  if (values.empty()) {
    return failure(ErrorCode::not_found,
                   fmt::format("{}: there is no meter '{}'", file.string(), meter));
  }
  if (values.size() < 2) {
    return failure(
        ErrorCode::not_enough_data,
        fmt::format("{}: one reading of meter '{}' does not tell how long an interval is",
                    file.string(), meter));
  }
  seconds step = seconds::max();
  for (std::size_t i = 1; i < values.size(); ++i) {
    step = std::min(step, values[i].begin - values[i - 1].begin);
  }
  std::vector<double> power_kW;
  double last_kW = 0.0;
  for (const RecordedValue& reading : values) {
    const auto index = static_cast<std::size_t>((reading.begin - values.front().begin) / step);
    power_kW.resize(index, last_kW);
    // Steam readings may also be a mass, so look among its units.
    const auto unit = metering::find_unit(reading.unit, metering::Utility::steam, {});
    if (!unit)
      return failure(ErrorCode::invalid_value, file.string() + ": " + unit.error().message);
    if (reading.value) last_kW = unit->mean_kW(*reading.value, step);
    power_kW.push_back(last_kW);
  }
  return LoadShape::recorded(values.front().begin, step, std::move(power_kW));
}

}  // namespace recald::simulators
