#include "daemon/gateway/upkeep/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "adapters/system/time_zone_release.hpp"
#include "core/absent.hpp"
#include "daemon/gateway/upkeep/counter_sums.hpp"
#include "daemon/gateway/upkeep/stored_site.hpp"

namespace recald::daemon {
namespace {

using metering::MonthlyFigure;

bool is_same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

std::string kWh_a_day(double value) {
  return std::isnan(value) ? "no value" : fmt::format("{:.3f} kWh/day", value);
}

/// The difference between a stored month and the same month closed again; empty: none.
std::string difference(const MonthlyFigure& stored, const MonthlyFigure& again) {
  if (!is_same(stored.daily_average_kWh, again.daily_average_kWh)) {
    return fmt::format("{} stored, {} when closed again", kWh_a_day(stored.daily_average_kWh),
                       kWh_a_day(again.daily_average_kWh));
  }
  if (!is_same(stored.coverage, again.coverage)) {
    return fmt::format("coverage {:.4f} stored, {:.4f} when closed again", stored.coverage,
                       again.coverage);
  }
  const double stored_kW = stored.peak ? stored.peak->kW : kAbsent;
  const double again_kW = again.peak ? again.peak->kW : kAbsent;
  if (is_same(stored_kW, again_kW)) return "";
  return fmt::format("peak {:.2f} kW stored, {:.2f} kW when closed again", stored_kW, again_kW);
}

Result<void> check_months(Store& store, const SiteConfig& site,
                          const metering::LocalCalendar& calendar, const StoredMeter& meter,
                          Verification& verification) {
  const auto months = TRY(store.months(meter.number));
  const auto waiting = TRY(store.reopened());
  for (const StoredMonth& month : months) {
    const bool is_reopened =
        std::ranges::find(waiting, MeterMonth{meter.number, month.figure.month}) != waiting.end();
    if (is_reopened || month.time_zone_release != system::time_zone_release()) continue;
    const auto again = TRY(
        stored_figure(store, calendar, site.closing, meter, month.figure.month, month.closed_at));
    ++verification.months_compared;
    if (const std::string differs = difference(month.figure, again); !differs.empty()) {
      verification.problems.push_back(fmt::format("meter '{}', month {}: {}", meter.meter.id,
                                                  metering::to_string(month.figure.month),
                                                  differs));
    }
  }
  return {};
}

Result<void> check_meter(Store& store, const SiteConfig& site,
                         const metering::LocalCalendar& calendar, const StoredMeter& meter,
                         Verification& verification) {
  const auto states = store.registers(meter.number);
  if (!states && states.error().code == ErrorCode::malformed) {
    verification.problems.push_back(
        fmt::format("meter '{}': {}", meter.meter.id, states.error().message));
    return {};
  }
  auto compared = TRY(compare_with_counter(store, meter));
  verification.days_compared += compared.days;
  for (std::string& problem : compared.problems) {
    verification.problems.push_back(std::move(problem));
  }
  return check_months(store, site, calendar, meter, verification);
}

}  // namespace

std::string damaged_file(std::string_view damage) {
  return fmt::format(
      "the file is damaged: {}; the daemon recovers the rows that can be read when it starts",
      damage);
}

Result<Verification> verify_store(Store& store, const SiteConfig& site,
                                  const metering::LocalCalendar& calendar) {
  Verification verification;
  auto checked = TRY(store.check());
  if (!checked.damage.empty()) {
    verification.problems.push_back(damaged_file(checked.damage));
    return verification;  // the damage causes all other faults
  }
  verification.problems = std::move(checked.problems);
  verification.intervals = checked.intervals;
  const auto meters = TRY(stored_meters(store, site));
  for (const StoredMeter& meter : meters) {
    TRY(check_meter(store, site, calendar, meter, verification));
  }
  return verification;
}

}  // namespace recald::daemon
