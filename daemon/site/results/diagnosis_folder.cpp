#include "daemon/site/results/diagnosis_folder.hpp"
#include "daemon/site/results/report_parts.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "adapters/system/files/write_file.hpp"
#include "adapters/views/diagnosis/diagnosis_page.hpp"
#include "adapters/views/diagnosis/diagnosis_report.hpp"
#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "adapters/views/frame/most_likely.hpp"

namespace recald::daemon {
namespace {

/// A report that is not there, or of other data, stays as it is.
Result<void> complete_report(const std::filesystem::path& folder, const std::string& data_revision,
                             const std::string& most_likely) {
  std::ifstream in(folder / "report.html", std::ios::binary);
  if (!in) return {};
  std::ostringstream page;
  page << in.rdbuf();
  auto completed = views::with_most_likely(std::move(page).str(), data_revision, most_likely);
  if (!completed) return {};
  return system::write_file(folder / "report.html", *completed);
}

}  // namespace

Result<void> write_diagnosis(const SiteDiagnosis& done, const ModelledSite& modelled,
                             const diagnosis::SiteProblem& problem, const std::string& json,
                             const std::string& at, const std::filesystem::path& folder) {
  const std::string page = views::render_diagnosis(
      views::diagnosis_report_of(site_line_of(modelled.site.config), done.diagnosis, problem,
                                 modelled.facts, at, done.others));
  // The old one goes before a new page comes, so that no interruption leaves a result beside the
  // page of another.
  std::error_code ignored;  // what cannot be removed cannot be written either, which is reported
  std::filesystem::remove(folder / "diagnosis.json", ignored);
  if (auto written = system::write_file(folder / "diagnosis.html", page); !written) return written;
  if (auto written = system::write_file(folder / "diagnosis.json", json); !written) return written;
  return complete_report(folder, modelled.facts.data_revision,
                         views::most_likely_words(done.diagnosis, problem));
}

std::string most_likely_in(const std::filesystem::path& folder, const std::string& data_revision) {
  std::ifstream in(folder / "diagnosis.json");
  const auto json = nlohmann::json::parse(in, nullptr, /*allow_exceptions=*/false);
  const auto text = [&](const char* key) {
    if (!json.is_object() || !json.contains(key) || !json[key].is_string()) return std::string{};
    return json[key].get<std::string>();
  };
  return text("data_revision") == data_revision ? text("most_likely") : "";
}

}  // namespace recald::daemon
