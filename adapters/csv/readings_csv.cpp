#include "adapters/csv/readings_csv.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/line_reader.hpp"
#include "core/absent.hpp"
#include "core/metering/interval_book.hpp"

namespace recald::csv {
namespace {

using metering::Instant;
using metering::Reading;
using metering::Reason;
using metering::UnitConversion;
using metering::Validity;
using std::chrono::seconds;

constexpr std::string_view kHeader = "timestamp,meter,value,unit";
constexpr std::size_t kRequiredColumns = 4;
constexpr std::size_t kHeadRows = 64;  // what an interval is inferred from
constexpr seconds kIntervalMin{60};
constexpr seconds kIntervalMax{3600};
constexpr double kValueMax = 1e18;   // so that no unit and no multiplier makes it infinite
constexpr seconds kOffsetGrid{900};  // all zones' offsets since 1971 are multiples of it

/// One row, its interval not yet applied.
struct Row {
  std::uint64_t line;
  Instant stamp;
  double value;  // in the row's unit, NaN: blank
  UnitConversion conversion;
  Validity validity = Validity::ok;
  Reason reasons = Reason::none;
  bool late = false;
};

struct MeterState {
  MeterRows rows;
  MeterReport report;
  std::string unit;  // text of the row before, and what it means
  UnitConversion conversion{};
  bool grid_known = false;
  bool refused = false;  // no usable interval
  double kW_per_unit = 0.0;
  std::vector<Row> head;
  std::vector<metering::RegisterSample> samples;
  std::optional<Instant> last;    // start of the row before
  std::optional<Instant> newest;  // latest start so far
  std::optional<Instant> earliest;
};

struct StringHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const {
    return std::hash<std::string_view>{}(text);
  }
};

std::string in_words(seconds span) {
  return span.count() % 60 == 0 ? std::to_string(span.count() / 60) + " minutes"
                                : std::to_string(span.count()) + " seconds";
}

/// Equality by eight bytes at a time: a call of memcmp costs more than these short texts.
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

template <class Key>
Key commonest(const std::map<Key, int>& counts) {
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most->first;
}

/// Commonest step between neighbouring stamps; the smaller of equals. None below two stamps.
std::optional<seconds> commonest_step(std::vector<Instant> stamps) {
  std::sort(stamps.begin(), stamps.end());
  std::map<seconds, int> counts;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] > stamps[i - 1]) ++counts[stamps[i] - stamps[i - 1]];
  }
  if (counts.empty()) return {};
  return commonest(counts);
}

std::vector<Instant> stamps_of(const MeterState& meter) {
  std::vector<Instant> stamps;
  for (const Row& row : meter.head) stamps.push_back(row.stamp);
  return stamps;
}

/// Where the optional columns stand; 0: absent.
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
                 const ReadingsSink& sink)
      : lines_{std::move(source)}, name_{name}, options_{options}, sink_{sink} {
    report_.issues.listed_max = options.issues_listed_max;
    for (const MeterRows& rows : options.meters) add_meter(rows);
  }

  Result<ReadingsReport> run() {
    Line line{};
    bool header_seen = false;
    while (lines_.next(line)) {
      if (line.text.empty() && !line.too_long) continue;
      if (!line.text.empty() && line.text.front() == '#') continue;
      if (header_seen) {
        ++report_.lines;
        read_line(line);
        continue;
      }
      const auto columns = read_header(line.text, fields_, name_);
      if (!columns) return tl::unexpected(columns.error());
      columns_ = *columns;
      header_seen = true;
    }
    if (lines_.error()) return tl::unexpected(*lines_.error());
    if (!header_seen) return failure(ErrorCode::malformed, empty_file());
    finish();
    return std::move(report_);
  }

 private:
  [[nodiscard]] std::string empty_file() const {
    return in_quotes(name_) + " is empty; its first line must be '" + std::string{kHeader} + "'";
  }

  std::uint32_t add_meter(const MeterRows& rows) {
    const auto index = static_cast<std::uint32_t>(meters_.size());
    MeterState state;
    state.rows = rows;
    state.report.shown.meter = index;
    state.report.shown.name = rows.name;
    meters_.push_back(std::move(state));
    by_name_.emplace(rows.name, index);
    return index;
  }

  void read_line(const Line& line) {
    if (read_expected_line(line)) return;
    if (line.too_long) return bad(line.number, "longer than 64 KiB");
    const std::size_t count = fields_.split(line.text);
    if (count != columns_.count) return bad(line.number, wrong_count(count));
    Row row{line.number, {}, 0.0, {}};
    if (!read_stamp(row)) return;
    MeterState* meter = find_meter(line.number);
    if (meter == nullptr || !read_value(row)) return;
    if (!line.terminated && !surely_whole(*meter)) {
      return bad(line.number, "the last line has no line end and may be cut; it is kept out");
    }
    if (!read_unit(row, *meter) || !read_flags(row)) return;
    accept(*meter, row);
  }

  /// Most rows repeat what the rows before had: a stamp as long, the meter whose turn it is, its
  /// unit. They are recognised by comparing, in half the time of splitting. False: look more
  /// closely.
  bool read_expected_line(const Line& line) {
    std::string_view rest = line.text;
    const std::size_t stamp_length = last_stamp_text_.size();
    if (columns_.count != kRequiredColumns || !line.terminated || rest.size() <= stamp_length ||
        rest[stamp_length] != ',') {
      return false;
    }
    Row row{line.number, last_stamp_, 0.0, {}};
    if (const std::string_view stamp = rest.substr(0, stamp_length);
        !same(stamp, last_stamp_text_)) {
      const auto parsed = parse_timestamp(stamp);
      if (!parsed) return false;
      last_stamp_text_ = stamp;
      last_stamp_ = row.stamp = *parsed;
    }
    rest.remove_prefix(stamp_length + 1);
    MeterState* meter = expected_meter(rest);
    if (meter == nullptr) return false;
    rest.remove_prefix(meter->rows.name.size() + 1);
    const std::size_t length = parse_plain_decimal(rest, row.value);
    if (length == 0 || length >= rest.size() || rest[length] != ',' ||
        !same(rest.substr(length + 1), meter->unit)) {
      return false;  // a blank, another unit, an exponent, or something wrong
    }
    row.conversion = meter->conversion;
    accept(*meter, row);
    return true;
  }

  /// The meter that `rest` begins with, if it is one of the likely ones and was seen before.
  MeterState* expected_meter(std::string_view rest) {
    for (const std::size_t guess : {last_meter_ + 1, last_meter_, std::size_t{0}}) {
      if (guess >= meters_.size()) continue;
      const std::string& name = meters_[guess].rows.name;
      if (rest.size() <= name.size() || rest[name.size()] != ',' ||
          !same(rest.substr(0, name.size()), name)) {
        continue;
      }
      if (meters_[guess].unit.empty()) return nullptr;
      last_meter_ = guess;
      return &meters_[guess];
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
    if (fields_[0] != last_stamp_text_) {
      const auto stamp = parse_timestamp(fields_[0]);
      if (!stamp) {
        bad(row.line, stamp.error().message);
        return false;
      }
      last_stamp_text_ = fields_[0];
      last_stamp_ = *stamp;
    }
    row.stamp = last_stamp_;
    return true;
  }

  MeterState* find_meter(std::uint64_t line) {
    // Most files either repeat one meter or go round all of them.
    const std::string_view name = fields_[1];
    for (const std::size_t guess : {last_meter_ + 1, last_meter_, std::size_t{0}}) {
      if (guess < meters_.size() && meters_[guess].rows.name == name) {
        last_meter_ = guess;
        return &meters_[guess];
      }
    }
    const auto found = by_name_.find(trimmed(name));
    if (found != by_name_.end()) {
      last_meter_ = found->second;
    } else if (options_.add_unlisted_meters && !trimmed(name).empty()) {
      MeterRows rows;
      rows.name = trimmed(name);
      last_meter_ = add_meter(rows);
    } else {
      bad(line, "meter " + in_quotes(name) + " is not configured");
      return nullptr;
    }
    return &meters_[last_meter_];
  }

  bool read_value(Row& row) {
    const std::string_view text = trimmed(fields_[2]);
    if (text.empty()) {
      row.value = kAbsent;
      return true;
    }
    const auto value = parse_number(text);
    if (!value) {
      bad(row.line, number_problem("value", text));
      return false;
    }
    if (std::abs(*value) > kValueMax) {
      return refuse(row, "value " + in_quotes(text) + " is more than any meter counts");
    }
    row.value = *value;
    return true;
  }

  /// A last line without its end is believed when its last field is the one seen before: kWh cut to
  /// kW would be another reading.
  [[nodiscard]] bool surely_whole(const MeterState& meter) const {
    return columns_.count == kRequiredColumns && !meter.unit.empty() && fields_[3] == meter.unit;
  }

  bool read_unit(Row& row, MeterState& meter) {
    if (fields_[3] != meter.unit || meter.unit.empty()) {
      const auto conversion =
          metering::find_unit(trimmed(fields_[3]), meter.rows.utility, meter.rows.units);
      if (!conversion) {
        bad(row.line, conversion.error().message + " (meter " + in_quotes(meter.rows.name) + ")");
        return false;
      }
      meter.unit = fields_[3];
      meter.conversion = *conversion;
      if (meter.report.shown.unit.empty()) meter.report.shown.unit = trimmed(fields_[3]);
      if (meter.grid_known) set_scale(meter);
    }
    row.conversion = meter.conversion;
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

  void accept(MeterState& meter, const Row& row) {
    if (meter.refused) return;
    if (meter.rows.counter) return keep_sample(meter, row);
    if (meter.grid_known) return hand_on(meter, row);
    meter.head.push_back(row);
    if (meter.head.size() == kHeadRows) begin_meter(meter);
  }

  /// The head shows the interval; from here on rows go straight to the sink.
  void begin_meter(MeterState& meter) {
    if (!find_grid(meter)) {
      meter.refused = true;
    } else {
      set_scale(meter);
      meter.grid_known = true;
      if (sink_.on_meter) sink_.on_meter(meter.report.shown);
      for (const Row& row : meter.head) hand_on(meter, row);
    }
    meter.head = {};
  }

  bool find_grid(MeterState& meter) {
    MeterInFile& shown = meter.report.shown;
    shown.interval_inferred = !meter.rows.interval;
    const auto interval =
        meter.rows.interval ? meter.rows.interval : commonest_step(stamps_of(meter));
    const std::uint64_t line = meter.head.front().line;
    if (!interval) {
      bad(line, "meter " + in_quotes(shown.name) +
                    " has one time stamp only, so its interval cannot be seen; declare it");
      return false;
    }
    if (*interval < kIntervalMin || *interval > kIntervalMax ||
        kIntervalMax % *interval != seconds{0}) {
      bad(line, "meter " + in_quotes(shown.name) + " comes every " + in_words(*interval) +
                    "; supported are whole minutes that divide an hour");
      return false;
    }
    shown.interval = *interval;
    std::map<seconds, int> phases;
    for (const Row& row : meter.head) ++phases[row.stamp.time_since_epoch() % *interval];
    shown.phase = commonest(phases);
    // Another phase than a zone's offset can make is a clock that is wrong, row by row.
    if (shown.phase % kOffsetGrid != seconds{0}) shown.phase = seconds{0};
    return true;
  }

  void set_scale(MeterState& meter) {
    meter.kW_per_unit =
        meter.conversion.mean_kW(meter.rows.multiplier, meter.report.shown.interval);
  }

  void hand_on(MeterState& meter, const Row& row) {
    const MeterInFile& shown = meter.report.shown;
    const Instant start = meter.rows.stamps == Stamps::end ? row.stamp - shown.interval : row.stamp;
    const bool follows =
        meter.last && start == *meter.last + shown.interval && meter.last == meter.newest;
    if (!follows && !check_order(meter, row, start)) return;
    meter.last = start;
    if (!meter.newest || start > *meter.newest) meter.newest = start;
    ++meter.report.readings;
    if (std::isnan(row.value)) ++meter.report.blanks;
    const bool usual_unit = row.conversion.factor == meter.conversion.factor &&
                            row.conversion.is_rate == meter.conversion.is_rate;
    const double mean_kW =
        usual_unit ? row.value * meter.kW_per_unit
                   : row.conversion.mean_kW(row.value * meter.rows.multiplier, shown.interval);
    if (sink_.on_reading) {
      sink_.on_reading({shown.meter, start, mean_kW, row.validity, row.reasons, row.late});
    }
  }

  /// What is not simply the next interval. False: kept out.
  bool check_order(MeterState& meter, const Row& row, Instant start) {
    const MeterInFile& shown = meter.report.shown;
    if (start < Instant{} + std::chrono::days{366} ||
        start + shown.interval > metering::kLatestInstant) {
      return refuse(row, "the interval lies outside 1971 to 2037");
    }
    if ((start.time_since_epoch() - shown.phase) % shown.interval != seconds{0}) {
      ++meter.report.off_grid;
      return refuse(row, "meter " + in_quotes(shown.name) + ": " + metering::to_string(start) +
                             " is no start of an interval of " + in_words(shown.interval));
    }
    if (meter.last && start == *meter.last) {
      ++meter.report.duplicates;
      bad(row.line, "meter " + in_quotes(shown.name) + ": interval " + metering::to_string(start) +
                        " comes twice; the first value stays");
    } else if (meter.newest && start < *meter.newest) {
      ++meter.report.unsorted;
      bad(row.line, "meter " + in_quotes(shown.name) + ": " + metering::to_string(start) +
                        " comes after a later interval; the file is not in order of time");
    }
    if (!meter.earliest || start < *meter.earliest) meter.earliest = start;
    return true;
  }

  void keep_sample(MeterState& meter, const Row& row) {
    if (row.conversion.is_rate) {
      bad(row.line, "meter " + in_quotes(meter.rows.name) + " is a counter, but " +
                        in_quotes(meter.unit) + " is a power");
      return;
    }
    if (!meter.samples.empty() && row.stamp <= meter.samples.back().time) {
      ++meter.report.unsorted;
      bad(row.line, "meter " + in_quotes(meter.rows.name) +
                        ": a counter's samples must be in order of time; this one is kept out");
      return;
    }
    if (meter.samples.size() < kHeadRows) meter.head.push_back(row);
    meter.samples.push_back({row.stamp, row.value * row.conversion.factor * meter.rows.multiplier});
  }

  void finish() {
    for (MeterState& meter : meters_) {
      if (!meter.grid_known && !meter.refused && !meter.head.empty()) {
        if (meter.rows.counter) {
          finish_counter(meter);
        } else {
          begin_meter(meter);
        }
      }
      if (meter.newest) {
        meter.report.span =
            metering::TimeSpan{*meter.earliest, *meter.newest + meter.report.shown.interval};
      }
      report_.readings += meter.report.readings;
      report_.meters.push_back(std::move(meter.report));
    }
  }

  void finish_counter(MeterState& meter) {
    if (!find_grid(meter)) return;
    MeterInFile& shown = meter.report.shown;
    shown.phase = seconds{0};
    if (sink_.on_meter) sink_.on_meter(shown);
    for (const Reading& reading : metering::readings_from_register(
             shown.meter, meter.samples, shown.interval, *meter.rows.counter)) {
      ++meter.report.readings;
      if (std::isnan(reading.mean_kW)) ++meter.report.blanks;
      if (!meter.earliest) meter.earliest = reading.start;
      meter.newest = reading.start;
      if (sink_.on_reading) sink_.on_reading(reading);
    }
  }

  void bad(std::uint64_t line, std::string_view reason) { report_.issues.add(line, reason); }
  bool refuse(const Row& row, std::string_view reason) {
    bad(row.line, reason);
    return false;
  }

  LineReader lines_;
  std::string name_;
  const ReadingsOptions& options_;
  const ReadingsSink& sink_;
  FieldSplitter fields_;
  Columns columns_;
  std::vector<MeterState> meters_;
  std::unordered_map<std::string, std::uint32_t, StringHash, std::equal_to<>> by_name_;
  std::size_t last_meter_ = 0;
  std::string last_stamp_text_;
  Instant last_stamp_{};
  ReadingsReport report_;
};

}  // namespace

Result<ReadingsReport> read_readings(const std::filesystem::path& file,
                                     const ReadingsOptions& options, const ReadingsSink& sink) {
  auto source = open_file(file, "readings file");
  if (!source) return tl::unexpected(source.error());
  return ReadingsReader{std::move(*source), file.string(), options, sink}.run();
}

Result<ReadingsReport> read_readings_text(std::string_view text, std::string_view name,
                                          const ReadingsOptions& options,
                                          const ReadingsSink& sink) {
  return ReadingsReader{bytes_of(text), name, options, sink}.run();
}

}  // namespace recald::csv
