#include "daemon/site/results/report_parts.hpp"

#include <limits>

#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "daemon/site/results/diagnosis_words.hpp"

namespace recald::daemon {
namespace {

report::HourStatus status_of(const profile::HourlyLoad& hour) {
  if (hour.suspect) return report::HourStatus::suspect;
  if (hour.ok_share <= 0.0) return report::HourStatus::missing;
  return hour.ok_share < 1.0 ? report::HourStatus::partly_filled : report::HourStatus::ok;
}

}  // namespace

report::Provenance provenance_of(const RunFacts& facts) {
  return {.recald_version = facts.recald_version,
          .data_revision = facts.data_revision,
          .model_version = facts.model_version,
          .time_zone_data = facts.time_zone_data,
          .weather_values = facts.weather_values,
          .sampler = facts.sampler,
          .hyper_prior_profile = facts.hyper_prior_profile,
          .seed = facts.seed,
          .iterations = facts.iterations,
          .burn_in = facts.burn_in,
          // No computing time: the same data and seed give the same page.
          .chains = facts.chains};
}

report::LoadGrid load_of(const MeterRecord& record, display::UnitSystem system) {
  report::LoadGrid grid{.meter = display::meter_label(record.meter.id),
                        .units = display::meter_units(system, record.meter.utility)};
  if (record.hours.empty()) return grid;
  grid.first_day = record.hours.begin()->first / 1;
  const metering::Month last = record.hours.rbegin()->first;
  const std::chrono::sys_days begin{grid.first_day};
  const std::chrono::sys_days end{metering::next_month(last) / 1};
  const auto cells = static_cast<std::size_t>((end - begin).count()) * 24;
  grid.mean_kW.assign(cells, std::numeric_limits<float>::quiet_NaN());
  grid.status.assign(cells, report::HourStatus::missing);
  for (const auto& [month, hours] : record.hours) {
    for (const profile::HourlyLoad& hour : hours) {
      const auto day = (std::chrono::sys_days{hour.date} - begin).count();
      const auto cell = static_cast<std::size_t>(day * 24 + hour.hour);
      grid.mean_kW[cell] = static_cast<float>(hour.mean_kW);
      grid.status[cell] = status_of(hour);
    }
  }
  return grid;
}

}  // namespace recald::daemon
