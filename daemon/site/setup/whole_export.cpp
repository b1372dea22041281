#include "daemon/site/setup/whole_export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "adapters/csv/fields.hpp"
#include "adapters/table/clock_labels.hpp"
#include "adapters/table/files/open_rows.hpp"
#include "adapters/table/layouts/layout_rows.hpp"
#include "adapters/table/loads/meter_parts.hpp"
#include "adapters/table/loads/rows_apart.hpp"
#include "daemon/site/setup/clock_evidence.hpp"
#include "daemon/site/setup/export_meters.hpp"
#include "daemon/site/setup/file_guess.hpp"

namespace recald::daemon {
namespace {

using std::chrono::seconds;

// As a meter is taken for frozen unless a site file says otherwise.
constexpr int kFrozenIntervals = 12;

}  // namespace

void MeterWatch::take(const metering::Reading& reading) {
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

namespace {

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
    if (meter.is_register || meter.is_told_kind || watch.is_rate) continue;
    if (!watch.as_register.may_rest()) continue;
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
    if (known == hints.registers.end() || meter.is_told_kind) continue;
    meter.is_register = known->second.is_register;
    meter.is_told_kind = is_new = true;
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
    } else if (!whole.watches[i].is_rate && !meter.as_register.is_register && !meter.is_told_kind) {
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

}  // namespace

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

}  // namespace recald::daemon
