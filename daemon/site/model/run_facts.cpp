#include "daemon/site/model/run_facts.hpp"

#include <set>

#include "adapters/system/files/sha256.hpp"
#include "adapters/system/time_zone_release.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {

Result<RunFacts> facts_of(const SiteConfig& site, const std::string& live_digest) {
  system::Sha256 site_digest;
  system::Sha256 data_digest;
  for (system::Sha256* digest : {&site_digest, &data_digest}) {
    if (!site.unwritten.empty()) {
      digest->add(site.unwritten);
    } else if (auto added = digest->add_file(site.file); !added) {
      return tl::unexpected(added.error());
    }
  }
  std::set<std::filesystem::path> files;
  for (const MeterConfig& meter : site.meters) {
    files.insert(meter.files.begin(), meter.files.end());
  }
  if (site.weather) files.insert(site.weather->files.begin(), site.weather->files.end());
  for (const auto& file : files) {
    TRY(data_digest.add_file(file));
  }
  if (site.model && site.model->energyplus) {
    for (const char* name : {"priors.csv", "doe_inputs.csv", "doe_outputs.csv"}) {
      const auto file = site.model->energyplus->design / name;
      std::error_code ignored;
      if (!std::filesystem::exists(file, ignored)) continue;  // its runs are still to be made
      TRY(data_digest.add_file(file));
    }
  }
  data_digest.add(live_digest);
  RunFacts facts;
  facts.recald_version = kVersion;
  facts.data_revision = data_digest.hex();
  facts.model_version = std::string{site.model ? name_of(site.model->kind) : "none"} + "-" +
                        site_digest.hex().substr(0, 12);
  facts.time_zone_data = system::time_zone_release();
  return facts;
}

Result<RunFacts> facts_of_files(const std::vector<std::filesystem::path>& files,
                                std::string_view model) {
  system::Sha256 digest;
  for (const auto& file : files) {
    TRY(digest.add_file(file));
  }
  RunFacts facts;
  facts.recald_version = kVersion;
  facts.data_revision = digest.hex();
  facts.model_version = std::string{model} + "-" + facts.data_revision.substr(0, 12);
  return facts;
}

RunFacts with_sampling(RunFacts facts, std::uint64_t seed,
                       const calibration::Calibration& calibration) {
  const calibration::SamplingReport& report = calibration.sampling;
  facts.sampler = report.sampler;
  facts.hyper_prior_profile = calibration.hyper_prior.name;
  facts.seed = seed;
  facts.iterations = report.burn_in + report.kept;
  facts.burn_in = report.burn_in;
  facts.chains = static_cast<int>(calibration.chains.size());
  facts.design_runs = static_cast<int>(calibration.design.theta.rows());
  return facts;
}

}  // namespace recald::daemon
