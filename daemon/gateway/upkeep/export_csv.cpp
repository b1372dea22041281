#include "daemon/gateway/upkeep/export_csv.hpp"

#include <fmt/format.h>

#include <cmath>

namespace recald::daemon {
namespace {

/// The shortest text that reads back as the same number; empty if it is not finite.
std::string csv_number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

std::string reading_line(const std::string& meter, const metering::Reading& reading) {
  return fmt::format("{},{},{},kW,{},{},{}\n", metering::to_string(reading.start), meter,
                     csv_number(reading.mean_kW), metering::to_string(reading.validity),
                     reading.late ? 1 : 0, metering::to_string(reading.reasons));
}

std::string month_line(const std::string& meter, const StoredMonth& month) {
  const metering::MonthlyFigure& figure = month.figure;
  return fmt::format("{},{},{},kWh/day,{},{},{},{},block-{}s,{},{}\n",
                     metering::to_string(figure.month), meter, csv_number(figure.daily_average_kWh),
                     csv_number(figure.coverage), csv_number(figure.filled_share),
                     figure.peak ? csv_number(figure.peak->kW) : "",
                     figure.peak ? metering::to_string(figure.peak->start) : "",
                     figure.peak_window.count(), figure.revision, month.time_zone_release);
}

}  // namespace

Result<void> export_readings(IntervalStore& store, std::span<const StoredMeter> meters,
                             const metering::TimeSpan& span, std::ostream& out) {
  out << "timestamp,meter,value,unit,validity,late,reasons\n";
  for (const StoredMeter& meter : meters) {
    const auto read =
        store.for_each_interval(meter.number, span, [&](const StoredInterval& interval) {
          out << reading_line(meter.meter.id, interval.reading);
        });
    if (!read) return read;
  }
  return {};
}

Result<void> export_months(MonthStore& store, const metering::LocalCalendar& calendar,
                           std::span<const StoredMeter> meters, const metering::TimeSpan& span,
                           std::ostream& out) {
  out << "month,meter,value,unit,coverage,filled_share,peak_kW,peak_at,method,revision,tzdata\n";
  for (const StoredMeter& meter : meters) {
    const auto months = TRY(store.months(meter.number));
    for (const StoredMonth& month : months) {
      if (!span.contains(calendar.month_span(month.figure.month).begin)) continue;
      out << month_line(meter.meter.id, month);
    }
  }
  return {};
}

}  // namespace recald::daemon
