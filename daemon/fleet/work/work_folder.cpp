#include "daemon/fleet/work/work_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/models/versions_folder.hpp"
#include "adapters/record/ingest.hpp"
#include "adapters/record/sites.hpp"
#include "adapters/stores/open.hpp"
#include "adapters/system/files/read_file.hpp"
#include "adapters/system/files/write_file.hpp"
#include "daemon/fleet/work/job_summary.hpp"
#include "daemon/gateway/run/site_jobs.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr auto kJob = "job.json";
constexpr auto kOutcome = "outcome.json";
constexpr auto kSiteFolder = "site";
constexpr auto kWork = "work";
constexpr auto kStore = "store.db";
constexpr std::int64_t kNumber = 1;  // Of the job in the folder's own store.

Result<void> write_below(const fs::path& folder, const std::map<std::string, std::string>& files) {
  for (const auto& [name, bytes] : files) {
    const fs::path file = (folder / name).lexically_normal();
    // Names come from the record, which others may write to.
    if (const auto [end, at] = std::ranges::mismatch(folder, file); end != folder.end()) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("'{}' would lie outside the job's folder", name));
    }
    if (auto made = system::make_folder(file.parent_path()); !made) return made;
    if (auto written = system::write_file(file, bytes); !written) return written;
  }
  return {};
}

/// All files below a folder, by their names relative to `base`; none where there is no folder.
Result<std::map<std::string, std::string>> files_below(const fs::path& folder,
                                                       const fs::path& base) {
  std::map<std::string, std::string> files;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator{folder, ignored}) {
    if (!entry.is_regular_file(ignored)) continue;
    auto bytes = TRY(system::read_file(entry.path()));
    files[entry.path().lexically_relative(base).generic_string()] = std::move(bytes);
  }
  return files;
}

Json job_json(const record::FleetJob& job, const std::string& site_file) {
  return {{"site", job.site},
          {"site_file", site_file},
          {"kind", name_of(job.kind)},
          {"now_s", job.now.time_since_epoch().count()},
          {"asked_by", job.asked_by}};
}

struct Task {
  OpenSite site;
  StoredJob job;
};

Result<Json> read_json(const fs::path& file) {
  const auto text = TRY(system::read_file(file));
  Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) {
    return failure(ErrorCode::malformed, fmt::format("'{}' is no JSON", file.string()));
  }
  return json;
}

Result<Task> read_task(const fs::path& folder) {
  const auto json = TRY(read_json(folder / kJob));
  auto config = load_site(folder / kSiteFolder / json.value("site_file", ""));
  if (!config) return failure(ErrorCode::invalid_value, config.error().front());
  auto calendar = TRY(metering::LocalCalendar::open(config->timezone));
  const metering::Instant now{std::chrono::seconds{json.value("now_s", std::int64_t{0})}};
  config->store.file = folder / kWork / kStore;
  const bool is_diagnosis = json.value("kind", "") == name_of(JobKind::diagnosis);
  return Task{.site = {std::move(*config), std::move(calendar)},
              .job = {.number = kNumber,
                      .kind = is_diagnosis ? JobKind::diagnosis : JobKind::calibration,
                      .state = JobState::running,
                      .asked_by = json.value("asked_by", ""),
                      .asked = now,
                      .started = now,
                      .ended = {},
                      .message = {},
                      .folder = {},
                      .tries = 1,
                      .result = {}}};
}

Json outcome_json(const Task& task, const JobOutcome& outcome, const fs::path& folder) {
  return {
      {"failed", outcome.failed ? outcome.message : ""},
      {"accepted", outcome.accepted},
      {"named", outcome.named},
      {"message", outcome.message},
      {"folder", fs::path{outcome.folder}.lexically_relative(folder).generic_string()},
      {"next", outcome.next ? Json(name_of(*outcome.next)) : Json(nullptr)},
      {"next_asked_by", outcome.next_asked_by},
      {"versions", models::versions_folder(task.site.config.versions_beside()).filename().string()},
      {"summary", job_summary(task.site.config, task.job.kind, outcome)}};
}

Json failure_json(const std::string& why) { return {{"failed", why}}; }

Json done(const Task& task, const fs::path& folder) {
  JobWatch watch;
  const auto outcome = make_site_work(share({task.site.config, task.site.calendar}))(
      task.job, *task.job.started, watch);
  return outcome ? outcome_json(task, *outcome, folder) : failure_json(outcome.error().message);
}

/// Draws are for further computing, a hundred times the rest of a result; `recald calibrate` makes
/// them again.
bool is_kept(const std::string& name) { return !name.starts_with("draws"); }

}  // namespace

Result<void> fill_work_folder(postgres::Connection& record, const record::FleetJob& job,
                              const fs::path& folder) {
  const auto site = TRY(record::site_of_version(record, job.site, job.site_version));
  const auto state = TRY(record::state_before(record, job));
  if (auto written = write_below(folder / kSiteFolder, site.files); !written) return written;
  if (auto made = system::make_folder(folder / kWork); !made) return made;
  if (auto written = write_below(folder / kWork, state); !written) return written;
  const std::string task = job_json(job, site.site_file).dump(2) + "\n";
  if (auto written = system::write_file(folder / kJob, task); !written) return written;
  auto opened = TRY(stores::open_checked(folder / kWork / kStore, {}, job.now));
  return record::copy_into(*opened.store, record, job.site, job.until_seq);
}

Result<void> do_work(const fs::path& folder) {
  const auto task = read_task(folder);
  const Json outcome = task ? done(*task, folder) : failure_json(task.error().message);
  return system::write_file(folder / kOutcome, outcome.dump(2) + "\n");
}

Result<WorkOutcome> read_outcome(const fs::path& folder) {
  const auto json = TRY(read_json(folder / kOutcome));
  WorkOutcome outcome{.failed = json.value("failed", ""),
                      .result = {.accepted = json.value("accepted", false),
                                 .named = json.value("named", false),
                                 .message = json.value("message", "")}};
  if (!outcome.failed.empty()) return outcome;
  record::FleetResult& result = outcome.result;
  result.summary = json.at("summary").dump();
  if (const Json& next = json.at("next"); !next.is_null()) {
    result.next = next == name_of(JobKind::diagnosis) ? JobKind::diagnosis : JobKind::calibration;
    result.next_asked_by = json.value("next_asked_by", "");
  }
  const fs::path results = folder / json.value("folder", "");
  auto files = TRY(files_below(results, results));
  std::erase_if(files, [](const auto& one) { return !is_kept(one.first); });
  result.files = std::move(files);
  result.state = TRY(files_below(folder / kWork / json.value("versions", ""), folder / kWork));
  return outcome;
}

}  // namespace recald::daemon
