#include "daemon/site/results/report_parts.hpp"

#include <limits>

#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"

namespace recald::daemon {
namespace {

views::HourStatus status_of(const model::HourlyLoad& hour) {
  if (hour.suspect) return views::HourStatus::suspect;
  if (hour.ok_share <= 0.0) return views::HourStatus::missing;
  return hour.ok_share < 1.0 ? views::HourStatus::partly_filled : views::HourStatus::ok;
}

}  // namespace

views::SiteLine site_line_of(const SiteConfig& site) { return {site.id, site.name, site.timezone}; }

views::LoadGrid load_of(const MeterRecord& record, display::UnitSystem system) {
  views::LoadGrid grid{.meter = display::meter_label(record.meter.id),
                       .units = display::meter_units(system, record.meter.utility)};
  if (record.hours.empty()) return grid;
  grid.first_day = record.hours.begin()->first / 1;
  const metering::Month last = record.hours.rbegin()->first;
  const std::chrono::sys_days begin{grid.first_day};
  const std::chrono::sys_days end{metering::next_month(last) / 1};
  const auto cells = static_cast<std::size_t>((end - begin).count()) * 24;
  grid.mean_kW.assign(cells, std::numeric_limits<float>::quiet_NaN());
  grid.status.assign(cells, views::HourStatus::missing);
  for (const auto& [month, hours] : record.hours) {
    for (const model::HourlyLoad& hour : hours) {
      const auto day = (std::chrono::sys_days{hour.date} - begin).count();
      const auto cell = static_cast<std::size_t>(day * 24 + hour.hour);
      grid.mean_kW[cell] = static_cast<float>(hour.mean_kW);
      grid.status[cell] = status_of(hour);
    }
  }
  return grid;
}

}  // namespace recald::daemon
