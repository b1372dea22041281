#include "daemon/gateway/upkeep/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/sqlite/month_table.hpp"
#include "adapters/system/time_zone_release.hpp"
#include "core/absent.hpp"
#include "daemon/gateway/upkeep/counter_sums.hpp"
#include "daemon/gateway/upkeep/stored_site.hpp"

namespace recald::daemon {
namespace {

using metering::MonthlyFigure;

/// What can be wrong with rows, each as a query whose rows are the wrong ones, their parts in the
/// order of the sentence.
struct RowCheck {
  const char* sql;
  const char* sentence;
};
constexpr RowCheck kRowChecks[] = {
    {"SELECT \"table\", count(*) FROM pragma_foreign_key_check GROUP BY 1",
     "table '{}' has {} rows that refer to a row that is not there"},
    {"SELECT id, datetime(t_start, 'unixepoch') FROM interval JOIN meter ON number = meter "
     "GROUP BY meter, t_start HAVING max(revision) <> count(*) - 1",
     "meter '{}': the revisions of the interval at {} UTC have a gap"},
    {"SELECT id, month FROM month JOIN meter ON number = meter GROUP BY meter, month "
     "HAVING max(revision) <> count(*) - 1",
     "meter '{}': the revisions of month {} have a gap"},
    {"SELECT id, count(*) FROM interval JOIN meter ON number = meter, (SELECT meter AS m, "
     "min(t_start) AS first FROM interval GROUP BY meter) ON m = meter "
     "WHERE (t_start - first) % interval_s <> 0 GROUP BY meter",
     "meter '{}' has {} intervals off its grid"},
};

/// No more than this of one kind: a broken table would fill the screen.
constexpr std::size_t kListedMax = 20;

Result<void> check_rows(sqlite::Database& database, const RowCheck& check,
                        std::vector<std::string>& problems) {
  auto query = database.prepare(check.sql);
  if (!query) return tl::unexpected(query.error());
  std::size_t found = 0;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) break;
    if (++found > kListedMax) continue;
    problems.push_back(fmt::format(fmt::runtime(check.sentence), query->text(0), query->text(1)));
  }
  if (found > kListedMax) {
    problems.push_back(fmt::format("… and {} more like the last", found - kListedMax));
  }
  return {};
}

bool is_same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

std::string kWh_a_day(double value) {
  return std::isnan(value) ? "no value" : fmt::format("{:.3f} kWh/day", value);
}

/// What differs between a stored month and the same closed again; empty: nothing.
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

Result<void> check_months(sqlite::SqliteStore& store, const SiteConfig& site,
                          const metering::LocalCalendar& calendar, const StoredMeter& meter,
                          Verification& verification) {
  const auto months = sqlite::stored_months(store.database(), meter.number);
  if (!months) return tl::unexpected(months.error());
  const auto waiting = store.reopened();
  if (!waiting) return tl::unexpected(waiting.error());
  for (const sqlite::StoredMonth& month : *months) {
    const bool is_reopened =
        std::ranges::find(*waiting, MeterMonth{meter.number, month.figure.month}) != waiting->end();
    if (is_reopened || month.time_zone_release != system::time_zone_release()) continue;
    const auto again =
        stored_figure(store, calendar, site.closing, meter, month.figure.month, month.closed_at);
    if (!again) return tl::unexpected(again.error());
    ++verification.months_compared;
    if (const std::string differs = difference(month.figure, *again); !differs.empty()) {
      verification.problems.push_back(fmt::format("meter '{}', month {}: {}", meter.meter.id,
                                                  metering::to_string(month.figure.month),
                                                  differs));
    }
  }
  return {};
}

Result<void> check_meter(sqlite::SqliteStore& store, const SiteConfig& site,
                         const metering::LocalCalendar& calendar, const StoredMeter& meter,
                         Verification& verification) {
  const auto states = store.registers(meter.number);
  if (!states && states.error().code == ErrorCode::malformed) {
    verification.problems.push_back(
        fmt::format("meter '{}': {}", meter.meter.id, states.error().message));
    return {};
  }
  auto compared = compare_with_counter(store, meter);
  if (!compared) return tl::unexpected(compared.error());
  verification.days_compared += compared->days;
  for (std::string& problem : compared->problems) {
    verification.problems.push_back(std::move(problem));
  }
  return check_months(store, site, calendar, meter, verification);
}

Result<std::uint64_t> count_intervals(sqlite::Database& database) {
  auto query = database.prepare("SELECT count(*) FROM interval");
  if (!query) return tl::unexpected(query.error());
  const auto row = query->step();
  if (!row) return tl::unexpected(row.error());
  return static_cast<std::uint64_t>(query->integer(0));
}

}  // namespace

Result<Verification> verify_store(sqlite::SqliteStore& store, const SiteConfig& site,
                                  const metering::LocalCalendar& calendar) {
  Verification verification;
  sqlite::Database& database = store.database();
  const auto damage = database.quick_check();
  if (!damage) return tl::unexpected(damage.error());
  if (!damage->empty()) {
    verification.problems.push_back(fmt::format(
        "the file is damaged: {}; the daemon recovers what can be read when it starts", *damage));
    return verification;  // what else is wrong comes from that
  }
  for (const RowCheck& check : kRowChecks) {
    if (auto done = check_rows(database, check, verification.problems); !done) {
      return tl::unexpected(done.error());
    }
  }
  const auto meters = stored_meters(store, site);
  if (!meters) return tl::unexpected(meters.error());
  for (const StoredMeter& meter : *meters) {
    if (auto done = check_meter(store, site, calendar, meter, verification); !done) {
      return tl::unexpected(done.error());
    }
  }
  const auto intervals = count_intervals(database);
  if (!intervals) return tl::unexpected(intervals.error());
  verification.intervals = *intervals;
  return verification;
}

}  // namespace recald::daemon
