#include "daemon/commands/open_site.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::daemon {
namespace {

constexpr std::size_t kLinesShown = 10;

}  // namespace

tl::expected<OpenSite, std::vector<std::string>> open_site(const std::filesystem::path& file) {
  auto config = load_site(file);
  if (!config) return tl::unexpected(config.error());
  auto calendar = metering::LocalCalendar::open(config->timezone);
  if (!calendar) return tl::unexpected(std::vector{calendar.error().message});
  return OpenSite{std::move(*config), std::move(*calendar)};
}

void print_data_words(const Recording& recording, const Console& console) {
  for (const FileIssues& file : recording.files) {
    if (file.issues.total == 0) continue;
    const std::string name = file.file.filename().string();
    // Bad lines are kept out; rows out of order or repeated are used, once: each says which it is.
    console.err << fmt::format("{}: {} line{} to look at\n", name, file.issues.total,
                               file.issues.total == 1 ? "" : "s");
    for (std::size_t i = 0; i < std::min(kLinesShown, file.issues.listed.size()); ++i) {
      const csv::LineIssue& issue = file.issues.listed[i];
      console.err << fmt::format("  {}:{}: {}\n", name, issue.line, issue.reason);
    }
    if (file.issues.total > kLinesShown) {
      console.err << fmt::format("  … and {} more\n", file.issues.total - kLinesShown);
    }
  }
  for (const MeterRecord& record : recording.meters) {
    for (const metering::DataFinding& finding : record.findings) {
      console.err << fmt::format("{} {}: {}\n",
                                 finding.grade == metering::DataFinding::Grade::warning ? "!" : "-",
                                 finding.meter, finding.sentence);
    }
  }
}

metering::MonthRange whole_period(const SiteConfig& site) {
  metering::MonthRange whole = site.period->calibration;
  if (site.period->validation) {
    whole.first = std::min(whole.first, site.period->validation->first);
    whole.last = std::max(whole.last, site.period->validation->last);
  }
  return whole;
}

Result<void> require_model(const SiteConfig& site) {
  if (site.model) return {};
  return failure(
      ErrorCode::not_enough_data,
      fmt::format("{} describes meters but no [[model]]; add one with a [building] and a "
                  "[period] to calibrate, or use `recald replay`",
                  site.file.filename().string()));
}

tl::expected<ModelledSite, int> open_modelled_site(const std::filesystem::path& file,
                                                   const Console& console,
                                                   const std::string& model) {
  auto site = open_site(file);
  if (!site) return tl::unexpected(console.fail(site.error()));
  const auto fail = [&](const Error& error) { return tl::unexpected(console.fail(error)); };
  if (auto modelled = require_model(site->config); !modelled) return fail(modelled.error());
  if (!model.empty()) site->config.model->kind = model;
  auto facts = facts_of(site->config);
  if (!facts) return fail(facts.error());
  VirtualClock clock{metering::Instant{}};
  auto recording = replay_meters(site->config, site->calendar, {}, clock, {});
  if (!recording) return fail(recording.error());
  print_data_words(*recording, console);
  auto weather = load_weather(site->config, site->calendar, whole_period(site->config));
  if (!weather) return fail(weather.error());
  return ModelledSite{std::move(*site), std::move(*recording), std::move(*weather),
                      std::move(*facts)};
}

}  // namespace recald::daemon
