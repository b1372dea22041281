/// What a site's hourly model expects the meters to read in the hours until now.
///
/// Months, which a model is calibrated on, close days after their end; an operator looks at today.
/// So the model of the drawings runs over the current month with the weather so far, and its band
/// comes from how far the meters were from it in the closed months, at the same hour of such days
/// and at about the same load (core/profile/load_band).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/drift/month_hindcast.hpp"
#include "core/model/end_use.hpp"
#include "core/result.hpp"
#include "daemon/site/model/expected_load.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

class LoadExpectation {
 public:
  /// Of one output: how far forecasts of months that went on were off, as of this day of theirs.
  struct MonthErrors {
    std::optional<drift::HindcastBand> band;
    double mean_kW;
  };

  /// Compares the closed months of the site with its hourly model.
  /// @return or unsupported: the site has no [building]; not_enough_data: no closed month with
  ///         weather, no readings; or an error of reading.
  [[nodiscard]] static Result<LoadExpectation> learn(OpenSite site, metering::Instant now);

  /// @param span  Its months are run as a whole. Hours that have not begun by its end, or of which
  ///              the weather is not known yet, are left out.
  ///              The month of its end is forecast too, from what is known at its end.
  /// @return one per output of the model; or an error of reading the weather.
  [[nodiscard]] Result<std::vector<ExpectedMeter>> expect(const metering::TimeSpan& span) const;

 private:
  LoadExpectation(OpenSite site, model::ElectricLoads loads, std::vector<model::MeterMap> maps,
                  std::vector<profile::LoadBand> bands, std::vector<MonthErrors> errors)
      : site_(std::move(site)),
        loads_(std::move(loads)),
        maps_(std::move(maps)),
        bands_(std::move(bands)),
        errors_(std::move(errors)) {}

  OpenSite site_;  ///< Its first model is the hourly one.
  model::ElectricLoads loads_;
  std::vector<model::MeterMap> maps_;     ///< (outputs)
  std::vector<profile::LoadBand> bands_;  ///< (outputs)
  std::vector<MonthErrors> errors_;       ///< (outputs)
};

}  // namespace recald::daemon
