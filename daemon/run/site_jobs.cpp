#include "daemon/run/site_jobs.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/system/write_file.hpp"
#include "daemon/calibrate/active_effects.hpp"
#include "daemon/calibrate/finished_calibration.hpp"
#include "daemon/calibrate/site_on_design.hpp"
#include "daemon/diagnose/diagnosis_files.hpp"
#include "daemon/diagnose/site_diagnosis.hpp"
#include "daemon/drift/drift_json.hpp"
#include "daemon/drift/drift_report.hpp"
#include "daemon/drift/site_drift.hpp"
#include "daemon/results/calibration_files.hpp"

namespace recald::daemon {
namespace {

constexpr int kDriftParticles = 256;
constexpr std::uint64_t kSeed = 1;  // a result must not depend on how often one asked before

std::filesystem::path folder_of(const SiteConfig& site, const StoredJob& job) {
  return results_folder(site) / fmt::format("{}-{}", name_of(job.kind), job.number);
}

JobOutcome outcome_of(const AssessedCalibration& calibration, const RunFacts& facts,
                      const std::filesystem::path& folder) {
  JobOutcome outcome{.accepted = calibration.calibration.converged,
                     .folder = folder.string(),
                     .result = calibration_json(calibration, facts)};
  if (!outcome.accepted) {
    outcome.message = "the chains have not converged, so the result before stays in use";
  }
  return outcome;
}

Result<JobOutcome> calibrate_metamodel(const ModelledSite& modelled,
                                       const std::filesystem::path& design,
                                       const std::filesystem::path& folder,
                                       const calibration::RunContext& context) {
  const auto done = calibrate_on_design(modelled, design, context);
  if (!done) return tl::unexpected(done.error());
  JobOutcome outcome = outcome_of(done->calibration, done->facts, folder);
  if (auto written = write_calibration(*done, outcome.result, folder); !written) {
    return tl::unexpected(written.error());
  }
  return outcome;
}

/// What all months say, beside a calibration that stands by itself.
/// @return or why there is nothing to say: too few months, a model that cannot be followed.
Result<SiteDrift> follow(OpenSite site, metering::Instant now,
                         const calibration::RunContext& context,
                         const std::filesystem::path& folder) {
  const DriftOptions options{.sequential = {.particles = kDriftParticles}};
  auto modelled = load_modelled_site(
      std::move(site), now,
      [&](const OpenSite& open, const Recording& recording, metering::Instant until) {
        return followed_period(open, recording, until, options.learning_months);
      });
  if (!modelled) return tl::unexpected(modelled.error());
  auto version = active_version(modelled->site.config);
  if (!version) return tl::unexpected(version.error());
  auto drift = follow_site(*modelled, options, std::move(version->effects), context);
  if (!drift) return drift;
  modelled->facts.seed = context.seed;
  auto written = write_drift(modelled->site.config, *drift, modelled->facts,
                             metering::to_string(now), drift_json(*drift, modelled->facts), folder);
  if (!written) return tl::unexpected(written.error());
  return drift;
}

Result<JobOutcome> calibrate(OpenSite site, const StoredJob& job, metering::Instant now,
                             const GoesOn& goes_on) {
  const auto folder = folder_of(site.config, job);
  const OpenSite whole = site;
  auto modelled = load_modelled_site(std::move(site), now);
  if (!modelled) return tl::unexpected(modelled.error());
  const calibration::RunContext context{
      .seed = kSeed, .observer = [&](const calibration::Progress&) { return goes_on(); }};
  if (const auto& design = modelled->site.config.recalibration.design; !design.empty()) {
    return calibrate_metamodel(*modelled, design, folder, context);
  }
  const auto done = finish_calibration(std::move(*modelled), {}, context);
  if (!done) return tl::unexpected(done.error());
  JobOutcome outcome = outcome_of(done->calibration, done->modelled.facts, folder);
  const auto written = write_calibration(*done, outcome.result, metering::to_string(now), folder);
  if (!written) return tl::unexpected(written.error());
  const auto drift = follow(whole, now, context, folder);
  if (!drift && drift.error().code == ErrorCode::cancelled) return tl::unexpected(drift.error());
  outcome.result = drift ? with_drift(outcome.result, *drift)
                         : without_drift(outcome.result, drift.error().message);
  return outcome;
}

Result<JobOutcome> diagnose(OpenSite site, const StoredJob& job, metering::Instant now,
                            const GoesOn& goes_on) {
  const auto folder = folder_of(site.config, job);
  site.config.model->kind = "hourly";
  auto modelled = load_modelled_site(std::move(site), now);
  if (!modelled) return tl::unexpected(modelled.error());
  const auto problem = prepare_diagnosis(*modelled);
  if (!problem) return tl::unexpected(problem.error());
  const auto done = diagnose_site(*modelled, *problem, {.rules = {}, .seed = kSeed},
                                  [&](const char*, double) { return goes_on(); });
  if (!done) return tl::unexpected(done.error());
  modelled->facts.seed = kSeed;
  JobOutcome outcome{
      .accepted = true,
      .folder = folder.string(),
      .result = diagnosis_json(done->diagnosis, *problem, modelled->facts, done->others)};
  if (auto made = system::make_folder(folder); !made) return tl::unexpected(made.error());
  const auto written =
      write_diagnosis(*done, *modelled, *problem, outcome.result, metering::to_string(now), folder);
  if (!written) return tl::unexpected(written.error());
  return outcome;
}

}  // namespace

std::filesystem::path results_folder(const SiteConfig& site) {
  return site.store.file.parent_path() / (site.store.file.stem().string() + "-results");
}

DoJob make_site_work(OpenSite site) {
  return [site = std::move(site)](const StoredJob& job, metering::Instant now,
                                  const GoesOn& goes_on) -> Result<JobOutcome> {
    if (auto modelled = require_model(site.config); !modelled) {
      return tl::unexpected(modelled.error());
    }
    OpenSite latest = site;
    latest.config.period.reset();
    return job.kind == JobKind::calibration ? calibrate(std::move(latest), job, now, goes_on)
                                            : diagnose(std::move(latest), job, now, goes_on);
  };
}

}  // namespace recald::daemon
