#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "adapters/system/files/file_lock.hpp"
#include "core/text/limited.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/gateway/upkeep/import_csv.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"

namespace recald::daemon {
namespace {

constexpr std::size_t kRefusedShown = 10;

std::string author() {
  const char* user = std::getenv("USER");
  return user != nullptr && *user != '\0' ? limited(user, kAuthorMax) : "unknown";
}

void print_issues(const ImportArguments& arguments, const csv::ReadingsReport& report,
                  const Console& console) {
  const std::string name = arguments.file.filename().string();
  const csv::LineIssues& issues = report.issues;
  if (!report.others.empty()) console.err << fmt::format("{}: {}\n", name, report.others.words());
  for (std::size_t i = 0; i < std::min(kRefusedShown, issues.listed.size()); ++i) {
    console.err << fmt::format("{}:{}: {}\n", name, issues.listed[i].line, issues.listed[i].reason);
  }
  if (issues.total > kRefusedShown) {
    console.err << fmt::format("… and {} more\n", issues.total - kRefusedShown);
  }
}

void print_words(const ImportOutcome& outcome, const ImportArguments& arguments,
                 const Console& console) {
  console.out << fmt::format(
      "{}{} readings: {} {}, {} already known, {} weaker than the stored ones, {} in conflict\n",
      arguments.dry_run ? "dry run: " : "", outcome.file.readings, outcome.taken,
      arguments.dry_run ? "would be stored" : "stored", outcome.duplicates, outcome.weaker,
      outcome.conflicts);
  if (outcome.conflicts > 0) {
    console.err << "readings in conflict differ from stored ones of equal quality; add --supersede "
                   "to use those of the file\n";
  }
  if (!outcome.closed.empty()) {
    console.out << fmt::format("{} months closed, {} of them again\n", outcome.closed.size(),
                               outcome.reopened.size());
  }
}

nlohmann::ordered_json json_of(const ImportOutcome& outcome, bool dry_run) {
  return {{"readings", outcome.file.readings},
          {"bad_lines", outcome.file.issues.total},
          {"taken", outcome.taken},
          {"duplicates", outcome.duplicates},
          {"weaker", outcome.weaker},
          {"conflicts", outcome.conflicts},
          {"months_reopened", outcome.reopened.size()},
          {"months_closed", outcome.closed.size()},
          {"dry_run", dry_run}};
}

}  // namespace

int run_import(const ImportArguments& arguments, const Console& console) {
  if (arguments.reason.find_first_not_of(" \t") == std::string::npos) {
    return console.misused(
        "--reason is empty; say why these readings are imported, so that others can understand it "
        "later");
  }
  if (arguments.reason.size() > kReasonMax) {
    return console.misused(fmt::format("--reason is {} bytes long; it may be {} at most",
                                       arguments.reason.size(), kReasonMax));
  }
  const auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  const auto lock = system::FileLock::acquire(site->config.store.file.string() + ".lock");
  if (!lock) {
    return console.fail(lock.error().message + "; stop the daemon, import, and start it again");
  }
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const auto opened = open_store(site->config.store, now);
  if (!opened) return console.fail(opened.error());
  if (!opened->recovery.empty()) console.err << opened->recovery << "\n";
  const auto outcome =
      import_readings(*opened->store, site->config, site->calendar, arguments.file,
                      {.author = author(),
                       .reason = arguments.reason,
                       .stamps = arguments.stamps == "end" ? csv::Stamps::end : csv::Stamps::start,
                       .supersedes = arguments.supersede,
                       .dry_run = arguments.dry_run},
                      now);
  if (!outcome) return console.fail(outcome.error());
  print_issues(arguments, outcome->file, console);
  if (arguments.json) {
    console.out << json_of(*outcome, arguments.dry_run).dump(2) << "\n";
  } else {
    print_words(*outcome, arguments, console);
  }
  return kSuccess;
}

}  // namespace recald::daemon
