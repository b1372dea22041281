/// A site with all that a model of it is made from: readings, weather, and what results carry
/// along.
#pragma once

#include <functional>

#include "core/metering/civil_time.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/model/run_facts.hpp"
#include "daemon/site/replay/recording.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

struct OpenSite {
  SiteConfig config;
  metering::LocalCalendar calendar;
};

/// First calibration month to last validation month. @pre site.period
[[nodiscard]] metering::MonthRange whole_period(const SiteConfig& site);

/// Whether the site can be modelled at all; the sentence says what is missing.
[[nodiscard]] Result<void> require_model(const SiteConfig& site);

struct ModelledSite {
  OpenSite site;
  Recording recording;
  SiteWeather weather;
  RunFacts facts;
};

/// A site's readings, from its files and, where it has live meters, from its store, every month
/// closed by the rules of the site file.
[[nodiscard]] Result<Recording> record_site(const OpenSite& site, const ReplayOptions& options,
                                            VirtualClock& clock,
                                            const OnMonthClosed& on_month_closed);

/// The months to model, from what was recorded until `now`.
using ChoosePeriod = std::function<Result<PeriodConfig>(
    const OpenSite& site, const Recording& recording, metering::Instant now)>;

/// Reads everything that the model needs. Of live meters it takes the months that the daemon has
/// closed, in the revision that the API shows, and of their readings those of the period, for
/// profiles, diagnoses, days and pictures. Live meters that it has no use for are no part of the
/// site that is returned, so they neither mark months as different nor stand in reports; meters in
/// files do, since they are read anyway.
/// @param now     A site without a [period] is modelled on the latest months that are closed then.
/// @param choose  In the place of both; absent: as the site file says.
/// @return or what is missing. Of a site without a model every meter is read.
[[nodiscard]] Result<ModelledSite> load_modelled_site(OpenSite site, metering::Instant now,
                                                      const ChoosePeriod& choose = {});

/// The last `recalibration.months` months that all modelled meters have closed; without a model,
/// that any meter has.
/// @return not_enough_data when there is none.
[[nodiscard]] Result<metering::MonthRange> latest_months(const OpenSite& site,
                                                         const Recording& recording,
                                                         metering::Instant now);

}  // namespace recald::daemon
