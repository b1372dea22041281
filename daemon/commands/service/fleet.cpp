#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>

#include "adapters/record/jobs.hpp"
#include "adapters/record/schema.hpp"
#include "adapters/record/sites.hpp"
#include "adapters/results/learned_priors.hpp"
#include "core/text/nearest.hpp"
#include "core/text/printable.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/fleet/config/fleet_config.hpp"
#include "daemon/fleet/config/open_record.hpp"
#include "daemon/fleet/serve/job_json.hpp"
#include "daemon/fleet/work/site_description.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::string who() {
  const ::passwd* const user = ::getpwuid(::geteuid());
  return user != nullptr ? user->pw_name : fmt::format("user {}", ::geteuid());
}

metering::Instant wall_time() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

using Record = std::unique_ptr<postgres::Connection>;

/// @return the record, or the exit code after saying what is wrong.
tl::expected<Record, int> open_fleet(const std::filesystem::path& file, const Console& console,
                                     bool has_schema = true) {
  const auto config = load_fleet(file);
  if (!config) return tl::unexpected(console.fail(config.error()));
  auto record = open_record(config->record);
  if (!record) return tl::unexpected(console.fail(record.error()));
  if (has_schema) {
    if (auto checked = record::check_schema(**record); !checked) {
      return tl::unexpected(console.fail(checked.error()));
    }
  }
  return std::move(*record);
}

std::string or_dash(const std::optional<metering::Instant>& time) {
  return time ? metering::to_string(*time) : "-";
}

Json time_json(const std::optional<metering::Instant>& time) {
  return time ? Json(metering::to_string(*time)) : Json(nullptr);
}

std::string no_such_site(const std::string& id, const std::vector<record::RecordedSite>& sites) {
  std::vector<std::string_view> ids;
  for (const record::RecordedSite& one : sites) ids.push_back(one.site.id);
  const std::string_view nearest = nearest_name(id, ids);
  return fmt::format("the fleet has no site '{}'; {}", printable(id),
                     nearest.empty() ? "recald fleet status lists its sites"
                                     : fmt::format("did you mean '{}'?", nearest));
}

std::string job_line(const record::FleetJob& job) {
  return fmt::format("{:<20} {:<12} {}  {}{}\n", job.site, name_of(job.kind),
                     metering::to_string(job.month), name_of(job.state),
                     job.reason.empty() ? "" : ": " + job.reason);
}

}  // namespace

int run_fleet_init(const FleetArguments& arguments, const Console& console) {
  auto record = open_fleet(arguments.fleet, console, /*has_schema=*/false);
  if (!record) return record.error();
  const auto left = record::make_schema(**record);
  if (!left) return console.fail(left.error());
  if (!left->empty()) console.err << *left << "\n";
  console.out << fmt::format("The record is ready (version {} of its tables).\n",
                             record::kSchemaVersion);
  return kSuccess;
}

int run_fleet_add(const FleetAddArguments& arguments, const Console& console) {
  std::optional<metering::Month> from;
  if (!arguments.calibrate_from.empty()) {
    const auto month = metering::parse_month(arguments.calibrate_from);
    if (!month) return console.misused("--calibrate-from: " + month.error().message);
    from = *month;
  }
  auto record = open_fleet(arguments.fleet, console);
  if (!record) return record.error();
  const auto known = record::sites(**record);
  if (!known) return console.fail(known.error());
  int exit_code = kSuccess;
  for (const auto& file : arguments.sites) {
    const auto site = open_site(file);
    if (!site) {
      exit_code = console.fail(site.error());
      continue;
    }
    auto description = describe(*site);
    if (!description) {
      exit_code = console.fail(fmt::format("{}: {}", file.string(), description.error().message));
      continue;
    }
    description->calibrate_from = metering::previous_month(site->calendar.month_of(wall_time()));
    // What is not said now is as it was.
    const auto before = std::ranges::find(
        *known, description->id, [](const record::RecordedSite& one) { return one.site.id; });
    if (before != known->end()) {
      description->use = before->site.use;
      description->climate = before->site.climate;
      description->calibrate_from = before->site.calibrate_from;
    }
    if (!arguments.use.empty()) description->use = arguments.use;
    if (!arguments.climate.empty()) description->climate = arguments.climate;
    if (from) description->calibrate_from = *from;
    const auto version = record::put_site(**record, *description, who());
    if (!version) {
      exit_code = console.fail(fmt::format("{}: {}", file.string(), version.error().message));
      continue;
    }
    console.out << fmt::format("{}: version {}{}\n", description->id, version->number,
                               version->is_new ? "" : ", which the record has already");
  }
  return exit_code;
}

int run_fleet_remove(const FleetAddArguments& arguments, const Console& console) {
  auto record = open_fleet(arguments.fleet, console);
  if (!record) return record.error();
  for (const auto& site : arguments.sites) {
    if (auto done = record::retire_site(**record, site.string(), who()); !done) {
      return console.fail(done.error());
    }
    console.out << fmt::format("{}: nothing is taken from it any more; its data stay\n",
                               site.string());
  }
  return kSuccess;
}

int run_fleet_status(const FleetArguments& arguments, const Console& console) {
  auto record = open_fleet(arguments.fleet, console);
  if (!record) return record.error();
  const auto sites = record::sites(**record);
  if (!sites) return console.fail(sites.error());
  const auto counts = record::job_counts(**record);
  if (!counts) return console.fail(counts.error());
  const auto troubled = record::troubled_jobs(**record);
  if (!troubled) return console.fail(troubled.error());
  if (arguments.json) {
    Json json = {{"sites", Json::array()}, {"jobs", Json::object()}, {"troubled", Json::array()}};
    for (const record::RecordedSite& one : *sites) {
      json["sites"].push_back({{"id", one.site.id},
                               {"version", one.version.number},
                               {"heard", time_json(one.heard)},
                               {"newest", time_json(one.newest)}});
    }
    for (const auto& [state, count] : *counts) json["jobs"][std::string{name_of(state)}] = count;
    for (const record::FleetJob& job : *troubled) json["troubled"].push_back(fleet_job_json(job));
    console.out << json.dump(2) << "\n";
    return kSuccess;
  }
  console.out << fmt::format("{:<24} {:<22} {}\n", "site", "last heard", "newest interval");
  for (const record::RecordedSite& one : *sites) {
    console.out << fmt::format("{:<24} {:<22} {}\n", one.site.id, or_dash(one.heard),
                               or_dash(one.newest));
  }
  std::vector<std::string> words;
  for (const auto& [state, count] : *counts) {
    words.push_back(fmt::format("{} {}", count, name_of(state)));
  }
  console.out << fmt::format("jobs: {}\n",
                             words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", ")));
  for (const record::FleetJob& job : *troubled) console.out << "  " << job_line(job);
  return kSuccess;
}

int run_fleet_priors(const FleetPriorsArguments& arguments, const Console& console) {
  auto record = open_fleet(arguments.fleet, console);
  if (!record) return record.error();
  const auto sites = record::sites(**record);
  if (!sites) return console.fail(sites.error());
  std::map<std::string, std::string> use_of;
  for (const record::RecordedSite& one : *sites) use_of[one.site.id] = one.site.use;
  if (!use_of.contains(arguments.site)) {
    return console.fail(no_such_site(arguments.site, *sites));
  }
  const auto results = record::newest_results(**record, JobKind::calibration);
  if (!results) return console.fail(results.error());
  std::optional<nlohmann::json> building;
  std::vector<nlohmann::json> others;
  std::string month;
  for (const record::FleetResultRow& one : *results) {
    if (use_of[one.site] != use_of[arguments.site]) continue;
    const auto text = record::result_file(**record, one.site, JobKind::calibration, one.month,
                                          "calibration.json");
    if (!text) continue;  // of a gateway, say
    auto document = nlohmann::json::parse(*text, nullptr, /*allow_exceptions=*/false);
    if (one.site == arguments.site) {
      building = std::move(document);
    } else {
      month = std::max(month, metering::to_string(one.month));
      others.push_back(std::move(document));
    }
  }
  if (!building) {
    return console.fail(fmt::format(
        "site '{}' has no calibration in the record; its parameters are known after the first",
        arguments.site));
  }
  const auto priors = results::learned_priors(others, results::parameters_of(*building),
                                              building->value("model", std::string{}));
  console.out << "# For a building of the same use and era, calibrated by the same model. What the "
                 "model gets "
                 "wrong in all\n# buildings alike is learned too, so this says nothing of the "
                 "building itself.\n";
  for (const results::LearnedPrior& prior : priors) {
    console.out << fmt::format("# {}\n", prior.sentence);
  }
  console.out << results::site_file_lines(priors, month);
  return kSuccess;
}

int run_fleet_rerun(const FleetRerunArguments& arguments, const Console& console) {
  record::RerunWhat what{.sites = arguments.sites};
  if (arguments.failed) what.state = record::FleetJobState::failed;
  if (arguments.set_aside) what.state = record::FleetJobState::set_aside;
  if (!arguments.month.empty()) {
    const auto month = metering::parse_month(arguments.month);
    if (!month) return console.misused("--month: " + month.error().message);
    what.month = *month;
  }
  auto record = open_fleet(arguments.fleet, console);
  if (!record) return record.error();
  const auto known = record::sites(**record);
  if (!known) return console.fail(known.error());
  for (const std::string& id : arguments.sites) {
    const auto is_it = [&](const record::RecordedSite& one) { return one.site.id == id; };
    if (std::ranges::none_of(*known, is_it)) {
      return console.fail(no_such_site(id, *known));
    }
  }
  const auto jobs = record::would_rerun(**record, what);
  if (!jobs) return console.fail(jobs.error());
  for (const record::FleetJob& job : *jobs) console.out << job_line(job);
  if (!arguments.yes) {
    console.out << fmt::format("{} jobs would run again; --yes lets them\n", jobs->size());
    return kSuccess;
  }
  const auto count = record::rerun(**record, *jobs, who());
  if (!count) return console.fail(count.error());
  console.out << fmt::format("{} jobs run again\n", *count);
  return kSuccess;
}

}  // namespace recald::daemon
