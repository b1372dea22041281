#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "adapters/system/write_file.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/setup/joined_exports.hpp"
#include "daemon/site/setup/site_file.hpp"

namespace recald::daemon {
namespace {

/// The zone that was asked for, else what the stamps' offsets are in: a zone of one offset.
Guess<std::string> timezone_of(const InitArguments& arguments,
                               const std::vector<SurveyedExport>& exports) {
  if (!arguments.timezone.empty()) return {arguments.timezone, "as told; months are local"};
  for (const SurveyedExport& one : exports) {
    if (!one.utc_offset || one.utc_offset->count() % 3600 != 0) continue;
    const auto hours = one.utc_offset->count() / 3600;
    if (hours == 0) continue;
    // Etc/GMT+5 is five hours behind UTC: POSIX counts westwards.
    return {fmt::format("Etc/GMT{}{}", hours > 0 ? '-' : '+', std::abs(hours)),
            "guessed: the first stamp's offset; months are local, so name the building's zone"};
  }
  return {"Etc/UTC", "guessed: no stamp is local; months are, so name the building's zone"};
}

/// The path as a word of a command line.
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

std::string unit_words(const SurveyedMeter& meter) {
  return meter.is_register ? meter.unit.value + ", a register" : meter.unit.value;
}

void print_draft(const std::vector<SurveyedExport>& exports, const SiteDraft& draft,
                 const Guess<std::string>& timezone, const metering::LocalCalendar& calendar,
                 const Console& console) {
  std::size_t number = 0;
  for (const SurveyedExport& one : exports) {
    for (const SurveyedMeter& meter : one.meters) {
      const metering::Instant last = meter.span.end - std::chrono::seconds{1};
      console.out << fmt::format(
          "  {:<24} {:<14} {:<16} every {} min, {} to {}\n", draft.meter_ids[number++],
          metering::to_string(meter.utility.value), unit_words(meter), meter.interval.count() / 60,
          metering::to_string(calendar.local_time(meter.span.begin).date),
          metering::to_string(calendar.local_time(last).date));
    }
  }
  std::vector<std::string> guesses = draft.guesses;
  if (timezone.because.starts_with("guessed")) {
    guesses.insert(guesses.begin(),
                   fmt::format("The time zone is taken for {}; give --timezone.", timezone.value));
  }
  if (guesses.empty()) return;
  console.out << "Look at these; the file says more beside its keys:\n";
  for (const std::string& guess : guesses) console.out << fmt::format("  {}\n", guess);
}

nlohmann::ordered_json json_of(const std::vector<SurveyedExport>& exports, const SiteDraft& draft,
                               const std::filesystem::path& file, const std::string& next) {
  nlohmann::ordered_json meters = nlohmann::ordered_json::array();
  std::size_t number = 0;
  for (const SurveyedExport& one : exports) {
    for (const SurveyedMeter& meter : one.meters) {
      meters.push_back({{"meter", draft.meter_ids[number++]},
                        {"utility", metering::to_string(meter.utility.value)},
                        {"unit", meter.unit.value},
                        {"interval_s", meter.interval.count()},
                        {"register", meter.is_register},
                        {"readings", meter.readings},
                        {"from", metering::to_string(meter.span.begin)},
                        {"to", metering::to_string(meter.span.end)}});
    }
  }
  return {{"site", file.string()}, {"meters", meters}, {"guesses", draft.guesses}, {"next", next}};
}

}  // namespace

int run_init(const InitArguments& arguments, const Console& console) {
  const std::filesystem::path folder = arguments.out.empty() ? "." : arguments.out;
  const std::filesystem::path file =
      arguments.out.empty() ? std::filesystem::path{"site.toml"} : folder / "site.toml";
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    return console.fail(
        fmt::format("'{}' is there already; name another folder with --out, or "
                    "move it away",
                    file.string()));
  }
  std::optional<metering::LocalCalendar> calendar;
  if (!arguments.timezone.empty()) {
    auto opened = metering::LocalCalendar::open(arguments.timezone);
    if (!opened) return console.misused("--timezone: " + opened.error().message);
    calendar = std::move(*opened);
  }
  std::vector<SurveyedExport> exports;
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& one : arguments.files) {
    if (!seen.insert(std::filesystem::weakly_canonical(one, ignored)).second) {
      return console.misused(fmt::format("'{}' is named twice; name it once", one.string()));
    }
    auto survey = survey_export(one, calendar);
    if (!survey) return console.fail(survey.error());
    exports.push_back(std::move(*survey));
  }
  exports = joined_exports(std::move(exports));
  const Guess<std::string> timezone = timezone_of(arguments, exports);
  const SiteDraft draft = draft_site(exports, folder, timezone);
  if (!calendar) {
    auto opened = metering::LocalCalendar::open(timezone.value);
    if (!opened) return console.fail(opened.error());
    calendar = std::move(*opened);
  }
  // Nothing is written that would not load.
  const auto drafted = parse_site(draft.text, file);
  if (!drafted) return console.fail(drafted.error());
  const auto text =
      with_starter(draft.text, *drafted, exports, *calendar, arguments.starter, folder);
  if (!text) return console.fail(text.error());
  if (const auto site = parse_site(*text, file); !site) return console.fail(site.error());
  if (auto made = system::make_folder(folder); !made) return console.fail(made.error());
  if (auto written = system::write_file(file, *text); !written) {
    return console.fail(written.error());
  }
  const std::string next = fmt::format("recald report {} --out {}", shell_word(file),
                                       shell_word(file.parent_path() / "page.html"));
  if (arguments.json) {
    console.out << json_of(exports, draft, file, next).dump(2) << "\n";
    return kSuccess;
  }
  print_draft(exports, draft, timezone, *calendar, console);
  console.out << fmt::format("Wrote {} with {} meter{}. Next:\n  {}\n", file.string(),
                             draft.meter_ids.size(), draft.meter_ids.size() == 1 ? "" : "s", next);
  return kSuccess;
}

}  // namespace recald::daemon
