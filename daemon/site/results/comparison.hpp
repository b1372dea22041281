/// The models of one site beside each other.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adapters/views/frame/report_data.hpp"
#include "core/result.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"

namespace recald::daemon {

/// One of the site's models: calibrated, or why not.
struct SiteModelResult {
  ModelKind kind;
  Result<FinishedCalibration> done;
};

/// "EPC", "Hourly model", "EnergyPlus"
[[nodiscard]] std::string model_label(ModelKind kind);

/// What the page shows of them.
[[nodiscard]] std::vector<views::ComparedModel> compared_models(
    const std::vector<SiteModelResult>& models);

/// For comparison.json: fits of each model by output, medians and intervals of its parameters.
[[nodiscard]] nlohmann::ordered_json comparison_json(const std::vector<SiteModelResult>& models);

/// For the console: a line a model and meter.
[[nodiscard]] std::string comparison_words(const std::vector<SiteModelResult>& models);

}  // namespace recald::daemon
