#include "daemon/site/setup/export_survey.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "adapters/csv/fields.hpp"
#include "adapters/table/files/open_rows.hpp"
#include "daemon/site/replay/clock_doubts.hpp"
#include "daemon/site/setup/clock_evidence.hpp"
#include "daemon/site/setup/export_meters.hpp"
#include "daemon/site/setup/load_parts.hpp"
#include "daemon/site/setup/whole_export.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using std::chrono::seconds;

constexpr seconds kLooseInterval{900};

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
  if (survey.table->shape.container == table::Container::green_button) {
    return {{csv::Stamps::start, "as Green Button feeds have it"}};
  }
  if (survey.table->shape.container == table::Container::nem12) {
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

/// A clock of its own, or the building's, may show days from midnight to midnight.
StampsGuess stamps_of_days(const SurveyedExport& survey, const SurveyedMeter& meter,
                           const metering::LocalCalendar& own_clock,
                           const metering::LocalCalendar& calendar) {
  const auto by_own = guess_stamps(survey, meter.span, meter.interval, own_clock);
  const auto by_site = guess_stamps(survey, meter.span, meter.interval, calendar);
  if (by_site.weight != by_own.weight) return by_site.weight > by_own.weight ? by_site : by_own;
  if (own_clock.zone_name() != "Etc/UTC" || by_site.stamps.value == by_own.stamps.value) {
    return by_own;
  }
  // Nobody lives by UTC: people download days of the building's calendar. A logger that stays on
  // winter time has its own.
  return {{by_site.stamps.value,
           "guessed by the days of the building's clock; those of its own say otherwise"},
          0};
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
    const StampsGuess stamps = stamps_of_days(survey, meter, own_clock, calendar);
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
    const bool may_judge = !has_parts && !watch.as_register.may_rest();
    if (!meter.is_told_kind && (!was_read_as_register || may_judge)) {
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

std::optional<seconds> first_offset(const std::filesystem::path& file,
                                    const table::TableGuess& guess) {
  const auto rows = table::open_rows(file, guess.shape);
  if (!rows) return {};
  std::vector<std::string> header;
  std::optional<std::size_t> time_at;
  for (table::TableRow row; (*rows)->next(row);) {
    if (!time_at) {
      header.assign(row.cells.begin(), row.cells.end());
      time_at = table::find_time_in_header(header, guess.shape);
      if (!guess.shape.time_column.starts_with('#')) continue;
    }
    if (!time_at || *time_at >= row.cells.size()) continue;
    const auto stamp = table::parse_stamp(row.cells[*time_at], guess.shape.time_format);
    if (stamp && stamp->utc_offset) return stamp->utc_offset;
  }
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
