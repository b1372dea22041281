#include "daemon/commands/open_site.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace recald::daemon {
namespace {

constexpr std::size_t kLinesShown = 10;
constexpr std::size_t kTextsShown = 3;  // of them as they stand in the file

}  // namespace

tl::expected<OpenSite, std::vector<std::string>> open_site(const std::filesystem::path& file) {
  auto config = TRY(load_site(file));
  auto calendar = metering::LocalCalendar::open(config.timezone);
  if (!calendar) return tl::unexpected(std::vector{calendar.error().message});
  return OpenSite{std::move(config), std::move(*calendar)};
}

std::string nowhere_to_push(const SiteConfig& site, const MeterConfig& meter) {
  return fmt::format(
      "{}: meter '{}' has source = \"http\", but there is no [http] to send its readings to; add "
      "[http] with listen = \"127.0.0.1:8080\"",
      site.file.filename().string(), meter.meter.id);
}

std::string sum_words(const MeterConfig& meter) {
  std::vector<std::string> added;
  std::vector<std::string> taken_away;
  for (const SumPart& part : meter.sum_of) {
    (part.sign > 0.0 ? added : taken_away).push_back(part.meter);
  }
  std::string words = fmt::format("the sum of {}", fmt::join(added, ", "));
  if (!taken_away.empty()) words += fmt::format(", less {}", fmt::join(taken_away, ", "));
  return words;
}

void print_line_words(const Recording& recording, const Console& console) {
  if (console.detail == Console::Detail::little) return;
  const std::size_t shown = console.detail == Console::Detail::all
                                ? std::numeric_limits<std::size_t>::max()
                                : kLinesShown;
  for (const std::string& note : recording.notes) console.err << fmt::format("! {}\n", note);
  for (const FileIssues& file : recording.files) {
    const std::string name = file.file.filename().string();
    if (!file.others.empty()) console.err << fmt::format("{}: {}\n", name, file.others.words());
    if (file.issues.total == 0) continue;
    // Bad lines are kept out; rows out of order or repeated are used, once: each says which it is.
    console.err << fmt::format("{}: {} line{} to look at\n", name, file.issues.total,
                               file.issues.total == 1 ? "" : "s");
    const auto& listed = file.issues.listed;
    const std::size_t count = std::min(shown, listed.size());
    for (std::size_t i = 0; i < count; ++i) {
      console.err << fmt::format("  {}:{}: {}\n", name, listed[i].line, listed[i].reason);
      if (i < kTextsShown && !listed[i].text.empty()) {
        console.err << fmt::format("    {}\n", listed[i].text);
      }
    }
    if (file.issues.total > count) {
      console.err << fmt::format("  … and {} more\n", file.issues.total - count);
    }
  }
}

void print_data_words(const Recording& recording, const Console& console) {
  print_line_words(recording, console);
  if (console.detail == Console::Detail::little) return;
  for (const MeterRecord& record : recording.meters) {
    for (const metering::DataFinding& finding : record.findings) {
      console.err << fmt::format("{} {}: {}\n",
                                 finding.grade == metering::DataFinding::Grade::warning ? "!" : "-",
                                 finding.meter, finding.sentence);
    }
  }
}

tl::expected<ModelledSite, int> load_aloud(OpenSite site, const Console& console,
                                           const ChoosePeriod& choose) {
  auto modelled = load_modelled_site(
      std::move(site), std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()),
      choose);
  if (!modelled) return tl::unexpected(console.fail(modelled.error()));
  print_data_words(modelled->recording, console);
  return std::move(*modelled);
}

tl::expected<ModelledSite, int> open_modelled_site(const std::filesystem::path& file,
                                                   const Console& console,
                                                   std::optional<ModelKind> model,
                                                   const ChoosePeriod& choose) {
  auto site = open_site(file);
  if (!site) return tl::unexpected(console.fail(site.error()));
  if (auto modelled = require_model(site->config); !modelled) {
    return tl::unexpected(console.fail(modelled.error()));
  }
  if (model) {
    if (auto chosen = choose_model(site->config, *model); !chosen) {
      return tl::unexpected(console.fail(chosen.error()));
    }
  }
  return load_aloud(std::move(*site), console, choose);
}

}  // namespace recald::daemon
