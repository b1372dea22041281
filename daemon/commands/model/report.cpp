#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "adapters/system/files/write_file.hpp"
#include "core/text/ascii.hpp"
#include "core/text/printable.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/model/calibrate_aloud.hpp"
#include "daemon/commands/model/export_draft.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/calibration_folder.hpp"
#include "daemon/site/results/meters_report.hpp"

namespace recald::daemon {
namespace {

/// A site without a model and without weather: what its meters tell by themselves.
/// @return whether the page is written; if not, why was said.
bool write_meters_page(const OpenSite& site, const std::filesystem::path& out,
                       const Console& console) {
  VirtualClock clock{metering::Instant{}};
  const auto recording = record_site(site, {}, clock, {});
  if (!recording) {
    console.fail(recording.error());
    return false;
  }
  print_data_words(*recording, console);
  const auto page = render_meters_of(site, *recording, generated_at());
  const auto written = page ? system::write_file(out, *page) : tl::unexpected(page.error());
  if (!written) console.fail(written.error());
  return written.has_value();
}

/// The first line that says something is the head of a table: "[site]".
bool begins_as_toml(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  std::string text(4096, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    return line.front() == '[' && line.back() == ']';
  }
  return false;
}

/// By its name, or where that decides nothing by how it begins. A folder is no export: as a site
/// file it is refused with what to name.
bool is_export(const std::filesystem::path& file) {
  const std::string ending = to_lower(file.extension().string());
  if (ending == ".toml") return false;
  constexpr std::array kExportEndings{".csv", ".xlsx", ".xlsm",   ".xls",  ".xml",
                                      ".txt", ".tsv",  ".ndjson", ".json", ".jsonl"};
  if (std::ranges::find(kExportEndings, ending) != kExportEndings.end()) return true;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    return !std::filesystem::is_directory(file, ignored);
  }
  return !begins_as_toml(file);
}

/// Asks for the zone where an export needs one and somebody is there to answer.
std::string given_zone(const ReportArguments& arguments, const Console& console) {
  if (!arguments.timezone.empty() || console.answers == nullptr) return arguments.timezone;
  for (const std::filesystem::path& file : arguments.files) {
    const auto needs = needs_timezone(file);
    if (!needs || !*needs) continue;
    console.err << fmt::format(
                       "{}: its times do not say their offset from UTC. The building's time zone, "
                       "such as Europe/Berlin: ",
                       printable(file.filename().string()))
                << std::flush;
    std::string answer;
    std::getline(*console.answers, answer);
    const auto begin = answer.find_first_not_of(" \t\r");
    if (begin == std::string::npos) return {};
    return answer.substr(begin, answer.find_last_not_of(" \t\r") + 1 - begin);
  }
  return {};
}

struct InitCommand {
  std::string words;           ///< "recald init export.csv --timezone Europe/Berlin"
  std::filesystem::path file;  ///< That it writes.
};

/// What makes a site file of the same exports. It writes over none.
InitCommand init_command(const ReportArguments& arguments, const std::string& zone,
                         const SurveyHints& hints) {
  InitCommand command{"recald init", "site.toml"};
  for (const auto& file : arguments.files) command.words += " " + shell_word(file);
  if (!zone.empty()) command.words += " --timezone " + zone;
  command.words += hint_words(hints);
  std::error_code ignored;
  if (std::filesystem::exists(command.file, ignored)) {
    const std::filesystem::path folder = arguments.files.front().stem();
    command.words += " --out " + shell_word(folder);
    command.file = folder / "site.toml";
  }
  return command;
}

int report_exports(const ReportArguments& arguments, const Console& console) {
  const std::string zone = given_zone(arguments, console);
  const std::filesystem::path here{"site.toml"};  // where recald init would write
  const auto drafted = draft_aloud(arguments.files, zone, arguments.hints, ".", console);
  if (!drafted) return drafted.error();
  auto config = parse_site(drafted->draft.text, here);
  if (!config) return console.fail(config.error());
  config->unwritten = drafted->draft.text;
  const OpenSite site{std::move(*config), drafted->calendar};
  if (!write_meters_page(site, arguments.out, console)) return kFailure;
  const InitCommand init = init_command(arguments, zone, drafted->hints);
  if (arguments.json) {
    const nlohmann::ordered_json json{{"page", arguments.out.string()},
                                      {"meters", meters_json(*drafted)},
                                      {"guesses", drafted->draft.guesses},
                                      {"site", init.file.string()},
                                      {"next", init.words}};
    console.out << json.dump(2) << "\n";
    return kSuccess;
  }
  print_draft(*drafted, "Look at these, on which the page rests:", {}, console);
  console.out << fmt::format(
      "Wrote {}. To correct a guess, and to go on from here:\n  {}\nwrites {} with each guess "
      "beside its key.\n",
      arguments.out.string(), init.words, init.file.string());
  return kSuccess;
}

int report_site(const CalibrateArguments& arguments, const Console& console) {
  if (auto site = open_site(arguments.site); site && !site->config.model && !site->config.weather) {
    if (!write_meters_page(*site, arguments.out, console)) return kFailure;
    if (!arguments.json) console.out << arguments.out.string() << "\n";
    return kSuccess;
  }
  const auto done = calibrate_aloud(arguments, console);
  if (!done) return done.error();
  if (auto written = system::write_file(arguments.out, render(*done, generated_at())); !written) {
    return console.fail(written.error());
  }
  if (arguments.json) {
    console.out << calibration_json(done->calibration, done->modelled.facts);
  } else {
    console.out << arguments.out.string() << "\n";
  }
  return kSuccess;
}

}  // namespace

int run_report(const ReportArguments& arguments, const Console& console) {
  const auto site = std::ranges::find_if_not(arguments.files, is_export);
  if (site == arguments.files.end()) return report_exports(arguments, console);
  if (arguments.files.size() > 1) {
    return console.misused(
        fmt::format("'{}' is a site file, and a page is of one site or of exports; name it alone",
                    site->string()));
  }
  if (!arguments.timezone.empty()) {
    return console.misused(fmt::format(
        "--timezone is for exports; '{}' is a site file, which has its own: leave --timezone out",
        site->string()));
  }
  CalibrateArguments of_site = arguments;
  of_site.site = *site;
  return report_site(of_site, console);
}

}  // namespace recald::daemon
