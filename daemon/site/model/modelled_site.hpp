/// A site with everything needed to model it: readings, weather, and the facts that results carry.
#pragma once

#include <functional>
#include <memory>
#include <utility>

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

/// For parts that keep a site only to read it: the descriptions of a thousand meters are megabytes.
using SharedSite = std::shared_ptr<const OpenSite>;

[[nodiscard]] inline SharedSite share(OpenSite site) {
  return std::make_shared<const OpenSite>(std::move(site));
}

/// First calibration month to last validation month. @pre site.period
[[nodiscard]] metering::MonthRange whole_period(const SiteConfig& site);

/// Whether the site can be modelled; the error says what is missing.
[[nodiscard]] Result<void> require_model(const SiteConfig& site);

/// Puts the site's model of another kind in the first place: one that the site file has, or the
/// first as it would be of that kind, where both are of the site's [building].
/// @return unsupported: the site has no such model. @pre the site has a model
[[nodiscard]] Result<void> choose_model(SiteConfig& site, ModelKind kind);

struct ModelledSite {
  OpenSite site;
  Recording recording;
  SiteWeather weather;
  RunFacts facts;
};

/// A site's readings, from its files and, for live meters, from its store, with every month closed
/// by the rules of the site file.
[[nodiscard]] Result<Recording> record_site(const OpenSite& site, const ReplayOptions& options,
                                            VirtualClock& clock,
                                            const OnMonthClosed& on_month_closed);

/// Chooses the months to model from the months recorded until `now`.
using ChoosePeriod = std::function<Result<PeriodConfig>(
    const OpenSite& site, const Recording& recording, metering::Instant now)>;

/// Reads everything that the model needs. Of live meters it takes the months that the daemon has
/// closed, in the revision that the API shows, and the readings of the period, for profiles,
/// diagnoses, days and figures. Live meters that it does not use are removed from the returned
/// site, so they neither mark months as different nor appear in reports. Meters in files stay,
/// since they are read anyway.
/// @param now     A site without a [period] is modelled on the latest months that
///                are closed by then.
/// @param choose  Replaces both; absent: as the site file says.
/// @return the site, or what is missing. Without a model, every meter is read.
[[nodiscard]] Result<ModelledSite> load_modelled_site(OpenSite site, metering::Instant now,
                                                      const ChoosePeriod& choose = {});

/// The last `recalibration.months` months that are closed for all modelled meters; without a
/// model, for any meter.
/// @return not_enough_data when there is none.
[[nodiscard]] Result<metering::MonthRange> latest_months(const OpenSite& site,
                                                         const Recording& recording,
                                                         metering::Instant now);

}  // namespace recald::daemon
