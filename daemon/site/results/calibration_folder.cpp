#include "daemon/site/results/calibration_folder.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "adapters/system/files/write_file.hpp"
#include "adapters/views/calibration/report.hpp"
#include "adapters/views/meters/meters_page.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/design_files.hpp"
#include "daemon/site/results/diagnosis_folder.hpp"
#include "daemon/site/results/meters_report.hpp"
#include "daemon/site/results/report_of.hpp"
#include "daemon/site/results/result_folder.hpp"

namespace recald::daemon {
namespace {

struct ResultFile {
  std::string name;
  std::string text;
};

/// The draws, these files and, last, calibration.json.
Result<void> write_files(const assessment::AssessedCalibration& result, const RunFacts& facts,
                         const std::vector<ResultFile>& files, const std::string& json,
                         const std::filesystem::path& folder) {
  if (auto made = system::make_folder(folder); !made) return made;
  clear_results(folder);
  for (std::size_t chain = 0; chain < result.calibration.chains.size(); ++chain) {
    const auto file = folder / fmt::format("draws_{}.csv", chain + 1);
    auto written = system::write_file(file, draws_csv(result, chain, facts));
    if (!written) return written;
  }
  if (result.calibration.predictions) {
    auto written = system::write_file(folder / "points.json", points_json(result));
    if (!written) return written;
  }
  for (const ResultFile& file : files) {
    if (auto written = system::write_file(folder / file.name, file.text); !written) return written;
  }
  return system::write_file(folder / "calibration.json", json);
}

}  // namespace

std::string render(const FinishedCalibration& done, const std::string& generated_at,
                   const std::string& most_likely, std::vector<views::ComparedModel> compared) {
  const ModelledSite& modelled = done.modelled;
  const OpenSite& site = modelled.site;
  if (!done.calibration.not_calibrated_because.empty()) {
    return views::render_meters(meters_report_of(site.config, site.calendar, modelled.recording,
                                                 {&modelled.weather, &done.calibration, ""},
                                                 modelled.facts, generated_at));
  }
  views::ReportData data = report_of(site.config, site.calendar, modelled.recording,
                                     done.calibration, modelled.facts, generated_at);
  data.most_likely = most_likely;
  data.compared = std::move(compared);
  return views::render_report(data);
}

Result<void> write_calibration(const FinishedCalibration& done, const std::string& json,
                               const std::string& generated_at, const std::filesystem::path& folder,
                               std::vector<views::ComparedModel> compared) {
  const RunFacts& facts = done.modelled.facts;
  std::vector<ResultFile> files{
      {"months.csv", months_csv(done.modelled.recording, facts.time_zone_data)}};
  if (const auto& design = done.calibration.design) {
    files.push_back({"screen.json", screen_json(design->screening, design->folder.parameters,
                                                design->folder.notes, facts)});
    files.push_back(
        {"metamodel.json", metamodel_json(design->fitted, design->fitted.notes, facts)});
  } else if (done.calibration.not_calibrated_because.empty()) {  // the profile is a model's
    files.push_back({"profile.json", profile_json(done.calibration.profile)});
  }
  files.push_back(
      {"report.html", render(done, generated_at, most_likely_in(folder, facts.data_revision),
                             std::move(compared))});
  return write_files(done.calibration, facts, files, json, folder);
}

Result<void> write_calibration(const FinishedDesign& done, const std::string& months,
                               const std::string& json, const std::string& generated_at,
                               const std::filesystem::path& folder) {
  const DesignCalibration& result = done.calibration;
  std::vector<ResultFile> files{{"months.csv", months}};
  if (result.screening) {
    files.push_back({"screen.json", screen_json(*result.screening, done.design.parameters,
                                                done.design.notes, done.facts)});
  }
  if (result.fitted) {
    files.push_back(
        {"metamodel.json", metamodel_json(*result.fitted, result.fitted->notes, done.facts)});
  }
  files.push_back({"report.html", views::render_report(report_of(done, generated_at))});
  return write_files(result, done.facts, files, json, folder);
}

}  // namespace recald::daemon
