#include "daemon/site/setup/export_survey.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/line_reader.hpp"
#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/cells/words.hpp"
#include "adapters/table/clock_labels.hpp"
#include "adapters/table/containers/influx_csv.hpp"
#include "adapters/table/containers/nem12.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/files/open_rows.hpp"
#include "adapters/table/green_button.hpp"
#include "adapters/table/layouts/layout_rows.hpp"
#include "adapters/table/loads/meter_parts.hpp"
#include "adapters/table/loads/named_rows.hpp"
#include "adapters/table/loads/rows_apart.hpp"
#include "core/text/ascii.hpp"
#include "core/text/utf8.hpp"
#include "daemon/site/replay/clock_doubts.hpp"
#include "daemon/site/setup/clock_evidence.hpp"
#include "daemon/site/setup/file_guess.hpp"
#include "daemon/site/setup/load_parts.hpp"
#include "daemon/site/setup/utility_guess.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::seconds;
using table::Container;

constexpr std::size_t kFirstBytes = 4096;
constexpr std::size_t kMetersMax = 500;
constexpr double kTypicalGas_kWh_per_m3 = 10.55;
constexpr int kFrozenIntervals =
    12;  // as a meter is taken for frozen unless a site file says otherwise
constexpr seconds kLooseInterval{900};
constexpr std::string_view kOwnHeader = "timestamp,meter,value,unit";

tl::unexpected<Error> about(const std::filesystem::path& file, const Error& error) {
  const std::string name = file.string();
  if (error.message.find(name) != std::string::npos) return tl::unexpected(error);
  return tl::unexpected(Error{error.code, fmt::format("'{}': {}", name, error.message)});
}

Result<std::string> first_bytes(const std::filesystem::path& file) {
  const auto bytes = TRY(csv::open_file(file, "export"));
  std::string begin(kFirstBytes, '\0');
  const auto got = TRY(bytes(begin.data(), begin.size()));
  begin.resize(got);
  return begin;
}

bool is_own(const std::vector<std::string>& lines) {
  const auto header = std::ranges::find_if(
      lines, [](const std::string& line) { return !line.empty() && line.front() != '#'; });
  return header != lines.end() && header->starts_with(kOwnHeader);
}

/// A unit that nothing says is asked for once its values are known; kWh shows them as they are.
std::string unit_read(const SurveyedMeter& meter) {
  return meter.unit.value.empty() ? "kWh" : meter.unit.value;
}

/// A meter before anything is known of its readings.
SurveyedMeter described(std::string name, std::string name_in_file, std::string column,
                        std::string unit, std::string unit_because) {
  SurveyedMeter meter;
  const UtilityGuess utility = guess_utility(name, unit);
  meter.name = std::move(name);
  meter.name_in_file = std::move(name_in_file);
  meter.column = std::move(column);
  meter.unit = {std::move(unit), std::move(unit_because)};
  meter.utility = {utility.utility, utility.because};
  const auto conversion = metering::find_unit(unit_read(meter), utility.utility, {});
  meter.needs_heating_value = !conversion && conversion.error().code == ErrorCode::unsupported &&
                              utility.utility == metering::Utility::gas;
  return meter;
}

/// Of the numbers of a statistic one is the load: the mean, not the least and the most; the total,
/// not what a device shows.
void keep_the_load(table::TableGuess& guess) {
  const auto find = [&](std::string_view name) {
    return std::ranges::find_if(
        guess.values, [&](const table::GuessedColumn& one) { return to_lower(one.name) == name; });
  };
  const auto end = guess.values.end();
  auto load = end;
  if (find("min") != end || find("max") != end) load = find("mean");
  if (find("sum") != end && find("state") != end) load = find("sum");
  if (load == end) return;
  const table::GuessedColumn kept = *load;
  constexpr std::array<std::string_view, 6> kStatistics{"min", "max",   "mean",
                                                        "sum", "state", "change"};
  std::erase_if(guess.values, [&](const table::GuessedColumn& one) {
    const bool is_other = one.column != kept.column &&
                          std::ranges::find(kStatistics, to_lower(one.name)) != kStatistics.end();
    if (is_other) guess.ignored.push_back(fmt::format("{} (beside {})", one.column, kept.column));
    return is_other;
  });
}

std::vector<SurveyedMeter> meters_of_columns(const table::TableGuess& guess,
                                             const std::string& file_stem) {
  std::vector<SurveyedMeter> meters;
  for (const table::GuessedColumn& value : guess.values) {
    std::string name = value.name;
    const bool is_by_file = name.empty() && guess.values.size() == 1;
    if (name.empty()) name = is_by_file ? file_stem : value.column;
    meters.push_back(described(name, "", value.column, value.unit, value.unit_because));
    meters.back().is_named_by_file = is_by_file;
  }
  return meters;
}

/// Those that the rows of a long table name, each with its first unit.
Result<std::vector<SurveyedMeter>> meters_of_rows(const std::filesystem::path& file,
                                                  const table::TableGuess& guess) {
  const table::TableShape& shape = guess.shape;
  const auto rows = TRY(table::open_rows(file, shape));
  std::vector<SurveyedMeter> meters;
  std::map<std::string, std::size_t, std::less<>> known;
  std::vector<std::string> header;
  const std::vector<table::GuessedColumn>& values = guess.values;
  std::optional<std::size_t> meter_at;
  std::optional<std::size_t> unit_at;
  std::optional<std::size_t> time_at;
  for (table::TableRow row; rows->next(row);) {
    if (!meter_at || !time_at) {
      header.clear();
      for (const std::string_view cell : row.cells) header.push_back(utf8_of(cell));
      meter_at = table::find_column(header, shape.meter_column);
      time_at = table::find_column(header, shape.time_column);
      unit_at = table::find_column(header, shape.unit_column);
      if (!shape.time_column.starts_with('#')) continue;
    }
    if (*meter_at >= row.cells.size() || *time_at >= row.cells.size()) continue;
    const std::string_view name = row.cells[*meter_at];
    if (name.empty() || known.contains(name)) continue;
    if (!table::parse_stamp(row.cells[*time_at], shape.time_format)) continue;
    if (meters.size() == kMetersMax) {
      return failure(ErrorCode::malformed,
                     fmt::format("column {} has more than {} different names; if it does not "
                                 "name the meters, take it out",
                                 csv::in_quotes(shape.meter_column), kMetersMax));
    }
    const std::string text = utf8_of(name);
    known.emplace(std::string{name}, meters.size());
    const bool has_unit = unit_at && *unit_at < row.cells.size();
    for (const table::GuessedColumn& value : values) {
      const std::string called = values.size() == 1 ? text : text + " " + value.name;
      if (has_unit) {
        meters.push_back(described(called, text, value.column, utf8_of(row.cells[*unit_at]),
                                   "as its rows say"));
        continue;
      }
      // "sensor.main_energy_kwh"
      std::string in_name = value.unit.empty() ? table::split_unit(text).unit : "";
      const bool is_in_name = !in_name.empty();
      meters.push_back(described(called, text, value.column,
                                 is_in_name ? std::move(in_name) : value.unit,
                                 is_in_name ? "as its name says" : value.unit_because));
    }
  }
  if (rows->error()) return tl::unexpected(*rows->error());
  return meters;
}

/// "UsagePoint/1" of one of its meter readings.
std::string_view usage_point(std::string_view name) {
  return name.substr(0, name.find("/MeterReading"));
}

bool is_of_one_load(const table::FeedMeter& a, const table::FeedMeter& b) {
  return usage_point(a.name) == usage_point(b.name) && a.unit == b.unit &&
         a.is_register == b.is_register && a.is_reverse == b.is_reverse;
}

/// Registers of tariffs are parts of the first of them, or of the total where the feed has it.
void join_tariff(std::span<const table::FeedMeter> feed, const table::FeedMeter& in_feed,
                 SurveyedMeter& meter, std::vector<SurveyedMeter>& meters) {
  const auto is_sibling = [&](const table::FeedMeter& other) {
    return &other != &in_feed && is_of_one_load(other, in_feed);
  };
  if (in_feed.tariff != 0) {
    const bool has_total = std::ranges::any_of(feed, [&](const table::FeedMeter& other) {
      return is_sibling(other) && other.tariff == 0;
    });
    if (has_total) return;
    for (SurveyedMeter& known : meters) {
      const auto first = std::ranges::find(feed, known.name_in_file, &table::FeedMeter::name);
      if (first == feed.end() || first->tariff == 0 || first->tariff == in_feed.tariff) continue;
      if (!is_sibling(*first)) continue;
      known.further_names.push_back(in_feed.name);
      known.parts_because = "registers of tariffs, as the feed says, added up";
      return;
    }
  }
  meters.push_back(std::move(meter));
}

Result<std::vector<SurveyedMeter>> meters_of_feed(const std::filesystem::path& file) {
  const auto feed = TRY(table::read_green_button(file));
  std::vector<SurveyedMeter> meters;
  for (const table::FeedMeter& in_feed : feed.meters) {
    const std::string name = in_feed.title.empty()
                                 ? std::string{in_feed.is_reverse ? "delivered back" : ""}
                                 : in_feed.title;
    SurveyedMeter meter = described(name.empty() ? file.stem().string() : name, in_feed.name,
                                    "value", in_feed.unit, "as the feed says");
    if (in_feed.utility) {
      meter.utility = {*in_feed.utility, "as the feed says"};
      meter.needs_heating_value = in_feed.utility == metering::Utility::gas &&
                                  !metering::find_unit(in_feed.unit, *in_feed.utility, {});
    }
    meter.is_register = in_feed.is_register;
    join_tariff(feed.meters, in_feed, meter, meters);
  }
  return meters;
}

/// What the readings of one meter show, as they pass.
struct MeterWatch {
  RegisterEvidence as_register;  ///< Of its rows.
  bool is_rate = false;
  std::uint64_t values = 0;
  double sum_kW = 0.0;
  double first = 0.0;
  std::uint64_t zeros = 0;
  std::uint64_t negatives = 0;
  std::uint64_t frozen = 0;
  int run = 0;
  double last = 0.0;

  void take(const metering::Reading& reading) {
    if (std::isnan(reading.mean_kW)) return;
    if (values == 0) first = reading.mean_kW;
    ++values;
    sum_kW += reading.mean_kW;
    if (reading.mean_kW == 0.0) ++zeros;
    if (reading.mean_kW < 0.0) ++negatives;
    run = values > 1 && reading.mean_kW == last && last != 0.0 ? run + 1 : 1;
    if (run > kFrozenIntervals) ++frozen;
    last = reading.mean_kW;
  }
};

/// What reading the whole file showed.
struct WholeFile {
  csv::ReadingsReport report;
  table::ClockFacts clock;
  std::vector<MeterWatch> watches;
};

metering::UnitFactors factors_of(const SurveyedMeter& meter) {
  metering::UnitFactors factors;
  if (meter.needs_heating_value) factors.gas_kWh_per_m3 = kTypicalGas_kWh_per_m3;
  return factors;
}

Result<WholeFile> read_whole(SurveyedExport& survey, const metering::LocalCalendar& calendar) {
  WholeFile whole;
  whole.watches.resize(survey.meters.size());
  for (SurveyedMeter& meter : survey.meters) meter.samples = {};
  const csv::ReadingsSink sink{.on_meter = {},
                               .on_reading =
                                   [&](const metering::Reading& reading) {
                                     whole.watches[reading.meter].take(reading);
                                     survey.meters[reading.meter].samples.take(reading.start,
                                                                               reading.mean_kW);
                                   },
                               .on_row =
                                   [&](const csv::RawRow& row) {
                                     MeterWatch& watch = whole.watches[row.meter];
                                     watch.is_rate = row.is_rate;
                                     if (!row.is_rate) watch.as_register.take(row.stamp, row.value);
                                   }};
  std::vector<table::TableMeter> meters;
  for (const SurveyedMeter& meter : survey.meters) {
    csv::MeterRows rows{.name = meter.name_in_file,
                        .utility = meter.utility.value,
                        .interval = survey.told_interval,
                        .units = factors_of(meter)};
    if (meter.is_register && meter.as_register.is_register) {
      rows.counter = {.rated_kW = meter.as_register.rated_kW,
                      .runs_back = meter.as_register.runs_back,
                      .resets = meter.as_register.resets};
      const std::string& zone = meter.as_register.reset_zone;
      rows.resets = metering::reset_times(
          meter.as_register.resets,
          zone.empty() ? calendar : metering::LocalCalendar::open(zone).value_or(calendar));
    }
    if (meter.interval > seconds{0}) rows.interval = meter.interval;
    const bool is_said = survey.table && survey.table->shape.unit_column.empty();
    meters.push_back({std::move(rows), meter.column, is_said ? unit_read(meter) : "",
                      meter.further_names, meter.further_columns});
  }
  table::MeterParts parts{meters};
  const csv::ReadingsSink of_parts = parts.sink(sink);
  csv::ReadingsOptions options = table::intake_options(parts.parts());
  options.finds_tolerance = true;
  csv::ReadingIntake intake{options, of_parts};
  const std::filesystem::path& file = survey.files.front();
  TRY(survey.table ? table::read_table(file, survey.table->shape, parts.parts(), calendar, intake,
                                       &whole.clock)
                   : csv::read_readings(file, options, intake));
  whole.report = TRY(parts.finish(intake.finish()));
  return whole;
}

/// What the flags of the file mean, once all are known.
/// @return whether the file is to be read again.
bool learn_flags(SurveyedExport& survey, const WholeFile& whole) {
  if (!survey.table || survey.table->shape.flag_column.empty()) return false;
  table::TableShape& shape = survey.table->shape;
  if (table::describes_itself(shape.container)) return false;
  const table::FlagMeanings meanings = table::meanings_of(whole.clock.flags);
  const auto words_of = [](const table::FlagCount& flag) {
    return fmt::format("{} ({} rows{})", csv::in_quotes(flag.flag), flag.rows,
                       flag.empty == flag.rows ? ", all zero or blank" : "");
  };
  std::vector<std::string> known;
  std::vector<std::string> unknown;
  for (const table::FlagCount& flag : whole.clock.flags) {
    const auto has = [&](const std::vector<std::string>& list) {
      return std::ranges::find(list, flag.flag) != list.end();
    };
    if (has(meanings.missing)) known.push_back(words_of(flag) + " are no data");
    if (has(meanings.estimated)) known.push_back(words_of(flag) + " are estimates");
  }
  for (const table::FlagCount& flag : meanings.unknown) unknown.push_back(words_of(flag));
  const std::string where = fmt::format("{}: column {}", survey.files.front().filename().string(),
                                        csv::in_quotes(shape.flag_column));
  if (!known.empty()) {
    survey.notes.push_back(
        fmt::format("{} says that values beside {}.", where, fmt::join(known, ", ")));
  }
  if (!unknown.empty()) {
    survey.notes.push_back(fmt::format(
        "{} has {}, whose meaning is not known; such values are taken for measured. If they are no "
        "data, write missing_flags, if they are estimates, estimated_flags.",
        where, fmt::join(unknown, ", ")));
  }
  shape.missing_flags = meanings.missing;
  shape.estimated_flags = meanings.estimated;
  if (known.empty() && unknown.empty()) {
    survey.notes.push_back(fmt::format("{}: columns not used: {} (text).",
                                       survey.files.front().filename().string(),
                                       shape.flag_column));
    shape.flag_column.clear();
  }
  return !known.empty();
}

/// What hardly moves beside registers of the same unit is one that rests, such as that of the
/// tariff of a season.
bool take_resting_registers(SurveyedExport& survey, const WholeFile& whole) {
  bool is_new = false;
  for (std::size_t i = 0; i < survey.meters.size(); ++i) {
    SurveyedMeter& meter = survey.meters[i];
    const MeterWatch& watch = whole.watches[i];
    if (meter.is_register || watch.is_rate || !watch.as_register.may_rest()) continue;
    const auto sibling = std::ranges::find_if(survey.meters, [&](const SurveyedMeter& other) {
      return other.is_register && other.as_register.is_register &&
             other.as_register.resets == metering::Resets::never &&
             other.unit.value == meter.unit.value;
    });
    if (sibling == survey.meters.end()) continue;
    meter.is_register = is_new = true;
    meter.as_register = sibling->as_register;
    meter.as_register.because = "it stands still, beside registers of the same unit";
    meter.as_register.exchanges.clear();
  }
  return is_new;
}

/// What other files show of registers, where this one is too short to.
bool take_registers_of_others(SurveyedExport& survey, const SurveyHints& hints) {
  bool is_new = false;
  for (SurveyedMeter& meter : survey.meters) {
    const auto known = hints.registers.find({meter.name_in_file, meter.column});
    if (known == hints.registers.end() || meter.is_told_register) continue;
    meter.is_register = meter.is_told_register = is_new = true;
    meter.as_register = known->second;
    meter.as_register.exchanges.clear();
  }
  return is_new;
}

/// Meters that only show in their rows how they are to be read: registers, and values that come at
/// longer steps later.
/// @return whether there are any, so that the file is to be read again.
bool learn_from_rows(SurveyedExport& survey, const metering::LocalCalendar& calendar,
                     const WholeFile& whole) {
  bool is_new = false;
  for (std::size_t i = 0; i < survey.meters.size(); ++i) {
    SurveyedMeter& meter = survey.meters[i];
    const csv::MeterReport& report = whole.report.meters[i];
    const bool was_read = report.shown.interval > seconds{0};
    seconds longest{0};
    for (const csv::RowStep& step : report.steps) {
      if (step.left_out > 0 && step.step <= csv::kIntervalMax)
        longest = std::max(longest, step.step);
    }
    if (was_read && csv::is_interval(longest)) {
      meter.interval = longest;
      is_new = true;
    } else if (!whole.watches[i].is_rate && !meter.as_register.is_register) {
      meter.as_register = whole.watches[i].as_register.verdict(calendar);
      meter.is_register = meter.is_register || meter.as_register.is_register;
      is_new = is_new || meter.as_register.is_register;
    }
  }
  return take_resting_registers(survey, whole) || is_new;
}

/// A clock that is never changed, if the stamps show it on more than one day.
Result<void> try_fixed_clock(SurveyedExport& survey, const metering::LocalCalendar& calendar,
                             WholeFile& whole) {
  if (!survey.table->shape.timezone.empty()) return {};
  const bool says_winter = table::says_winter_time(survey.table->shape.time_column);
  if (whole.clock.skipped == 0 && !says_winter) return {};
  std::optional<metering::TimeSpan> span;
  double per_hour = 1.0;
  for (const csv::MeterReport& meter : whole.report.meters) {
    if (!meter.span || meter.shown.interval.count() == 0) continue;
    span = meter.span;
    per_hour = 3600.0 / static_cast<double>(meter.shown.interval.count());
  }
  if (!span) return {};
  const auto zone = fixed_zone(calendar, span->begin);
  auto because = fixed_clock_because(whole.clock, *span, per_hour, calendar);
  if (says_winter) because = "by the time column's name";
  const std::string file = survey.files.front().filename().string();
  if (!zone || !because) {
    survey.notes.push_back(fmt::format(
        "{}: {} row{} in an hour that the clock of {} jumps over {} left out{}.", file,
        whole.clock.skipped, whole.clock.skipped == 1 ? "" : "s", calendar.zone_name(),
        whole.clock.skipped == 1 ? "is" : "are",
        zone ? fmt::format("; if its clock stays on winter time, run again with --clock {}", *zone)
             : ""));
    return {};
  }
  survey.table->shape.timezone = *zone;
  survey.clock_because = *because;
  survey.notes.push_back(fmt::format("{}: read on the clock {}; {}.", file, *zone, *because));
  whole = TRY(read_whole(survey, calendar));
  return {};
}

std::string first_issue(const csv::LineIssues& issues) {
  if (issues.listed.empty()) return "";
  return fmt::format("row {}: {}", issues.listed.front().line, issues.listed.front().reason);
}

/// What makes a file unfit; a few bad rows do not.
Result<void> require_sound(const SurveyedExport& survey, const WholeFile& whole) {
  const csv::ReadingsReport& report = whole.report;
  const auto unfit = [&](const std::string& why) -> Result<void> {
    return failure(ErrorCode::malformed,
                   fmt::format("'{}': {}", survey.files.front().string(), why));
  };
  if (report.readings == 0) {
    return unfit("no row can be used; " + (report.issues.total == 0
                                               ? std::string{"there is none below the header"}
                                               : first_issue(report.issues)));
  }
  std::uint64_t unsorted = 0;
  std::uint64_t twice = 0;
  std::uint64_t conflicts = 0;
  std::uint64_t refused = report.issues.total;
  for (const csv::MeterReport& meter : report.meters) {
    unsorted += meter.unsorted;
    twice += meter.duplicates;
    conflicts += meter.conflicts;
  }
  if (conflicts * 100 > report.readings) {
    return unfit(fmt::format(
        "{} of its {} rows have the same time as another one and a different value, and no column "
        "tells apart what they are of; export each meter by itself, or name the column that names "
        "the meters with --meter-column",
        conflicts, report.readings));
  }
  refused -= std::min(refused, unsorted + twice);
  if (unsorted * 1000 > report.readings) {
    const auto& listed = report.issues.listed;
    const auto late = std::ranges::find_if(listed, [](const csv::LineIssue& issue) {
      return issue.reason.find("in order of time") != std::string::npos;
    });
    const std::string where =
        late == listed.end() ? "" : fmt::format(", the first in row {}", late->line);
    return unfit(
        fmt::format("its stamps are out of order ({} of {} rows come after a later one{}); "
                    "sort it by time",
                    unsorted, report.readings, where));
  }
  if (refused * 100 > report.lines) {
    return unfit(
        fmt::format("{} of its {} rows cannot be used, so it is not what it looks like; "
                    "{}",
                    refused, report.lines, first_issue(report.issues)));
  }
  return {};
}

/// @see guess_stamps
struct StampsGuess {
  Guess<csv::Stamps> stamps;
  int weight = kCertainStamps;
};

/// A record that begins a day at midnight has the starts of its intervals, one that ends a day at
/// midnight their ends.
StampsGuess guess_stamps(const SurveyedExport& survey, const metering::TimeSpan& span,
                         seconds interval, const metering::LocalCalendar& calendar) {
  if (!survey.table) return {{csv::Stamps::start, "as recald's own files have it unless told"}};
  if (survey.table->shape.container == Container::green_button) {
    return {{csv::Stamps::start, "as Green Button feeds have it"}};
  }
  if (survey.table->shape.container == Container::nem12) {
    return {{csv::Stamps::start, "as NEM12 counts its intervals"}};
  }
  const table::TableShape& shape = survey.table->shape;
  if (shape.layout == table::Layout::row_a_day ||
      (shape.layout == table::Layout::column_a_time && !shape.clock_column.empty())) {
    return {{csv::Stamps::start, "as its times run through whole days"}};
  }
  if (survey.table->stamps) return {{*survey.table->stamps, survey.table->stamps_because}};
  const auto minute = [&](Instant t) { return calendar.local_time(t).minute_of_day; };
  const int step = static_cast<int>(interval.count() / 60);
  const Instant last = span.end - interval;
  if (minute(span.begin) == 0 && minute(last) == 1440 - step) {
    return {{csv::Stamps::start, "it begins at midnight and ends before it"}, 2};
  }
  if (minute(span.begin) == step && minute(last) == 0) {
    return {{csv::Stamps::end, "it begins after midnight and ends at it"}, 2};
  }
  // One end may be cut; the other says it too.
  if (minute(span.begin) == 0) return {{csv::Stamps::start, "it begins at midnight"}, 1};
  if (minute(span.begin) == step)
    return {{csv::Stamps::end, "it begins an interval after midnight"}, 1};
  return {{csv::Stamps::start, "guessed; a file of whole days would decide"}, 0};
}

void ask_for_winter_time(SurveyedExport& survey, const metering::LocalCalendar& calendar) {
  if (survey.meters.empty()) return;
  const SurveyedMeter& meter = survey.meters.front();
  const double per_hour = 3600.0 / static_cast<double>(meter.interval.count());
  const auto question =
      winter_time_question(survey.files.front(), survey.clock, meter.span, per_hour, calendar);
  if (question) survey.questions.push_back(*question);
}

/// A question where the file's clock is not that of the building's zone.
void ask_for_clock(SurveyedExport& survey, const metering::LocalCalendar& calendar) {
  if (!survey.table || !survey.table->shape.timezone.empty()) return;
  const auto other = other_clock(survey.clock, calendar);
  if (!other) return ask_for_winter_time(survey, calendar);
  std::vector<std::string> answers = other->zones;
  constexpr std::size_t kShown = 4;
  if (answers.size() > kShown) answers.resize(kShown);
  answers.push_back(calendar.zone_name());
  survey.questions.push_back(
      {.words = fmt::format("'{}': {}; it fits the time zone {}.", survey.files.front().string(),
                            other->because, fmt::join(other->zones, ", ")),
       .option = "--clock",
       .subject = "",
       .answers = std::move(answers)});
}

/// Rounded up to what a person would write.
seconds tolerance_for(seconds beside) {
  for (const int rounded : {0, 1, 2, 5, 10, 15, 20, 30, 45, 60, 90}) {
    if (beside <= seconds{rounded}) return seconds{rounded};
  }
  return std::chrono::ceil<std::chrono::minutes>(beside);
}

/// The calendar by which the file's stamps are read.
metering::LocalCalendar clock_of(const SurveyedExport& survey,
                                 const metering::LocalCalendar& calendar) {
  if (!survey.table || survey.table->shape.timezone.empty()) return calendar;
  return metering::LocalCalendar::open(survey.table->shape.timezone).value_or(calendar);
}

/// Of several columns or rows those that are zero from first to last measure nothing here.
void leave_out_zeros(SurveyedExport& survey) {
  const auto is_zero = [](const SurveyedMeter& meter) {
    return !meter.is_register && meter.zero_share == 1.0 && meter.further_names.empty() &&
           meter.further_columns.empty();
  };
  if (std::ranges::all_of(survey.meters, is_zero)) return;
  for (const SurveyedMeter& meter : survey.meters) {
    if (!is_zero(meter)) continue;
    survey.notes.push_back(fmt::format("{}: {} is zero in all its rows and is left out.",
                                       survey.files.front().filename().string(),
                                       csv::in_quotes(meter.name)));
  }
  std::erase_if(survey.meters, is_zero);
}

/// What of a meter's rows a person should know.
void describe_meter(SurveyedExport& survey, SurveyedMeter& meter, const csv::MeterReport& report,
                    const metering::LocalCalendar& calendar) {
  const auto note = [&](const std::string& sentence) {
    survey.notes.push_back(fmt::format("{}: {}", meter.name, sentence));
  };
  if (!meter.is_register) {
    for (const std::string& sentence : csv::step_sentences(report.steps, meter.interval)) {
      note(sentence);
    }
    if (meter.grid_tolerance > seconds{0}) {
      note(fmt::format("stamps lie up to {} s beside the start of an interval and are put on it.",
                       report.beside_max.count()));
    }
    return;
  }
  for (const RegisterStep& step : meter.as_register.exchanges) {
    note(
        fmt::format("its register went from {:.1f} to {:.1f} kWh on {}: exchanged, or set to "
                    "another number. Nothing is counted across that.",
                    step.from.value_kWh, step.to.value_kWh,
                    metering::to_string(calendar.local_time(step.to.time).date)));
  }
}

void take_results(SurveyedExport& survey, const WholeFile& whole,
                  const metering::LocalCalendar& calendar) {
  std::vector<SurveyedMeter> usable;
  const metering::LocalCalendar own_clock = clock_of(survey, calendar);
  for (std::size_t i = 0; i < survey.meters.size(); ++i) {
    SurveyedMeter& meter = survey.meters[i];
    const csv::MeterReport& report = whole.report.meters[i];
    const MeterWatch& watch = whole.watches[i];
    if (!report.span || watch.values == 0) {
      survey.notes.push_back(fmt::format(
          "{} has no value that can be used and is left out{}.", csv::in_quotes(meter.name),
          report.first_refused.empty()
              ? ""
              : fmt::format(" (row {}: {})", report.first_refused.front().line,
                            report.first_refused.front().reason)));
      continue;
    }
    const auto share = [&](std::uint64_t count) {
      return static_cast<double>(count) / static_cast<double>(watch.values);
    };
    meter.readings = report.readings;
    meter.values = watch.values;
    meter.mean_kW = watch.sum_kW / static_cast<double>(watch.values);
    meter.refused = report.refused;
    meter.span = *report.span;
    meter.interval = report.shown.interval;
    // A clock of its own, or the building's, may show days from midnight to midnight.
    StampsGuess stamps = guess_stamps(survey, meter.span, meter.interval, own_clock);
    const auto by_site = guess_stamps(survey, meter.span, meter.interval, calendar);
    if (by_site.weight > stamps.weight) stamps = by_site;
    meter.stamps = stamps.stamps;
    meter.stamps_weight = stamps.weight;
    if (meter.stamps.value == csv::Stamps::end) {
      meter.span = {meter.span.begin - meter.interval, meter.span.end - meter.interval};
    }
    meter.zero_share = share(watch.zeros);
    meter.negative_share = share(watch.negatives);
    meter.frozen_share = share(watch.frozen);
    const auto unit =
        metering::find_unit(report.shown.unit, meter.utility.value, factors_of(meter));
    const bool is_rate = unit && unit->is_rate;
    const bool was_read_as_register = meter.is_register && meter.as_register.is_register;
    const bool has_parts = !meter.further_names.empty() || !meter.further_columns.empty();
    const bool may_judge = !has_parts && !meter.is_told_register && !watch.as_register.may_rest();
    if (!was_read_as_register || may_judge) {
      meter.as_register = watch.as_register.verdict(calendar);
    }
    meter.is_register = !is_rate && (meter.is_register || meter.as_register.is_register);
    meter.grid_tolerance = tolerance_for(report.beside_max);
    meter.is_of_other_steps = report.steps.size() != 1 || report.steps[0].step != meter.interval;
    describe_meter(survey, meter, report, calendar);
    if (meter.is_register && !was_read_as_register) {
      // A register's value over an interval, as if it were the interval's energy.
      const double intervals = static_cast<double>(meter.span.length() / meter.interval);
      meter.mean_kW = std::max(0.0, watch.last - watch.first) / intervals;
    }
    if (meter.is_register) {
      // Between samples at any time a register is not known to the minute.
      if (report.beside_max > seconds{0}) meter.interval = std::max(meter.interval, kLooseInterval);
      meter.stamps = {csv::Stamps::start, "no matter: a register stands at its stamp"};
    }
    usable.push_back(std::move(meter));
  }
  survey.meters = std::move(usable);
}

/// What a meter would use a month, by unit.
OpenQuestion unit_question(const SurveyedExport& survey, const SurveyedMeter& meter) {
  const double month_kWh = meter.mean_kW * kMonth_h;
  const double hours = static_cast<double>(meter.interval.count()) / 3600.0;
  return {.words = fmt::format(
              "'{}': nothing says the unit of {}; a mean month would be {} kWh if its values are "
              "kWh, {} kWh if kW, {} kWh if Wh, {} kWh if W.",
              survey.files.front().string(), csv::in_quotes(meter.name), amount_text(month_kWh),
              amount_text(month_kWh * hours), amount_text(1e-3 * month_kWh),
              amount_text(1e-3 * month_kWh * hours)),
          .option = "--unit",
          .subject = meter.name,
          .answers = {"kWh", "kW", "Wh", "W", "MWh", "m3", "therm"}};
}

void ask_what_is_open(SurveyedExport& survey) {
  for (const SurveyedMeter& meter : survey.meters) {
    const bool is_said = !survey.table || !survey.table->shape.unit_column.empty();
    if (!is_said && meter.unit.value.empty()) {
      survey.questions.push_back(unit_question(survey, meter));
    }
  }
  if (!survey.table) return;
  const table::TableGuess& guess = *survey.table;
  const std::string file = survey.files.front().string();
  if (guess.is_time_format_open) {
    survey.questions.push_back(
        {.words = fmt::format("'{}': its dates may be {}, {}.", file,
                              table::to_string(guess.shape.time_format), guess.time_format_because),
         .option = "--dates",
         .subject = "",
         .answers = {"dd/mm/yyyy", "mm/dd/yyyy"}});
  }
}

/// "NAME=kWh" of this meter.
std::optional<std::string> unit_of(const SurveyedMeter& meter, const SurveyHints& hints) {
  for (const std::string& hint : hints.units) {
    const std::size_t sign = hint.rfind('=');
    if (sign == std::string::npos) continue;
    const std::string_view name = std::string_view{hint}.substr(0, sign);
    const bool is_of_it = name == meter.name || name == meter.column ||
                          (!meter.name_in_file.empty() && name == meter.name_in_file);
    if (is_of_it) return hint.substr(sign + 1);
  }
  if (!meter.unit.value.empty()) return {};
  const auto of_all = std::ranges::find_if(
      hints.units, [](const std::string& hint) { return hint.find('=') == std::string::npos; });
  return of_all == hints.units.end() ? std::nullopt : std::optional{*of_all};
}

void apply_units(const SurveyHints& hints, SurveyedExport& survey) {
  for (SurveyedMeter& meter : survey.meters) {
    auto unit = unit_of(meter, hints);
    if (!unit) continue;
    const bool is_register = meter.is_register;
    meter = described(meter.name, meter.name_in_file, meter.column, std::move(*unit), "as told");
    meter.is_register = is_register;
  }
}

std::optional<seconds> first_offset(const std::filesystem::path& file,
                                    const table::TableGuess& guess) {
  const auto rows = table::open_rows(file, guess.shape);
  if (!rows) return {};
  std::vector<std::string> header;
  std::optional<std::size_t> time_at;
  for (table::TableRow row; (*rows)->next(row);) {
    if (!time_at) {
      header.assign(row.cells.begin(), row.cells.end());
      time_at = table::find_column(header, guess.shape.time_column);
      if (!guess.shape.time_column.starts_with('#')) continue;
    }
    if (!time_at || *time_at >= row.cells.size()) continue;
    const auto stamp = table::parse_stamp(row.cells[*time_at], guess.shape.time_format);
    if (stamp && stamp->utc_offset) return stamp->utc_offset;
  }
  return {};
}

/// Own files: meters and first units are found by reading it once.
Result<std::vector<SurveyedMeter>> meters_of_own(const std::filesystem::path& file) {
  table::TableGuess as_table;
  as_table.shape.separator = ',';
  as_table.shape.time_column = "timestamp";
  as_table.shape.meter_column = "meter";
  as_table.shape.unit_column = "unit";
  as_table.values.push_back({"value", "value", ""});
  return meters_of_rows(file, as_table);
}

/// Text that says itself what its readings are.
Container container_in_text(const std::vector<std::string>& lines) {
  const auto first = std::ranges::find_if(
      lines, [](const std::string& line) { return !csv::trimmed(line).empty(); });
  if (first != lines.end() && table::is_nem12(*first)) return Container::nem12;
  return table::is_influx_csv(lines) ? Container::influx : Container::text;
}

/// Channels in units that are no energy, as reactive power is, beside others that are.
void leave_out_other_quantities(SurveyedExport& survey) {
  const auto is_other = [](const SurveyedMeter& meter) {
    if (meter.unit.value.empty()) return false;
    const auto unit = metering::find_unit(meter.unit.value, meter.utility.value, factors_of(meter));
    return !unit && unit.error().code == ErrorCode::invalid_value;
  };
  if (std::ranges::all_of(survey.meters, is_other)) return;
  std::vector<std::string> words;
  for (const SurveyedMeter& meter : survey.meters) {
    if (is_other(meter)) words.push_back(fmt::format("{} ({})", meter.name, meter.unit.value));
  }
  if (words.empty()) return;
  std::erase_if(survey.meters, is_other);
  survey.notes.push_back(fmt::format("{}: not energy, and left out: {}.",
                                     survey.files.front().filename().string(),
                                     fmt::join(words, ", ")));
}

/// The water that flows through a heat meter is no gas, if only its unit says so.
void leave_out_volumes(SurveyedExport& survey) {
  const auto is_heat = [](const SurveyedMeter& meter) {
    return meter.utility.value == metering::Utility::heating ||
           meter.utility.value == metering::Utility::chilled_water;
  };
  if (std::ranges::none_of(survey.meters, is_heat)) return;
  std::vector<std::string> words;
  const auto is_volume = [&](const SurveyedMeter& meter) {
    const std::string name = table::folded(meter.name);
    return meter.utility.value == metering::Utility::gas &&
           meter.utility.because.starts_with("by its unit") &&
           name.find("gas") == std::string::npos;
  };
  for (const SurveyedMeter& meter : survey.meters) {
    if (is_volume(meter)) words.push_back(fmt::format("{} ({})", meter.name, meter.unit.value));
  }
  if (words.empty()) return;
  std::erase_if(survey.meters, is_volume);
  survey.notes.push_back(
      fmt::format("{}: beside heat these are volumes of its water, not gas, and left out: {}.",
                  survey.files.front().filename().string(), fmt::join(words, ", ")));
}

/// What neither a column nor a unit says, the file's name may: "Gas.csv".
void guess_by_file_name(SurveyedExport& survey) {
  if (survey.meters.size() != 1) return;
  SurveyedMeter& meter = survey.meters.front();
  if (!meter.utility.because.starts_with("guessed")) return;
  const UtilityGuess by_file =
      guess_utility(survey.files.front().stem().string(), meter.unit.value);
  if (by_file.because == "by its name") {
    meter.utility = {by_file.utility, "by its file's name"};
  }
}

/// Series without a unit, beside others that have one, are temperatures, switches and the like.
void leave_out_without_unit(SurveyedExport& survey) {
  const auto has_none = [](const SurveyedMeter& meter) { return meter.unit.value.empty(); };
  if (std::ranges::all_of(survey.meters, has_none)) {
    survey.table->shape.unit_column.clear();
    return;
  }
  std::vector<std::string> words;
  for (const SurveyedMeter& meter : survey.meters) {
    if (has_none(meter)) words.push_back(meter.name_in_file);
  }
  if (words.empty()) return;
  std::erase_if(survey.meters, has_none);
  survey.notes.push_back(fmt::format("{}: series without a unit of energy are left out: {}.",
                                     survey.files.front().filename().string(),
                                     fmt::join(words, ", ")));
}

/// Names of series without what all have in common, and without their units.
void shorten_names(std::vector<SurveyedMeter>& meters) {
  std::map<std::string, std::size_t> in_meters;
  const auto parts_of_name = [](const std::string& name) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= name.size();) {
      const std::size_t end = std::min(name.find(table::kNamesApart, at), name.size());
      parts.push_back(name.substr(at, end - at));
      at = end + table::kNamesApart.size();
    }
    return parts;
  };
  for (const SurveyedMeter& meter : meters) {
    for (const std::string& part : parts_of_name(meter.name)) ++in_meters[part];
  }
  for (SurveyedMeter& meter : meters) {
    std::string name;
    for (const std::string& part : parts_of_name(meter.name)) {
      const bool is_of_all = meters.size() > 1 && in_meters[part] == meters.size();
      if (is_of_all || table::is_unit(part) || part == "value" || part == "_value") continue;
      name += (name.empty() ? "" : " ") + part;
    }
    if (!name.empty()) meter.name = std::move(name);
  }
}

/// NEM12 and annotated CSV: meters and units are found by reading it once.
Result<SurveyedExport> export_with_description(const std::filesystem::path& file,
                                               Container container) {
  SurveyedExport survey{.files = {file}};
  survey.table.emplace();
  survey.table->shape = table::described_shape(container);
  survey.table->has_offsets = true;
  survey.table->values.push_back({"value", "value", ""});
  survey.meters = TRY(meters_of_rows(file, *survey.table));
  if (container == Container::influx) {
    leave_out_without_unit(survey);
    shorten_names(survey.meters);
    return survey;
  }
  for (SurveyedMeter& meter : survey.meters) {
    meter.utility = {metering::Utility::electricity, "as NEM12 is"};
  }
  survey.notes.push_back(
      fmt::format("{}: its times are the market's, UTC+10 all year (Etc/GMT-10), as NEM12 has them "
                  "wherever the meter is; channels B are what the building feeds in.",
                  file.filename().string()));
  return survey;
}

/// The only meter of a long table, if its rows name it by a number, is called as its values are.
void name_by_values(const table::TableGuess& guess, std::vector<SurveyedMeter>& meters) {
  if (meters.size() != 1 || guess.values.front().name.empty()) return;
  const std::string& name = meters.front().name;
  const auto figures = std::ranges::count_if(name, [](char c) { return c >= '0' && c <= '9'; });
  constexpr int kFiguresOfNumber = 6;
  if (figures < kFiguresOfNumber) return;
  const SurveyedMeter as_number = std::move(meters.front());
  meters.front() = described(guess.values.front().name, as_number.name_in_file, as_number.column,
                             as_number.unit.value, as_number.unit.because);
}

/// What a clock column counts, which only the days of 23 and 25 hours show.
Result<void> find_clock_format(SurveyedExport& survey, const metering::LocalCalendar& calendar,
                               std::optional<table::ClockFormat> told) {
  if (!survey.table || survey.table->labels_a_day == 0) return {};
  table::TableGuess& guess = *survey.table;
  std::vector<std::string> values;
  for (const table::GuessedColumn& value : guess.values) values.push_back(value.column);
  const auto rows = TRY(table::open_rows(survey.files.front(), guess.shape));
  const auto labels = TRY(table::read_clock_labels(*rows, guess.shape, values, calendar,
                                                   told.value_or(guess.shape.clock_format)));
  const bool was_clock = guess.shape.clock_format == table::ClockFormat::time;
  guess.shape.clock_format = *labels.format;
  // Where times end at 24:00, the clock hour that ends is what the clock shows.
  if (was_clock && guess.shape.clock_format == table::ClockFormat::hour_ending) {
    guess.shape.clock_format = table::ClockFormat::time;
  }
  survey.clock_format_because = labels.because;
  if (guess.shape.clock_format == table::ClockFormat::time) {
    guess.shape.interval = seconds{0};
    guess.stamps = csv::Stamps::end;
    guess.stamps_because = was_clock ? "its days end at 24:00" : labels.because;
  } else {
    guess.stamps = csv::Stamps::start;
    guess.stamps_because = "a number stands for its whole interval";
  }
  return {};
}

/// The clock that the name of its time column says, and what else of the guess should be looked at.
Result<void> take_words_of_guess(SurveyedExport& survey, table::TableGuess& guess) {
  const std::filesystem::path& file = survey.files.front();
  if (const auto said = table::offset_said(guess.shape.time_column); said && !guess.has_offsets) {
    const auto zone = zone_of_offset(*said);
    if (!zone) {
      return about(file,
                   {ErrorCode::unsupported,
                    "column " + csv::in_quotes(guess.shape.time_column) +
                        " has an offset that is no whole hour, which no zone of a fixed clock "
                        "has; export its times in UTC"});
    }
    guess.shape.timezone = *said == seconds{0} ? "Etc/UTC" : *zone;
    survey.clock_because = "by the time column's name";
  }
  const std::string name = file.filename().string();
  if (!guess.ignored.empty()) {
    survey.notes.push_back(
        fmt::format("{}: columns not used: {}.", name, fmt::join(guess.ignored, ", ")));
  }
  if (guess.decimal_because.starts_with("guessed")) {
    survey.notes.push_back(fmt::format("{}: the decimal sign is '{}', {}.", name,
                                       guess.shape.decimal, guess.decimal_because));
  }
  for (const std::string& note : guess.notes) {
    survey.notes.push_back(fmt::format("{}: {}", name, note));
  }
  return {};
}

Result<SurveyedExport> described_export(const std::filesystem::path& file,
                                        const SurveyHints& hints) {
  SurveyedExport survey{.files = {file}};
  const auto begin = TRY(first_bytes(file));
  const auto container = table::guess_container(begin);
  if (!container) return about(file, container.error());
  if (*container == Container::green_button) {
    survey.table.emplace();
    survey.table->shape = table::green_button_shape();
    survey.table->has_offsets = true;
    auto meters = meters_of_feed(file);
    if (!meters) return about(file, meters.error());
    survey.meters = std::move(*meters);
    leave_out_other_quantities(survey);
    return survey;
  }
  std::vector<std::string> lines;
  if (*container == Container::text) lines = TRY(first_lines(file));
  const Container inside = *container == Container::text ? container_in_text(lines) : *container;
  if (table::describes_itself(inside)) {
    auto described = export_with_description(file, inside);
    return described ? described : about(file, described.error());
  }
  if (inside == Container::text && is_own(lines)) {
    auto meters = meters_of_own(file);
    if (!meters) return about(file, meters.error());
    survey.meters = std::move(*meters);
    return survey;
  }
  auto guessed = guess_file(file, inside, lines, hints.table);
  if (!guessed) return about(file, guessed.error());
  table::TableGuess* const guess = &guessed->table;
  survey.layout_because = guessed->layout_because;
  survey.notes = std::move(guessed->notes);
  if (hints.table.columns.empty()) keep_the_load(*guess);
  if (guess->shape.meter_column.empty()) {
    survey.meters = meters_of_columns(*guess, file.stem().string());
  } else {
    auto meters = meters_of_rows(file, *guess);
    if (!meters) return about(file, meters.error());
    survey.meters = std::move(*meters);
    name_by_values(*guess, survey.meters);
  }
  TRY(take_words_of_guess(survey, *guess));
  leave_out_other_quantities(survey);
  survey.table = std::move(*guess);
  return survey;
}

/// Rows that have the time of another row, or one before it.
std::uint64_t out_of_order(const WholeFile& whole) {
  std::uint64_t rows = 0;
  for (const csv::MeterReport& meter : whole.report.meters) {
    rows += meter.unsorted + meter.duplicates;
  }
  return rows;
}

/// Reads the file anew with meters that its rows are told apart by. What does not read better is
/// left as it was.
Result<bool> try_apart(SurveyedExport& survey, const metering::LocalCalendar& calendar,
                       WholeFile& whole, SurveyedExport changed) {
  if (changed.meters.empty()) return false;
  auto again = TRY(read_whole(changed, calendar));
  if (again.report.readings == 0 || 2 * out_of_order(again) > out_of_order(whole)) return false;
  survey = std::move(changed);
  whole = std::move(again);
  return true;
}

/// Where times come twice or start again, other columns say of what the rows are: a register, a
/// meter, the header or the title of another block.
Result<void> tell_rows_apart(SurveyedExport& survey, const metering::LocalCalendar& calendar,
                             WholeFile& whole) {
  constexpr std::uint64_t kFew = 200;  // one row in so many may be wrong
  const table::TableShape& shape = survey.table->shape;
  const std::filesystem::path& file = survey.files.front();
  if (table::describes_itself(shape.container)) return {};
  const bool are_in_order = out_of_order(whole) * kFew <= whole.report.readings;
  if (are_in_order && whole.clock.further_headers == 0) return {};
  const auto further = TRY(columns_of_further_blocks(file, shape));
  if (!further.empty() && shape.meter_column.empty()) {
    SurveyedExport changed = survey;
    auto& values = changed.table->values;
    values.insert(values.end(), further.begin(), further.end());
    changed.meters = meters_of_columns(*changed.table, file.stem().string());
    const bool is_told = TRY(try_apart(survey, calendar, whole, std::move(changed)));
    if (is_told) return {};
  }
  if (are_in_order) return {};
  table::TableShape titled = shape;
  titled.further_meter_columns.clear();
  titled.meter_column = table::kTitleColumn;
  // Of several columns of numbers, one may have the numbers of meters.
  std::vector<std::string> values;
  if (survey.table->values.size() == 1) values.push_back(survey.table->values.front().column);
  const auto found =
      TRY(table::columns_that_tell_apart([&] { return table::open_rows(file, titled, &calendar); },
                                         table::shape_of_rows(titled), values));
  if (!found) return {};
  SurveyedExport changed = survey;
  table::TableShape& apart = changed.table->shape;
  apart.meter_column = found->columns.front();
  apart.further_meter_columns.assign(std::next(found->columns.begin()), found->columns.end());
  std::erase_if(changed.table->values, [&](const table::GuessedColumn& value) {
    return std::ranges::find(found->columns, value.column) != found->columns.end() ||
           std::ranges::find(found->alike, value.column) != found->alike.end();
  });
  if (changed.table->values.empty()) return {};
  if (apart.unit_column.empty()) apart.unit_column = changed.table->unit_column;
  changed.meters = TRY(meters_of_rows(file, *changed.table));
  changed.notes.push_back(
      fmt::format("{}: times come more than once; {} {} apart what the rows are of ({} names).",
                  file.filename().string(), fmt::join(found->columns, ", "),
                  found->columns.size() == 1 ? "tells" : "tell", found->groups));
  TRY(try_apart(survey, calendar, whole, std::move(changed)));
  return {};
}

/// Meters that are parts of one load become one; what it is like shows when it is read again.
Result<void> take_loads(SurveyedExport& survey, const metering::LocalCalendar& calendar) {
  const std::vector<FoundLoad> loads = find_loads(survey.meters);
  if (loads.empty()) return {};
  join_loads(loads, survey.meters);
  const auto whole = TRY(read_whole(survey, calendar));
  const std::vector<std::string> known = survey.notes;
  take_results(survey, whole, calendar);
  // Of the other meters the same is said again.
  const auto added = survey.notes.begin() + std::ssize(known);
  survey.notes.erase(std::remove_if(added, survey.notes.end(),
                                    [&](const std::string& note) {
                                      return std::ranges::find(known, note) != known.end();
                                    }),
                     survey.notes.end());
  return {};
}

bool is_without_zone(const SurveyedExport& survey) {
  return survey.table && !survey.table->has_offsets && survey.table->shape.timezone.empty();
}

/// Rows further down may show a decimal sign that the first ones, whole numbers, leave open.
Result<void> try_other_decimal(SurveyedExport& survey, const metering::LocalCalendar& calendar,
                               WholeFile& whole) {
  if (!survey.table || survey.table->decimal_because.starts_with("as ")) return {};
  const auto& listed = whole.report.issues.listed;
  const auto shown = std::ranges::find_if(listed, [](const csv::LineIssue& issue) {
    return issue.reason.find("is no number with a decimal") != std::string::npos;
  });
  if (shown == listed.end()) return {};
  char& decimal = survey.table->shape.decimal;
  const char guessed = decimal;
  decimal = guessed == '.' ? ',' : '.';
  WholeFile other = TRY(read_whole(survey, calendar));
  if (other.report.issues.total < whole.report.issues.total) {
    survey.table->decimal_because = fmt::format("as in row {}", shown->line);
    whole = std::move(other);
    return {};
  }
  decimal = guessed;
  whole = TRY(read_whole(survey, calendar));
  return {};
}

/// Reads it the way that its rows show: rows told apart, flags, registers, steps, its clock.
Result<WholeFile> read_as_it_shows(SurveyedExport& survey, const metering::LocalCalendar& calendar,
                                   const SurveyHints& hints) {
  TRY(find_clock_format(survey, calendar, hints.clock_format));
  auto whole = TRY(read_whole(survey, calendar));
  TRY(try_other_decimal(survey, calendar, whole));
  if (survey.table) TRY(tell_rows_apart(survey, calendar, whole));
  const bool has_flags = learn_flags(survey, whole);
  const bool has_registers = take_registers_of_others(survey, hints);
  if (learn_from_rows(survey, calendar, whole) || has_flags || has_registers) {
    whole = TRY(read_whole(survey, calendar));
  }
  if (survey.table) TRY(try_fixed_clock(survey, calendar, whole));
  return whole;
}

/// What was left out or came twice.
void note_what_is_lost(SurveyedExport& survey, const WholeFile& whole) {
  const std::string name = survey.files.front().filename().string();
  if (whole.clock.words > 0) {
    survey.notes.push_back(fmt::format("{}: {} cells such as {} count as no value.", name,
                                       whole.clock.words, csv::in_quotes(whole.clock.first_word)));
  }
  if (whole.report.issues.total > 0) {
    survey.notes.push_back(fmt::format("{}: {} of {} rows are refused or come twice; {}.", name,
                                       whole.report.issues.total, whole.report.lines,
                                       first_issue(whole.report.issues)));
  }
}

}  // namespace

std::string amount_text(double value) {
  const double size = std::abs(value);
  if (size >= 100.0 || size == 0.0) return fmt::format("{:.0f}", value);
  return size >= 10.0 ? fmt::format("{:.1f}", value) : fmt::format("{:.3g}", value);
}

Result<SurveyedExport> survey_export(const std::filesystem::path& file,
                                     const std::optional<metering::LocalCalendar>& calendar,
                                     const SurveyHints& hints) {
  auto survey = described_export(file, hints);
  if (!survey) return survey;
  apply_units(hints, *survey);
  leave_out_volumes(*survey);
  guess_by_file_name(*survey);
  survey->told_interval = hints.interval;
  if (survey->table && !hints.clock.empty()) {
    survey->table->shape.timezone = hints.clock;
    survey->clock_because = hints.clock_because;
  }
  if (is_without_zone(*survey) && !calendar) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("'{}': its times do not say their offset from UTC; run again with "
                               "--timezone and the building's zone, such as --timezone "
                               "Europe/Berlin",
                               file.string()));
  }
  std::optional<metering::LocalCalendar> clock = calendar;
  if (!clock) {
    clock = TRY(metering::LocalCalendar::open("Etc/UTC"));
    if (survey->table) survey->utc_offset = first_offset(file, *survey->table);
  }
  const auto whole = read_as_it_shows(*survey, *clock, hints);
  if (!whole) return about(file, whole.error());
  TRY(require_sound(*survey, *whole));
  for (const std::string& note : whole->clock.notes) {
    survey->notes.push_back(fmt::format("{}: {}.", file.filename().string(), note));
  }
  survey->clock = whole->clock;
  take_results(*survey, *whole, *clock);
  TRY(take_loads(*survey, *clock));
  leave_out_zeros(*survey);
  if (hints.stamps) {
    for (SurveyedMeter& meter : survey->meters) {
      meter.stamps = Guess<csv::Stamps>{*hints.stamps, "as told"};
    }
  }
  ask_what_is_open(*survey);
  if (calendar && hints.clock.empty()) ask_for_clock(*survey, *calendar);
  if (survey->meters.empty()) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("'{}': no meter has a value that can be used", file.string()));
  }
  note_what_is_lost(*survey, *whole);
  return survey;
}

Result<bool> needs_timezone(const std::filesystem::path& file) {
  return described_export(file, {}).map(is_without_zone);
}

}  // namespace recald::daemon
