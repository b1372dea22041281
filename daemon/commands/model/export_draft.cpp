#include "daemon/commands/model/export_draft.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "adapters/csv/fields.hpp"
#include "daemon/site/setup/agreed_exports.hpp"
#include "daemon/site/setup/clock_evidence.hpp"
#include "daemon/site/setup/joined_exports.hpp"

namespace recald::daemon {
namespace {

/// The zone that was asked for, else what the stamps' offsets are in: a zone of one offset.
Guess<std::string> zone_of_draft(const std::string& given,
                                 const std::vector<SurveyedExport>& exports) {
  if (!given.empty()) return {given, "as told; months are local"};
  for (const SurveyedExport& one : exports) {
    if (!one.utc_offset || one.utc_offset->count() == 0) continue;
    const auto zone = zone_of_offset(*one.utc_offset);
    if (!zone) continue;
    return {*zone,
            "guessed: the first stamp's offset; months are local, so name the building's zone"};
  }
  return {"Etc/UTC", "guessed: no stamp is local; months are, so name the building's zone"};
}

constexpr double kYear_h = 8760.0;

std::string unit_words(const SurveyedMeter& meter) {
  return meter.is_register ? meter.unit.value + ", a register" : meter.unit.value;
}

/// What a person answers. @return empty: nothing that helps
std::string answer_to(const OpenQuestion& question, const Console& console) {
  console.out << question.words << "\n  " << fmt::format("{}", fmt::join(question.answers, ", "))
              << "? " << std::flush;
  std::string line;
  if (!std::getline(*console.answers, line)) return {};
  return std::string{csv::trimmed(line)};
}

void take_answer(const OpenQuestion& question, const std::string& answer, SurveyHints& hints) {
  if (question.option == "--unit") {
    hints.units.push_back(question.subject + "=" + answer);
  } else if (question.option == "--dates") {
    const auto at = std::ranges::find(table::kTimeFormats, answer);
    if (at == table::kTimeFormats.end()) return;
    hints.table.dates = static_cast<table::TimeFormat>(at - table::kTimeFormats.begin());
  } else if (question.option == "--clock") {
    hints.clock = answer;
  }
}

/// "… Say which: --unit 'Valeur=kWh', or kW, Wh, W."
std::string refusal_of(const OpenQuestion& question) {
  const std::string subject = question.subject.empty() ? "" : question.subject + "=";
  const std::span others = std::span{question.answers}.subspan(1);
  return fmt::format("{} Run again with {} {}, or {}", question.words, question.option,
                     shell_word(subject + question.answers.front()), fmt::join(others, ", "));
}

/// Of a building's meter as a whole: what a town uses.
constexpr double kMean_kW_max = 100'000.0;

/// A sentence on a meter that cannot be what it seems; empty: none is.
std::string implausible(const SurveyedExport& survey) {
  for (const SurveyedMeter& meter : survey.meters) {
    if (std::abs(meter.mean_kW) <= kMean_kW_max) continue;
    const bool is_sign_open = survey.table && !survey.table->decimal_because.starts_with("as ");
    return fmt::format(
        "'{}': {} would use {:.0f} MW in the mean, which no building does; its unit is taken for "
        "{} ({}){}. Give {}--unit, or name the columns that are meters with --column",
        survey.files.front().string(), csv::in_quotes(meter.name), 1e-3 * meter.mean_kW,
        meter.unit.value, meter.unit.because,
        is_sign_open ? fmt::format(", its decimal sign for '{}'", survey.table->shape.decimal) : "",
        is_sign_open ? "--decimal, " : "");
  }
  return {};
}

/// Surveys all files: first each by itself, then those again for which others of their kind settle
/// what they leave open.
tl::expected<std::vector<SurveyedExport>, int> survey_all(
    const std::vector<std::filesystem::path>& files,
    const std::optional<metering::LocalCalendar>& calendar, std::vector<SurveyHints>& hints,
    const Console& console) {
  std::vector<SurveyedExport> exports;
  for (std::size_t i = 0; i < files.size(); ++i) {
    auto survey = survey_export(files[i], calendar, hints[i]);
    if (!survey) return tl::unexpected(console.fail(survey.error()));
    exports.push_back(std::move(*survey));
  }
  const auto agreed = hints_of_others(exports, hints, calendar);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!agreed[i]) continue;
    hints[i] = *agreed[i];
    auto survey = survey_export(files[i], calendar, hints[i]);
    if (!survey) return tl::unexpected(console.fail(survey.error()));
    exports[i] = std::move(*survey);
  }
  if (calendar) ask_together(exports, hints, *calendar);
  return exports;
}

/// Asks until nothing is open. @return or the exit code after saying what is wrong
tl::expected<std::vector<SurveyedExport>, int> survey_aloud(
    const std::vector<std::filesystem::path>& files,
    const std::optional<metering::LocalCalendar>& calendar, SurveyHints& told,
    const Console& console) {
  std::vector<SurveyHints> hints(files.size(), told);
  for (;;) {
    auto exports = survey_all(files, calendar, hints, console);
    if (!exports) return exports;
    const auto open = std::ranges::find_if(
        *exports, [](const SurveyedExport& one) { return !one.questions.empty(); });
    if (open == exports->end()) {
      for (const SurveyedExport& one : *exports) {
        if (const std::string why = implausible(one); !why.empty()) {
          return tl::unexpected(console.fail(why));
        }
      }
      agree(*exports);
      return exports;
    }
    const OpenQuestion& question = open->questions.front();
    const std::string answer =
        console.answers == nullptr ? std::string{} : answer_to(question, console);
    if (answer.empty()) return tl::unexpected(console.fail(refusal_of(question)));
    take_answer(question, answer, told);
    for (SurveyHints& one : hints) take_answer(question, answer, one);
  }
}

}  // namespace

tl::expected<ExportDraft, int> draft_aloud(const std::vector<std::filesystem::path>& files,
                                           const std::string& timezone, SurveyHints hints,
                                           const std::filesystem::path& folder,
                                           const Console& console) {
  std::optional<metering::LocalCalendar> calendar;
  if (!timezone.empty()) {
    auto opened = metering::LocalCalendar::open(timezone);
    if (!opened) {
      return tl::unexpected(console.misused("--timezone: " + opened.error().message));
    }
    calendar = std::move(*opened);
  }
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& one : files) {
    std::error_code ignored;
    if (seen.insert(std::filesystem::weakly_canonical(one, ignored)).second) continue;
    return tl::unexpected(
        console.misused(fmt::format("'{}' is named twice; name it once", one.string())));
  }
  auto surveyed = survey_aloud(files, calendar, hints, console);
  if (!surveyed) return tl::unexpected(surveyed.error());
  auto exports = joined_exports(std::move(*surveyed));
  Guess<std::string> zone = zone_of_draft(timezone, exports);
  SiteDraft draft = draft_site(exports, folder, zone);
  if (!calendar) {
    auto opened = metering::LocalCalendar::open(zone.value);
    if (!opened) return tl::unexpected(console.fail(opened.error()));
    calendar = std::move(*opened);
  }
  return ExportDraft{std::move(exports), std::move(zone), std::move(*calendar), std::move(draft),
                     std::move(hints)};
}

void print_draft(const ExportDraft& drafted, std::string_view look, std::optional<double> area_m2,
                 const Console& console) {
  const auto& [exports, timezone, calendar, draft, hints] = drafted;
  console.out << fmt::format("  {:<24} {:<13} {:<16} {:>6}  {:<10} {:<10} {:>10} {:>12}{} {:>8}\n",
                             "meter", "utility", "unit", "every", "from", "to", "mean kW",
                             "kWh a month", area_m2 ? "  kWh/m2 a" : "", "measured");
  std::size_t number = 0;
  for (const SurveyedExport& one : exports) {
    for (const SurveyedMeter& meter : one.meters) {
      const metering::Instant last = meter.span.end - std::chrono::seconds{1};
      const double intervals = static_cast<double>(meter.span.length() / meter.interval);
      console.out << fmt::format(
          "  {:<24} {:<13} {:<16} {:>2} min  {} {} {:>10} {:>12}{} {:>6.1f} %\n",
          draft.meter_ids[number++], metering::to_string(meter.utility.value), unit_words(meter),
          meter.interval.count() / 60,
          metering::to_string(calendar.local_time(meter.span.begin).date),
          metering::to_string(calendar.local_time(last).date), amount_text(meter.mean_kW),
          amount_text(kMonth_h * meter.mean_kW),
          area_m2 ? fmt::format(" {:>9}", amount_text(kYear_h * meter.mean_kW / *area_m2)) : "",
          std::min(100.0, 100.0 * static_cast<double>(meter.values) / intervals));
    }
  }
  std::vector<std::string> guesses = draft.guesses;
  if (timezone.because.starts_with("guessed")) {
    guesses.insert(guesses.begin(),
                   fmt::format("The time zone is taken for {}; give --timezone.", timezone.value));
  }
  if (guesses.empty()) return;
  console.out << look << "\n";
  for (const std::string& guess : guesses) console.out << fmt::format("  {}\n", guess);
}

nlohmann::ordered_json meters_json(const ExportDraft& drafted) {
  nlohmann::ordered_json meters = nlohmann::ordered_json::array();
  std::size_t number = 0;
  for (const SurveyedExport& one : drafted.exports) {
    for (const SurveyedMeter& meter : one.meters) {
      meters.push_back({{"meter", drafted.draft.meter_ids[number++]},
                        {"utility", metering::to_string(meter.utility.value)},
                        {"unit", meter.unit.value},
                        {"interval_s", meter.interval.count()},
                        {"register", meter.is_register},
                        {"readings", meter.readings},
                        {"from", metering::to_string(meter.span.begin)},
                        {"to", metering::to_string(meter.span.end)}});
    }
  }
  return meters;
}

std::string hint_words(const SurveyHints& hints) {
  std::string words;
  const auto add = [&](std::string_view option, const std::string& value) {
    if (!value.empty()) words += fmt::format(" {} {}", option, shell_word(value));
  };
  for (const std::string& unit : hints.units) add("--unit", unit);
  for (const std::string& column : hints.table.columns) add("--column", column);
  add("--time-column", hints.table.time_column);
  add("--meter-column", hints.table.meter_column);
  add("--sheet", hints.table.sheet);
  if (hints.table.dates) add("--dates", std::string{table::to_string(*hints.table.dates)});
  if (hints.table.decimal) add("--decimal", std::string{*hints.table.decimal});
  if (hints.stamps) add("--stamps", *hints.stamps == csv::Stamps::end ? "end" : "start");
  if (hints.interval) add("--interval", fmt::format("{}", hints.interval->count() / 60));
  add("--clock", hints.clock);
  return words;
}

std::string shell_word(const std::filesystem::path& path) {
  const std::string text = path.string();
  const bool is_plain = std::ranges::all_of(text, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view{"/._-+,=@:"}.find(c) != std::string_view::npos;
  });
  if (is_plain && !text.empty()) return text;
  std::string quoted{'\''};
  for (const char c : text) {
    if (c == '\'') quoted += "'\\'";
    quoted += c;
  }
  return quoted + "'";
}

}  // namespace recald::daemon
