#include "daemon/results/result_folder.hpp"

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

std::filesystem::path result_folder(const std::filesystem::path& out, bool converged) {
  return !converged && holds_converged(out) ? out / "unconverged" : out;
}

std::string kept_sentence(const std::filesystem::path& folder) {
  return "the chains have not converged, so the calibration that stands in '" +
         folder.parent_path().string() + "' is kept; this one is in '" + folder.string() +
         "'. Leave the number of draws to recald, or give more";
}

}  // namespace recald::daemon
