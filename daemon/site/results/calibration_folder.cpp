#include "daemon/site/results/calibration_folder.hpp"

#include <fmt/format.h>

#include "adapters/report/meters_page.hpp"
#include "adapters/report/report.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/diagnosis_folder.hpp"
#include "daemon/site/results/meters_report.hpp"
#include "daemon/site/results/report_of.hpp"
#include "daemon/site/results/result_folder.hpp"

namespace recald::daemon {

std::string render(const FinishedCalibration& done, const std::string& generated_at,
                   const std::string& most_likely) {
  const ModelledSite& modelled = done.modelled;
  const OpenSite& site = modelled.site;
  if (!done.calibration.not_calibrated_because.empty()) {
    return report::render_meters(meters_report_of(site.config, site.calendar, modelled.recording,
                                                  {&modelled.weather, &done.calibration, ""},
                                                  modelled.facts, generated_at));
  }
  report::ReportData data = report_of(site.config, site.calendar, modelled.recording,
                                      done.calibration, modelled.facts, generated_at);
  data.most_likely = most_likely;
  return report::render_report(data);
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
  if (done.calibration.not_calibrated_because.empty()) {  // the profile is a model's
    if (auto w = write("profile.json", profile_json(done.calibration.profile)); !w) return w;
  }
  const std::string page = render(done, generated_at, most_likely_in(folder, facts.data_revision));
  if (auto w = write("report.html", page); !w) return w;
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
