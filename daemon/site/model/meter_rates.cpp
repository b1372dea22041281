#include "daemon/site/model/meter_rates.hpp"

#include <vector>

namespace recald::daemon {

tariff::Rates rates_of(const SiteConfig& site, const MeterRecord& record) {
  std::vector<model::HourlyLoad> hours;
  for (const auto& [month, loads] : record.hours) {
    hours.insert(hours.end(), loads.begin(), loads.end());
  }
  return tariff::rates_of(site.tariff, record.meter.utility, hours, site.holidays);
}

}  // namespace recald::daemon
