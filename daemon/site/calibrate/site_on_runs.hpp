/// A site whose model is too slow to be sampled: its runs, and the meta-model that speaks for them.
#pragma once

#include <functional>
#include <vector>

#include "adapters/doe/days_file.hpp"
#include "core/regression/design_data.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// Screens the design in the model's folder, fits the monthly form, and makes a model of the
/// influential parameters out of it. The others stay at their prior means; what they could move an
/// output is an error common to its months.
/// @return the site; or not_found: there are no runs yet; not_enough_data: some are missing, or
///         months of the site are not among them; invalid_value: the site file asks for other
///         parameters, priors or outputs than were run; or what screening and fitting find.
/// @pre the site's model is of kind energyplus
[[nodiscard]] Result<PreparedSite> prepare_on_runs(const SiteConfig& site,
                                                   const metering::LocalCalendar& calendar,
                                                   const Recording& recording,
                                                   const SiteWeather& weather);

/// Gives the days of a design's runs.
using DaysOfDesign = std::function<Result<doe::DesignDays>(const doe::DesignFolder& design)>;

/// Runs as fits read them: in the months and outputs of a site. Months that were not
/// simulated are predicted from the runs' days.
/// @param so_far   Its months and outputs.
/// @param days_of  Asked if there are such months.
/// @return or not_enough_data, invalid_value: months or outputs that the runs do not have.
[[nodiscard]] Result<regression::DesignData> data_in_site_months(const ModelledSite& modelled,
                                                                 const SiteCalibration& so_far,
                                                                 doe::DesignFolder design,
                                                                 const DaysOfDesign& days_of);

}  // namespace recald::daemon
