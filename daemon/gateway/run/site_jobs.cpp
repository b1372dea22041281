#include "daemon/gateway/run/site_jobs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/models/model_store.hpp"
#include "adapters/results/job_result_json.hpp"
#include "adapters/system/files/write_file.hpp"
#include "adapters/views/diagnosis/diagnosis_files.hpp"
#include "adapters/views/drift/drift_json.hpp"
#include "adapters/views/drift/drift_report.hpp"
#include "adapters/views/drift/drift_summary.hpp"
#include "daemon/gateway/upkeep/job_folder.hpp"
#include "daemon/site/calibrate/calibration_on_design.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"
#include "daemon/site/diagnose/proposed_version.hpp"
#include "daemon/site/diagnose/site_diagnosis.hpp"
#include "daemon/site/drift/site_drift.hpp"
#include "daemon/site/model/active_effects.hpp"
#include "daemon/site/replay/stored_readings.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/calibration_folder.hpp"
#include "daemon/site/results/diagnosis_folder.hpp"
#include "daemon/site/results/report_parts.hpp"

namespace recald::daemon {
namespace {

constexpr int kDriftParticles = 256;
constexpr std::uint64_t kSeed = 1;  // a result must not depend on the number of earlier runs

constexpr double kCalibrating = 0.5;  // Of a calibration job; following its months is the rest.

/// A job uses the latest months, whatever period the site file names.
OpenSite on_latest_months(OpenSite site) {
  site.config.period.reset();
  return site;
}

/// How far a calibration is; chains run one after the other.
double share_of(const calibration::Progress& progress) {
  constexpr double kSampling = 0.8;
  const double part =
      progress.total > 0 ? static_cast<double>(progress.done) / progress.total : 0.0;
  switch (progress.stage) {
    case calibration::Progress::Stage::design:
      return 0.1 * part;
    case calibration::Progress::Stage::sampling:
      return 0.1 + kSampling * (progress.chain + part) / calibration::SamplingOptions{}.chains;
    case calibration::Progress::Stage::predicting:
      break;
  }
  return 0.1 + kSampling + 0.1 * part;
}

/// "weather is incomplete in 2024-03 (12 %), 2024-05 to 2024-07 (0 %)"; empty: it is complete.
std::string lacking_words(const std::vector<MonthWeather>& months, const SiteConfig& site) {
  std::string words;
  const auto known_words = [](const MonthWeather& one) {
    return weather::grade_of(one.known) == weather::WeatherGrade::good
               ? ""
               : fmt::format(" ({:.0f} %)", 100.0 * one.known);
  };
  for (std::size_t first = 0, last = 0; first < months.size(); first = ++last) {
    const std::string known = known_words(months[first]);
    while (last + 1 < months.size() && known_words(months[last + 1]) == known) ++last;
    if (known.empty()) continue;
    if (!words.empty()) words += ", ";
    words += months[first].month;
    if (last > first) words += " to " + months[last].month;
    words += known;
  }
  if (words.empty()) return "";
  const bool is_made_again = !site.recalibration.schedule.is_never();
  return fmt::format("weather is incomplete in {}{}", words,
                     is_made_again ? "; recald calibrates again when more arrives" : "");
}

JobOutcome outcome_of(const assessment::AssessedCalibration& calibration, const RunFacts& facts,
                      const SiteConfig& site, const std::filesystem::path& folder) {
  JobOutcome outcome{.accepted = is_sound(calibration),
                     .folder = folder.string(),
                     .result = calibration_result(calibration, facts)};
  std::vector<std::string> words;
  if (!outcome.accepted) {
    words.emplace_back("the chains have not converged, so the previous result stays in use");
  }
  if (!calibration.not_calibrated_because.empty()) {
    words.push_back(calibration.not_calibrated_because);
  }
  if (auto lacking = lacking_words(facts.weather, site); !lacking.empty()) {
    words.push_back(std::move(lacking));
  }
  outcome.message = fmt::format("{}", fmt::join(words, "; "));
  return outcome;
}

Result<JobOutcome> calibrate_metamodel(const ModelledSite& modelled,
                                       const std::filesystem::path& design,
                                       const std::filesystem::path& folder, metering::Instant now,
                                       const calibration::RunContext& context) {
  const auto done = TRY(calibrate_on_metamodel(modelled, design, context));
  JobOutcome outcome = outcome_of(done.calibration, done.facts, modelled.site.config, folder);
  TRY(write_calibration(done, months_csv(modelled.recording, done.facts.time_zone_data),
                        outcome.result.document, metering::to_string(now), folder));
  return outcome;
}

/// To be stored: the forecast of each month from before its figure was known.
std::vector<StoredForecast> forecasts_of(const SiteDrift& drift, const RunFacts& facts,
                                         metering::Instant now) {
  std::vector<StoredForecast> forecasts;
  for (const drift::PrequentialMonth& month : drift.record) {
    for (std::size_t k = 0; k < month.outputs.size(); ++k) {
      const auto& one = month.outputs[k];
      if (!one) continue;
      forecasts.push_back({.output = drift.outputs[k].name,
                           .month = metering::parse_month(drift.month_name(month.month)).value(),
                           .model_version = facts.model_version,
                           .data_revision = facts.data_revision,
                           .made = now,
                           .mean = one->mean,
                           .sd = one->sd,
                           .q05 = one->q05,
                           .q50 = one->q50,
                           .q95 = one->q95,
                           .measured = one->measured,
                           .pit = one->surprise.pit,
                           .standardised = one->surprise.standardised,
                           .log_score = one->surprise.log_score,
                           .crps = one->surprise.crps});
    }
  }
  return forecasts;
}

/// The newest month has attributed an alarm to something the model lacks, so it should be
/// identified and added.
bool asks_for_a_name(const SiteDrift& drift) {
  return std::ranges::any_of(drift.alarms, [&](const ExplainedAlarm& alarm) {
    return alarm.consequence == drift::Consequence::began_anew &&
           (alarm.causes.front().kind == drift::CauseKind::unknown ||
            alarm.causes.front().kind == drift::CauseKind::effect) &&
           alarm.explained_until == drift.record.back().month;
  });
}

/// What all months show about drift. The calibration is valid without it.
/// @return or why there is nothing: too few months, or a model that cannot be monitored.
Result<DriftSummary> follow(OpenSite site, metering::Instant now,
                            const calibration::RunContext& context,
                            const std::filesystem::path& folder, JobOutcome& outcome) {
  const DriftOptions options{.sequential = {.particles = kDriftParticles}};
  auto modelled = TRY(load_modelled_site(
      std::move(site), now,
      [&](const OpenSite& open, const Recording& recording, metering::Instant until) {
        return followed_period(open, recording, until, options.learning_months);
      }));
  auto version = TRY(active_version(modelled.site.config));
  modelled.facts.model_version = version_name(version, modelled.facts.model_version);
  modelled.facts.seed = context.seed;
  auto drift = TRY(follow_site(modelled, options, version.effects, context));
  TRY(views::write_drift(site_line_of(modelled.site.config), drift, modelled.facts,
                         metering::to_string(now), views::drift_json(drift, modelled.facts),
                         folder));
  outcome.forecasts = forecasts_of(drift, modelled.facts, now);
  SiteConfig hourly = modelled.site.config;
  const bool can_be_diagnosed = choose_model(hourly, ModelKind::hourly).has_value();
  // A diagnosis starts from the drawings.
  const bool is_of_drawings = version.effects.empty();
  if (asks_for_a_name(drift) && can_be_diagnosed && is_of_drawings) {
    outcome.next = JobKind::diagnosis;
  }
  return views::summary_of(drift);
}

Result<JobOutcome> calibrate(const OpenSite& site, const CalibrateOptions& options,
                             const StoredJob& job, metering::Instant now, JobWatch& watch) {
  const auto folder = job_folder(site.config.store, job.kind, job.number);
  auto modelled = TRY(load_modelled_site(on_latest_months(site), now));
  const calibration::RunContext context{
      .seed = kSeed, .observer = [&](const calibration::Progress& progress) {
        return watch.say("calibrating the model", kCalibrating * share_of(progress));
      }};
  if (const auto& design = modelled.site.config.recalibration.design; !design.empty()) {
    return calibrate_metamodel(modelled, design, folder, now, context);
  }
  const auto done = TRY(finish_calibration(std::move(modelled), options, context));
  JobOutcome outcome =
      outcome_of(done.calibration, done.modelled.facts, done.modelled.site.config, folder);
  TRY(write_calibration(done, outcome.result.document, metering::to_string(now), folder));
  const calibration::RunContext following{
      .seed = kSeed, .observer = [&](const calibration::Progress& progress) {
        const double part = static_cast<double>(progress.done) / std::max(progress.total, 1);
        return watch.say("following the months", kCalibrating + (1.0 - kCalibrating) * part);
      }};
  auto followed = follow(on_latest_months(site), now, following, folder, outcome);
  if (!followed && followed.error().code == ErrorCode::cancelled) {
    return tl::unexpected(followed.error());
  }
  const FollowUp follow_up = std::move(followed).map_error(&Error::message);
  outcome.result = calibration_result(done.calibration, done.modelled.facts, &follow_up);
  return outcome;
}

/// The outcome of a failed calibration, with the weather of its months. Missing weather may be the
/// cause; then it is run again once the weather arrives.
Result<JobOutcome> with_known_weather(const Error& error, const SharedSite& shared,
                                      metering::Instant now) {
  const OpenSite& site = *shared;
  if (error.code == ErrorCode::cancelled || !site.config.weather) return tl::unexpected(error);
  const metering::Month last = metering::previous_month(site.calendar.month_of(now));
  const metering::MonthRange months{
      last - std::chrono::months{site.config.recalibration.months - 1}, last};
  auto known = make_weather_check(shared)(months);
  if (!known) {  // the file may be just being written: nothing is known
    known.emplace();
    for (metering::Month month = months.first; month <= last; month = metering::next_month(month)) {
      known->push_back({.month = metering::to_string(month)});
    }
  }
  const std::string lacking = lacking_words(*known, site.config);
  if (lacking.empty()) return tl::unexpected(error);
  const nlohmann::ordered_json document = {{"weather", results::weather_json(*known)}};
  return JobOutcome{.failed = true,
                    .message = error.message + "; " + lacking,
                    .folder = {},
                    .result = {.document = document.dump(2) + "\n"},
                    .forecasts = {},
                    .next = {}};
}

/// Stores what was named as a version of the model, and puts it in force where the site says so.
/// @return what it did, for people, or why the version cannot be written.
Result<std::string> propose(const ModelledSite& modelled, const diagnosis::Diagnosis& diagnosis,
                            const diagnosis::SiteProblem& problem, metering::Instant now,
                            JobOutcome& outcome) {
  const SiteConfig& site = modelled.site.config;
  const std::string at = metering::to_string(now);
  const models::ModelStore store{site.versions_beside(), site.id};
  const auto version = TRY(propose_version(store, modelled, diagnosis, problem, at,
                                           diagnosis::VersionAuthor::automatic));
  const auto known = TRY(store.list());
  const std::string what =
      fmt::format("version {} of the model has it", diagnosis::short_version(version.version));
  if (!site.applies_itself || !may_apply_itself(version, known)) {
    return what + " and is not in force yet";
  }
  TRY(store.activate(version.version, at));
  outcome.next = JobKind::calibration;
  outcome.next_asked_by = "diagnosis";
  return what + " and is in force, because the site says so";
}

/// "named Runs on weekends (97 %)"
std::string named_words(const diagnosis::Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const diagnosis::Addition& added : diagnosis.added) {
    names.push_back(
        fmt::format("{} ({:.0f} %)", added.candidate.effect->title, 100.0 * added.probability));
  }
  return fmt::format("named {}", fmt::join(names, ", "));
}

Result<JobOutcome> diagnose(OpenSite site, const StoredJob& job, metering::Instant now,
                            JobWatch& watch) {
  const auto folder = job_folder(site.config.store, job.kind, job.number);
  TRY(choose_model(site.config, ModelKind::hourly));
  auto modelled = TRY(load_modelled_site(std::move(site), now));
  const auto problem = TRY(prepare_diagnosis(modelled));
  const auto done =
      TRY(diagnose_site(modelled, problem,
                        {.rules = {}, .prior_none = modelled.site.config.prior_none, .seed = kSeed},
                        [&](const char* what, double share) { return watch.say(what, share); }));
  modelled.facts.seed = kSeed;
  JobOutcome outcome{.accepted = true,
                     .folder = folder.string(),
                     .result = {.document = views::diagnosis_json(done.diagnosis, problem,
                                                                  modelled.facts, done.others)}};
  TRY(system::make_folder(folder));
  TRY(write_diagnosis(done, modelled, problem, outcome.result.document, metering::to_string(now),
                      folder));
  if (done.diagnosis.added.empty() || done.diagnosis.not_confirmed) {
    outcome.message = "nothing was named";
    return outcome;
  }
  outcome.named = true;
  const auto proposed = propose(modelled, done.diagnosis, problem, now, outcome);
  outcome.message =
      named_words(done.diagnosis) + "; " +
      (proposed ? *proposed
                : "no version of the model could be stored: " + proposed.error().message);
  return outcome;
}

}  // namespace

DoJob make_site_work(SharedSite site, const CalibrateOptions& options) {
  return [site = std::move(site), options](const StoredJob& job, metering::Instant now,
                                           JobWatch& watch) -> Result<JobOutcome> {
    TRY(require_model(site->config));
    if (job.kind == JobKind::diagnosis) return diagnose(on_latest_months(*site), job, now, watch);
    auto outcome = calibrate(*site, options, job, now, watch);
    return outcome ? outcome : with_known_weather(outcome.error(), site, now);
  };
}

CheckWeather make_weather_check(SharedSite site) {
  return [site = std::move(site)](
             const metering::MonthRange& months) -> Result<std::vector<MonthWeather>> {
    if (!site->config.weather) return std::vector<MonthWeather>{};
    const auto live = TRY(open_sensors(site->config));
    return known_weather(site->config, site->calendar, months, live.get());
  };
}

}  // namespace recald::daemon
