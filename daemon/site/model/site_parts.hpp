/// The parts of every model of a site: months, electricity, calibration parameters, meters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/assessment/output_assessment.hpp"
#include "core/display/warning.hpp"
#include "core/model/electricity_profile.hpp"
#include "core/model/end_use.hpp"
#include "core/model/parameter_library.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

/// The months of the site's period that have weather.
struct SiteMonths {
  std::vector<metering::Month> all;  ///< Calibration first, then validation.
  std::vector<assessment::MonthRole> roles;
  std::vector<metering::Month> calibration;  ///< The leading part of `all`.

  /// Ascending, without repetition.
  [[nodiscard]] std::vector<metering::Month> in_order() const;
};

/// Leaves out months whose weather is mostly filled in, and says so in words; also reports holes.
[[nodiscard]] SiteMonths choose_months(const PeriodConfig& period, const SiteWeather& weather,
                                       display::Warnings& warnings);

/// The meter that shows lights and plugs: the first modelled electricity meter that counts them, or
/// else the first meter that counts them, or else the first. An index of the site's meters. @pre
/// the site has a model
[[nodiscard]] std::optional<std::size_t> profile_meter(const SiteConfig& site);

/// The record of that meter.
/// @return not_enough_data if the site has none.
[[nodiscard]] Result<const MeterRecord*> electricity_meter(const SiteConfig& site,
                                                           const Recording& recording);

/// The recorded hours of these months, in their order.
[[nodiscard]] std::vector<model::HourlyLoad> loads_of(const MeterRecord& record,
                                                      const std::vector<metering::Month>& months);

/// The parameters that the site file names. @pre the site has a model of a [building]
/// @return or the error of `find_parameter` or `make_parameter`
[[nodiscard]] Result<std::vector<Parameter>> site_parameters(const SiteConfig& site);

/// What each modelled meter measures, in the order of the model's outputs. @pre the
/// site has a model
[[nodiscard]] Result<std::vector<model::MeterMap>> meter_maps(const SiteConfig& site);

}  // namespace recald::daemon
