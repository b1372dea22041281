/// What measures would save at a calibrated site.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/display/unit.hpp"
#include "core/metering/reading.hpp"
#include "core/result.hpp"
#include "core/savings/estimate.hpp"
#include "core/savings/measure.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"

namespace recald::daemon {

/// Of one output of the model.
struct MeterSaving {
  std::string output;  ///< "steam_daily_kWh", "steam_peak_kW"
  std::string meter;
  metering::Utility utility;
  bool is_peak;
  /// What it uses without the measure: kWh over the months that the saving is of, or the mean of
  /// the months' peaks in kW. As measured; where it was not, as modelled.
  double baseline;
  savings::Estimate saved;  ///< kWh, or kW of the mean monthly peak.
  std::optional<savings::Estimate> money;
  std::optional<savings::Estimate> emissions_kg;
};

struct MeasureSaving {
  std::string name;
  std::optional<double> cost;
  std::vector<MeterSaving> meters;
  std::optional<savings::Estimate> money;  ///< Of all meters that have a price.
  std::optional<savings::Estimate> emissions_kg;
  std::optional<savings::Payback> payback;
  std::vector<std::string> notes;  ///< What the calibration cannot know of it; sentences.
};

struct SiteSavings {
  bool is_year;  ///< Savings are of a year; else of the months alone, which are no year.
  std::vector<std::string> months;
  int draws;
  /// In the order of the file; behind two and more, all of them together.
  std::vector<MeasureSaving> measures;
  std::vector<std::string> notes;  ///< What holds for all of them.
};

/// How a combination of all measures is called.
inline constexpr const char* kAllTogether = "All measures together";

/// Draws of the posterior go through the model without and with each measure, in the calibration
/// months brought to a year. Parameters are what they mean in the model, levels of meters multiply
/// a saving, the discrepancy cancels (core/savings/drawn_errors.hpp). Quantities that are not
/// calibrated are drawn from their priors; of lights and plugs together the meter knows the sum.
///
/// @return the savings; not_enough_data if the site was not calibrated; not_finite when the model
///         gives a value that is not; or what `draw_errors` finds.
/// @pre the measures were checked against the site
[[nodiscard]] Result<SiteSavings> savings_of(const FinishedCalibration& finished,
                                             const std::vector<savings::Measure>& measures,
                                             const calibration::RunContext& context);

}  // namespace recald::daemon
