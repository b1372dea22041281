#include "daemon/site/results/result_folder.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace recald::daemon {
namespace {

bool holds_converged(const std::filesystem::path& folder) {
  std::ifstream in(folder / "calibration.json");
  const auto json = nlohmann::json::parse(in, nullptr, /*allow_exceptions=*/false);
  return json.is_object() && json.value("status", "") == "converged";
}

}  // namespace

std::filesystem::path result_folder(const std::filesystem::path& out, bool converged,
                                    bool draws_given) {
  if (converged || (draws_given && !holds_converged(out))) return out;
  return out / "unconverged";
}

void clear_results(const std::filesystem::path& folder) {
  std::error_code ignored;  // what cannot be removed cannot be written either, and that is reported
  std::filesystem::remove(folder / "calibration.json", ignored);
  for (const char* name :
       {"screen.json", "metamodel.json", "profile.json", "points.json", "report.html"}) {
    std::filesystem::remove(folder / name, ignored);
  }
  for (int chain = 1;
       std::filesystem::remove(folder / ("draws_" + std::to_string(chain) + ".csv"), ignored);
       ++chain) {
  }
}

std::string kept_sentence(const std::filesystem::path& folder) {
  return "the chains have not converged, so what stands in '" + folder.parent_path().string() +
         "' is kept; this one is in '" + folder.string() +
         "'. Leave the number of draws to recald, or give more";
}

}  // namespace recald::daemon
