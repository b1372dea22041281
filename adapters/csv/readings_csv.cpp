#include "adapters/csv/readings_csv.hpp"

#include <cmath>
#include <cstring>
#include <unordered_map>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/line_reader.hpp"
#include "adapters/csv/reading_intake.hpp"
#include "core/absent.hpp"

namespace recald::csv {
namespace {

using metering::Instant;

constexpr std::string_view kHeader = "timestamp,meter,value,unit";
constexpr std::size_t kRequiredColumns = 4;

struct StringHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const {
    return std::hash<std::string_view>{}(text);
  }
};

/// Compares eight bytes at a time: for such short texts a call of memcmp costs more.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  std::size_t i = 0;
  for (; i + 8 <= a.size(); i += 8) {
    std::uint64_t x = 0;
    std::uint64_t y = 0;
    std::memcpy(&x, a.data() + i, 8);
    std::memcpy(&y, b.data() + i, 8);
    if (x != y) return false;
  }
  for (; i < a.size(); ++i) {
    if (a[i] != b[i]) return false;
  }
  return true;
}

/// Positions of the optional columns; 0: absent.
struct Columns {
  std::size_t count = kRequiredColumns;
  std::size_t validity = 0;
  std::size_t late = 0;
  std::size_t reasons = 0;
};

Result<Columns> read_header(std::string_view header, FieldSplitter& fields, std::string_view name) {
  const auto wrong = [&](const std::string& why) {
    return failure(ErrorCode::malformed, in_quotes(name) + ": the header must be '" +
                                             std::string{kHeader} +
                                             "' (then validity, late or reasons, if any) but is " +
                                             in_quotes(header.substr(0, 120)) + why);
  };
  if (header.find(';') != std::string_view::npos) {
    return wrong("; separate fields by commas, not semicolons");
  }
  Columns columns;
  columns.count = fields.split(header);
  if (columns.count < kRequiredColumns || columns.count > FieldSplitter::kFieldsMax)
    return wrong("");
  std::string joined;
  for (std::size_t i = 0; i < kRequiredColumns; ++i) {
    if (i > 0) joined += ',';
    joined += trimmed(fields[i]);
  }
  if (joined != kHeader) return wrong("");
  for (std::size_t i = kRequiredColumns; i < columns.count; ++i) {
    const std::string_view column = trimmed(fields[i]);
    std::size_t* place = column == "validity"  ? &columns.validity
                         : column == "late"    ? &columns.late
                         : column == "reasons" ? &columns.reasons
                                               : nullptr;
    if (place == nullptr || *place != 0)
      return wrong("; column " + in_quotes(column) + " is not known");
    *place = i;
  }
  return columns;
}

class ReadingsReader {
 public:
  ReadingsReader(ByteSource source, std::string_view name, const ReadingsOptions& options,
                 ReadingIntake& intake)
      : lines_{std::move(source)}, name_{name}, options_{options}, intake_{intake} {
    for (std::size_t i = 0; i < options.meters.size(); ++i) {
      by_name_.emplace(options.meters[i].name, static_cast<std::uint32_t>(i));
    }
  }

  Result<void> run() {
    Line line{};
    bool header_seen = false;
    while (lines_.next(line)) {
      if (line.text.empty() && !line.too_long) continue;
      if (!line.text.empty() && line.text.front() == '#') continue;
      if (header_seen) {
        intake_.count_line();
        read_line(line);
        continue;
      }
      columns_ = TRY(read_header(line.text, fields_, name_));
      header_seen = true;
    }
    if (lines_.error()) return tl::unexpected(*lines_.error());
    if (!header_seen) return failure(ErrorCode::malformed, empty_file());
    return {};
  }

 private:
  [[nodiscard]] std::string empty_file() const {
    return in_quotes(name_) + " is empty; its first line must be '" + std::string{kHeader} + "'";
  }

  void read_line(const Line& line) {
    if (read_expected_line(line)) return;
    Row row{.line = line.number, .text = line.text};
    meter_ = nullptr;
    if (line.too_long) return bad(row, "longer than 64 KiB");
    const std::size_t count = fields_.split(line.text);
    if (count != columns_.count) return bad(row, wrong_count(count));
    if (!find_meter() || !read_stamp(row) || !read_value(row)) return;
    if (!line.terminated && !surely_whole()) {
      return bad(row, "the last line has no line end and may be cut; it is kept out");
    }
    if (!read_unit(row) || !read_flags(row)) return;
    intake_.take(*meter_, row);
  }

  /// Most rows look like the rows before: a stamp of the same length, the expected meter, its unit.
  /// Comparing recognises them in half the time of splitting. False: split the line.
  bool read_expected_line(const Line& line) {
    std::string_view rest = line.text;
    const std::size_t stamp_length = last_stamp_text_.size();
    if (columns_.count != kRequiredColumns || !line.terminated || stamp_length == 0 ||
        rest.size() <= stamp_length || rest[stamp_length] != ',') {
      return false;
    }
    Row row{.line = line.number, .stamp = last_stamp_, .text = line.text};
    if (const std::string_view stamp = rest.substr(0, stamp_length);
        !same(stamp, last_stamp_text_)) {
      const auto parsed = parse_timestamp(stamp);
      if (!parsed) return false;
      last_stamp_text_ = stamp;
      last_stamp_ = row.stamp = *parsed;
    }
    rest.remove_prefix(stamp_length + 1);
    IntakeMeter* meter = expected_meter(rest);
    if (meter == nullptr) return false;
    rest.remove_prefix(meter->rows.name.size() + 1);
    const std::size_t length = parse_plain_decimal(rest, row.value);
    if (length == 0 || length >= rest.size() || rest[length] != ',' ||
        !same(rest.substr(length + 1), meter->unit)) {
      return false;  // a blank, another unit, an exponent, or something wrong
    }
    row.conversion = meter->conversion;
    intake_.take(*meter, row);
    return true;
  }

  /// The meter at the start of `rest`, if it is a likely one and was seen before.
  IntakeMeter* expected_meter(std::string_view rest) {
    for (const std::size_t guess : {last_meter_ + 1, last_meter_, std::size_t{0}}) {
      if (guess >= intake_.size()) continue;
      IntakeMeter& meter = intake_.meter(guess);
      const std::string& name = meter.rows.name;
      if (rest.size() <= name.size() || rest[name.size()] != ',' ||
          !same(rest.substr(0, name.size()), name)) {
        continue;
      }
      if (meter.unit.empty()) return nullptr;
      last_meter_ = guess;
      return &meter;
    }
    return nullptr;
  }

  [[nodiscard]] std::string wrong_count(std::size_t count) const {
    if (count == 0) return "a quote is not closed, or text follows a closing quote";
    if (count == columns_.count + 1 && is_digits(fields_[3])) {
      std::string_view whole = fields_[2];
      if (!whole.empty() && whole.front() == '-') whole.remove_prefix(1);
      if (is_digits(whole)) {
        return "value '" + std::string{fields_[2]} + "," + std::string{fields_[3]} +
               "' has a decimal comma; write " + std::string{fields_[2]} + "." +
               std::string{fields_[3]};
      }
    }
    return std::to_string(count) + " fields instead of " + std::to_string(columns_.count);
  }

  bool read_stamp(Row& row) {
    // Files ordered by time repeat a stamp for each meter.
    if (last_stamp_text_.empty() || fields_[0] != last_stamp_text_) {
      const auto stamp = parse_timestamp(fields_[0]);
      if (!stamp) {
        return refuse(row, stamp.error().message);
      }
      last_stamp_text_ = fields_[0];
      last_stamp_ = *stamp;
    }
    row.stamp = last_stamp_;
    return true;
  }

  /// False: the meter is not configured, or there is none.
  bool find_meter() {
    // Most files repeat one meter or cycle through all of them.
    const std::string_view name = fields_[1];
    for (const std::size_t guess : {last_meter_ + 1, last_meter_, std::size_t{0}}) {
      if (guess < intake_.size() && intake_.meter(guess).rows.name == name) {
        last_meter_ = guess;
        meter_ = &intake_.meter(guess);
        return true;
      }
    }
    const auto found = by_name_.find(trimmed(name));
    if (found != by_name_.end()) {
      last_meter_ = found->second;
    } else if (options_.add_unlisted_meters && !trimmed(name).empty()) {
      MeterRows rows;
      rows.name = trimmed(name);
      last_meter_ = intake_.add_meter(rows);
      by_name_.emplace(rows.name, static_cast<std::uint32_t>(last_meter_));
    } else {
      intake_.count_other(trimmed(name));
      return false;
    }
    meter_ = &intake_.meter(last_meter_);
    return true;
  }

  bool read_value(Row& row) {
    const std::string_view text = trimmed(fields_[2]);
    if (text.empty()) {
      row.value = kAbsent;
      return true;
    }
    const auto value = parse_number(text);
    if (!value) {
      return refuse(row, number_problem("value", text));
    }
    if (std::abs(*value) > kValueMax) {
      return refuse(row, "value " + in_quotes(text) + " is more than any meter counts");
    }
    row.value = *value;
    return true;
  }

  /// A last line without a line end is accepted only if its last field was seen before: kWh cut to
  /// kW would be a different reading.
  [[nodiscard]] bool surely_whole() const {
    return columns_.count == kRequiredColumns && !meter_->unit.empty() &&
           fields_[3] == meter_->unit;
  }

  bool read_unit(Row& row) {
    if (fields_[3] != meter_->unit || meter_->unit.empty()) {
      const auto known = intake_.set_unit(*meter_, fields_[3]);
      if (!known) return refuse(row, known.error().message);
    }
    row.conversion = meter_->conversion;
    return true;
  }

  bool read_flags(Row& row) {
    if (columns_.validity != 0 && !trimmed(fields_[columns_.validity]).empty()) {
      const auto validity = metering::parse_validity(trimmed(fields_[columns_.validity]));
      if (!validity) return refuse(row, validity.error().message);
      row.validity = *validity;
    }
    if (columns_.reasons != 0) {
      const auto reasons = metering::parse_reasons(trimmed(fields_[columns_.reasons]));
      if (!reasons) return refuse(row, reasons.error().message);
      row.reasons = *reasons;
    }
    if (columns_.late != 0) {
      const std::string_view late = trimmed(fields_[columns_.late]);
      if (!late.empty() && late != "0" && late != "1" && late != "true" && late != "false") {
        return refuse(row, "late " + in_quotes(late) + " is neither 0 nor 1");
      }
      row.late = late == "1" || late == "true";
    }
    return true;
  }

  void bad(const Row& row, std::string_view reason) {
    intake_.refuse(row.line, reason, row.text, meter_);
  }
  bool refuse(const Row& row, std::string_view reason) {
    bad(row, reason);
    return false;
  }

  LineReader lines_;
  std::string name_;
  const ReadingsOptions& options_;
  ReadingIntake& intake_;
  FieldSplitter fields_;
  Columns columns_;
  IntakeMeter* meter_ = nullptr;  ///< Of the current line.
  std::unordered_map<std::string, std::uint32_t, StringHash, std::equal_to<>> by_name_;
  std::size_t last_meter_ = 0;
  std::string last_stamp_text_;
  Instant last_stamp_{};
};

}  // namespace

Result<void> read_readings(const std::filesystem::path& file, const ReadingsOptions& options,
                           ReadingIntake& intake) {
  auto source = TRY(open_file(file, "readings file"));
  return ReadingsReader{std::move(source), file.string(), options, intake}.run();
}

Result<ReadingsReport> read_readings(const std::filesystem::path& file,
                                     const ReadingsOptions& options, const ReadingsSink& sink) {
  ReadingIntake intake{options, sink};
  return read_readings(file, options, intake).map([&] { return intake.finish(); });
}

Result<ReadingsReport> read_readings_text(std::string_view text, std::string_view name,
                                          const ReadingsOptions& options,
                                          const ReadingsSink& sink) {
  ReadingIntake intake{options, sink};
  return ReadingsReader{bytes_of(text), name, options, intake}.run().map(
      [&] { return intake.finish(); });
}

}  // namespace recald::csv
