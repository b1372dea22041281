#include "daemon/site/results/diagnosis_folder.hpp"

#include "adapters/report/diagnosis_page.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/site/results/diagnosis_report.hpp"

namespace recald::daemon {

Result<void> write_diagnosis(const SiteDiagnosis& done, const ModelledSite& modelled,
                             const diagnosis::SiteProblem& problem, const std::string& json,
                             const std::string& at, const std::filesystem::path& folder) {
  const std::string page = report::render_diagnosis(diagnosis_report_of(
      modelled.site.config, done.diagnosis, problem, modelled.facts, at, done.others));
  // The old one goes before a new page comes, so that no interruption leaves a result beside the
  // page of another.
  std::error_code ignored;  // what cannot be removed cannot be written either, which is reported
  std::filesystem::remove(folder / "diagnosis.json", ignored);
  if (auto written = system::write_file(folder / "diagnosis.html", page); !written) return written;
  return system::write_file(folder / "diagnosis.json", json);
}

}  // namespace recald::daemon
