#include "daemon/site/results/calibration_folder.hpp"

#include <fmt/format.h>

#include "adapters/report/report.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/report_of.hpp"
#include "daemon/site/results/result_folder.hpp"

namespace recald::daemon {

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
  // Profile and page are a model's.
  if (!done.calibration.not_calibrated_because.empty()) return write("calibration.json", json);
  if (auto w = write("profile.json", profile_json(done.calibration.profile)); !w) return w;
  if (auto w = write("report.html", render(done, generated_at)); !w) return w;
  return write("calibration.json", json);
}

Result<void> write_calibration(const SiteOnDesign& done, const std::string& json,
                               const std::filesystem::path& folder) {
  if (auto made = system::make_folder(folder); !made) return made;
  clear_results(folder);
  for (std::size_t chain = 0; chain < done.calibration.calibration.chains.size(); ++chain) {
    auto written = system::write_file(folder / fmt::format("draws_{}.csv", chain + 1),
                                      draws_csv(done.calibration, chain, done.facts));
    if (!written) return written;
  }
  return system::write_file(folder / "calibration.json", json);
}

}  // namespace recald::daemon
