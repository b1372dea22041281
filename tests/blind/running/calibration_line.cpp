#include "tests/blind/running/calibration_line.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace recald::blind {
namespace {

/// As calibration.json and the line call them.
constexpr std::array<const char*, 4> kFits{"before", "after", "forecast", "yardstick"};
constexpr std::string_view kOfDays = "_daily_kWh";

}  // namespace

Result<Json> calibration_line(const Json& calibration, const CaseRun& run) {
  Json meters = Json::object();
  for (const char* key : kFits) {
    const auto fits = calibration.find(key);
    if (fits == calibration.end() || !fits->is_object() || !fits->contains("validation")) {
      return failure(ErrorCode::malformed,
                     fmt::format("calibration.json has no '{}' of unseen months", key));
    }
    for (const auto& [output, fit] : fits->at("validation").items()) {
      if (!output.ends_with(kOfDays) || !fit.is_object()) continue;
      const auto cvrmse = fit.find("cvrmse");
      if (cvrmse == fit.end() || !cvrmse->is_number()) continue;
      meters[output.substr(0, output.size() - kOfDays.size())][key] = *cvrmse;
    }
  }
  Json line = line_head(run, "none");
  Json complete = Json::object();
  for (const auto& [meter, fits] : meters.items()) {
    if (fits.size() == kFits.size()) complete[meter] = fits;
  }
  line["calibration"] = complete;
  line["wall_s"] = run.wall_s;
  line["peak_rss_MB"] = run.peak_rss_MB;
  line["extra"]["cpu_s"] = run.cpu_s;
  return line;
}

}  // namespace recald::blind
