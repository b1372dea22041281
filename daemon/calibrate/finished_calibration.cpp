#include "daemon/calibrate/finished_calibration.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/report/report.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/calibrate/active_effects.hpp"
#include "daemon/results/calibration_files.hpp"
#include "daemon/results/report_of.hpp"
#include "daemon/results/result_folder.hpp"

namespace recald::daemon {

Result<FinishedCalibration> finish_calibration(ModelledSite modelled,
                                               const CalibrateOptions& options,
                                               const calibration::RunContext& context) {
  auto version = active_version(modelled.site.config);
  if (!version) return tl::unexpected(version.error());
  modelled.facts.model_version = version_name(*version, modelled.facts.model_version);
  auto calibrated = calibrate_site(modelled.site.config, modelled.site.calendar, modelled.recording,
                                   modelled.weather, options, context, std::move(version->effects));
  if (!calibrated) return tl::unexpected(calibrated.error());
  modelled.facts = with_sampling(std::move(modelled.facts), context.seed, calibrated->calibration);
  return FinishedCalibration{std::move(modelled), std::move(*calibrated)};
}

std::string render(const FinishedCalibration& done, const std::string& generated_at) {
  const ModelledSite& modelled = done.modelled;
  return report::render_report(report_of(modelled.site.config, modelled.site.calendar,
                                         modelled.recording, done.calibration, modelled.facts,
                                         generated_at));
}

Result<void> write_calibration(const FinishedCalibration& done, const std::string& json,
                               const std::string& generated_at,
                               const std::filesystem::path& folder) {
  if (auto made = system::make_folder(folder); !made) return made;
  clear_results(folder);
  const RunFacts& facts = done.modelled.facts;
  for (std::size_t chain = 0; chain < done.calibration.calibration.chains.size(); ++chain) {
    const auto file = folder / fmt::format("draws_{}.csv", chain + 1);
    auto written = system::write_file(file, draws_csv(done.calibration, chain, facts));
    if (!written) return written;
  }
  const auto write = [&](const char* name, const std::string& text) {
    return system::write_file(folder / name, text);
  };
  if (auto w = write("months.csv", months_csv(done.modelled.recording, facts.time_zone_data)); !w)
    return w;
  if (auto w = write("profile.json", profile_json(done.calibration.profile)); !w) return w;
  if (auto w = write("report.html", render(done, generated_at)); !w) return w;
  return write("calibration.json", json);
}

}  // namespace recald::daemon
