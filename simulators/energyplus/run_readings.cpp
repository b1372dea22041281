#include "simulators/energyplus/run_readings.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <map>
#include <memory>

#include "core/metering/civil_time.hpp"
#include "simulators/chance/chance.hpp"
#include "simulators/feed/faults.hpp"

namespace recald::simulators::energyplus {
namespace {

using metering::Instant;

constexpr double kJoulePerKilowattHour = 3.6e6;

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct CloseStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;

/// By the start of the time step, kWh.
using Series = std::map<Instant, double>;

Error read_error(const std::filesystem::path& run, sqlite3* database) {
  return {ErrorCode::io_failed,
          fmt::format("cannot read {}: {}; give the eplusout.sql of a finished run", run.string(),
                      sqlite3_errmsg(database))};
}

/// Ends of time steps, as the table has them: hour 24 and minute 60 occur. Days of weather only.
constexpr const char* kQuery =
    "SELECT t.Year, t.Month, t.Day, t.Hour, t.Minute, t.Interval, d.Value FROM ReportData d "
    "JOIN Time t ON t.TimeIndex = d.TimeIndex "
    "JOIN ReportDataDictionary m ON m.ReportDataDictionaryIndex = d.ReportDataDictionaryIndex "
    "JOIN EnvironmentPeriods e ON e.EnvironmentPeriodIndex = t.EnvironmentPeriodIndex "
    "WHERE m.Name = ?1 AND m.ReportingFrequency LIKE '%Timestep' AND e.EnvironmentType = 3 "
    "AND coalesce(t.WarmupFlag, 0) = 0";

Result<void> read_meter(const std::filesystem::path& run, const RunMeter& meter,
                        std::chrono::seconds standard_offset, Series& series) {
  sqlite3* opened = nullptr;
  const int status = sqlite3_open_v2(run.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
  const Database database{opened};
  if (status != SQLITE_OK) return tl::unexpected(read_error(run, opened));
  sqlite3_stmt* prepared = nullptr;
  if (sqlite3_prepare_v2(opened, kQuery, -1, &prepared, nullptr) != SQLITE_OK) {
    return tl::unexpected(read_error(run, opened));
  }
  const Statement statement{prepared};
  sqlite3_bind_text(prepared, 1, meter.reported.c_str(), -1, SQLITE_STATIC);
  const std::size_t before = series.size();
  int step = 0;
  while ((step = sqlite3_step(prepared)) == SQLITE_ROW) {
    const auto whole = [&](int column) { return sqlite3_column_int(prepared, column); };
    const std::chrono::sys_days day{std::chrono::year{whole(0)} / whole(1) / whole(2)};
    const Instant end = day + std::chrono::hours{whole(3)} + std::chrono::minutes{whole(4)};
    series[end - std::chrono::minutes{whole(5)} - standard_offset] =
        sqlite3_column_double(prepared, 6) / kJoulePerKilowattHour;
  }
  if (step != SQLITE_DONE) return tl::unexpected(read_error(run, opened));
  if (series.size() > before) return {};
  return failure(ErrorCode::not_found,
                 fmt::format("{} has no meter {} at time steps; add an Output:Meter with the "
                             "reporting frequency Timestep to the model",
                             run.string(), meter.reported));
}

/// Noise on every reading, and rows that were never written.
void spoil(Series& series, const ReadingOptions& options, std::uint64_t meter) {
  constexpr double kShortest_h = 0.25;
  constexpr double kLongest_h = 24.0;
  // Short ones are more frequent: `plan_faults` draws the square of a uniform number.
  constexpr double kMean_h = kShortest_h + (kLongest_h - kShortest_h) / 3.0;
  constexpr double kYear_h = 8766.0;
  Rng noise = stream_of(options.seed, Stream::meter_noise, meter);
  for (auto& [start, value] : series) value *= 1.0 + options.noise_share * noise.normal();
  Rng faults = stream_of(options.seed, Stream::meter_faults, meter);
  const FaultHabit habit{.kind = FaultKind::gap,
                         .per_year = options.lost_share * kYear_h / kMean_h,
                         .shortest_h = kShortest_h,
                         .longest_h = kLongest_h};
  std::vector<Instant> starts;
  for (const auto& [start, value] : series) starts.push_back(start);
  for (const Fault& gap : plan_faults({habit}, 0, starts.size(), faults)) {
    for (std::size_t slot = gap.first; slot < gap.first + gap.count; ++slot) {
      series.erase(starts[slot]);
    }
  }
}

}  // namespace

std::vector<RunMeter> district_meters() {
  return {{"electricity", "Electricity:Facility"},
          {"chilled_water", "DistrictCooling:Facility"},
          {"heat", "DistrictHeatingWater:Facility"}};
}

Result<std::string> readings_csv(const ReadingOptions& options) {
  std::map<std::pair<Instant, std::size_t>, double> rows;
  for (std::size_t i = 0; i < options.meters.size(); ++i) {
    Series series;
    for (const std::filesystem::path& run : options.runs) {
      TRY(read_meter(run, options.meters[i], options.standard_offset, series));
    }
    spoil(series, options, i);
    for (const auto& [start, value] : series) rows[{start, i}] = value;
  }
  std::string text = "timestamp,meter,value,unit\n";
  for (const auto& [at, value] : rows) {
    text += fmt::format("{},{},{:.3f},kWh\n", metering::to_string(at.first),
                        options.meters[at.second].id, value);
  }
  return text;
}

}  // namespace recald::simulators::energyplus
