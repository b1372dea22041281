#include "daemon/commands/model/export_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "daemon/site/setup/joined_exports.hpp"

namespace recald::daemon {
namespace {

/// The zone that was asked for, else what the stamps' offsets are in: a zone of one offset.
Guess<std::string> zone_of_draft(const std::string& given,
                                 const std::vector<SurveyedExport>& exports) {
  if (!given.empty()) return {given, "as told; months are local"};
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

std::string unit_words(const SurveyedMeter& meter) {
  return meter.is_register ? meter.unit.value + ", a register" : meter.unit.value;
}

}  // namespace

tl::expected<ExportDraft, int> draft_aloud(const std::vector<std::filesystem::path>& files,
                                           const std::string& timezone,
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
  std::vector<SurveyedExport> exports;
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& one : files) {
    std::error_code ignored;
    if (!seen.insert(std::filesystem::weakly_canonical(one, ignored)).second) {
      return tl::unexpected(
          console.misused(fmt::format("'{}' is named twice; name it once", one.string())));
    }
    auto survey = survey_export(one, calendar);
    if (!survey) return tl::unexpected(console.fail(survey.error()));
    exports.push_back(std::move(*survey));
  }
  exports = joined_exports(std::move(exports));
  Guess<std::string> zone = zone_of_draft(timezone, exports);
  SiteDraft draft = draft_site(exports, folder, zone);
  if (!calendar) {
    auto opened = metering::LocalCalendar::open(zone.value);
    if (!opened) return tl::unexpected(console.fail(opened.error()));
    calendar = std::move(*opened);
  }
  return ExportDraft{std::move(exports), std::move(zone), std::move(*calendar), std::move(draft)};
}

void print_draft(const ExportDraft& drafted, std::string_view look, const Console& console) {
  const auto& [exports, timezone, calendar, draft] = drafted;
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
