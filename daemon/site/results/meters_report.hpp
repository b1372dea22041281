/// The page of a site's meters alone, from what was recorded of them.
#pragma once

#include <optional>
#include <string>

#include "adapters/views/meters/meters_page.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// A page with the hours of more meters is slow to open, and nobody reads it.
inline constexpr std::size_t kMetersOnPage = 24;

/// What the outdoor temperature says of the meters; both or neither of the pointers.
struct MeterForecasts {
  const SiteWeather* weather = nullptr;
  const SiteCalibration* forecast = nullptr;  ///< As `forecast_meters` leaves it.
  std::string lacking;                        ///< Why there is none, as a sentence.
};

[[nodiscard]] views::MetersData meters_report_of(const SiteConfig& site,
                                                 const metering::LocalCalendar& calendar,
                                                 const Recording& recording,
                                                 const MeterForecasts& forecasts,
                                                 const RunFacts& facts, std::string generated_at);

/// Meters that were recorded without their weather: reads it and regresses them, where the site has
/// one. Without a [period] all months that any meter has, the last twelve of two years unseen. What
/// fails of that stands on the page.
/// @return the page, or not_found or io_failed for a file of the meters.
[[nodiscard]] Result<std::string> render_meters_of(const OpenSite& site, const Recording& recording,
                                                   std::string generated_at);

}  // namespace recald::daemon
