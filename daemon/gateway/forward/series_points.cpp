#include "daemon/gateway/forward/series_points.hpp"

#include "daemon/gateway/forward/outgoing_names.hpp"

namespace recald::daemon {
namespace {

using SeriesLabels = std::vector<std::pair<std::string, std::string>>;

SeriesLabels labels_of(const SiteConfig& site, const OutgoingMeter& meter) {
  SeriesLabels labels{{"site", site.id}, {"meter", meter.id}};
  if (!meter.quantity.empty()) labels.emplace_back("quantity", meter.quantity);
  if (!meter.utility.empty()) labels.emplace_back("utility", meter.utility);
  return labels;
}

series::Point interval_point(const SiteConfig& site, const OutboxEntry& entry,
                             const StoredInterval& interval) {
  const OutgoingMeter meter = outgoing_meter(site, entry.meter);
  const bool is_weather = !meter.quantity.empty();
  const metering::Reading& reading = interval.reading;
  return {.measurement = is_weather ? "recald_weather_interval" : "recald_interval",
          .labels = labels_of(site, meter),
          .time = reading.start + entry.interval,
          .fields = {{is_weather ? "mean" : "mean_kilowatts", reading.mean_kW},
                     {"validity", static_cast<double>(reading.validity)},
                     {"revision", static_cast<double>(interval.revision)}}};
}

series::Point month_point(const SiteConfig& site, const metering::LocalCalendar& calendar,
                          const OutboxEntry& entry, const metering::MonthlyFigure& figure) {
  series::Point point{.measurement = "recald_month",
                      .labels = labels_of(site, outgoing_meter(site, entry.meter)),
                      .time = calendar.month_span(figure.month).end,
                      .fields = {{"daily_average_kilowatthours", figure.daily_average_kWh},
                                 {"coverage_ratio", figure.coverage},
                                 {"is_usable", figure.usable ? 1.0 : 0.0},
                                 {"revision", static_cast<double>(figure.revision)}}};
  if (figure.peak) point.fields.push_back({"peak_kilowatts", figure.peak->kW});
  return point;
}

}  // namespace

std::vector<series::Point> series_points(const SiteConfig& site,
                                         const metering::LocalCalendar& calendar,
                                         const OutgoingBatch& batch) {
  std::vector<series::Point> points;
  for (const OutboxEntry& entry : batch.entries) {
    if (const auto* const interval = std::get_if<StoredInterval>(&entry.stored)) {
      points.push_back(interval_point(site, entry, *interval));
    } else if (const auto* const month = std::get_if<StoredMonth>(&entry.stored)) {
      points.push_back(month_point(site, calendar, entry, month->figure));
    }
  }
  return points;
}

}  // namespace recald::daemon
