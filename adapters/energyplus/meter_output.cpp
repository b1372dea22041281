#include "adapters/energyplus/meter_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "adapters/sqlite/database.hpp"
#include "core/text/nearest.hpp"

namespace recald::energyplus {
namespace {

using metering::Instant;
using sqlite::Database;

constexpr double kJoulePerKilowattHour = 3.6e6;
constexpr int kWeatherRun = 3;  // EnvironmentPeriods.EnvironmentType of a run period

Result<Database> open(const std::filesystem::path& file) {
  return Database::open(file, {.access = Database::Access::read_only, .vfs = {}});
}

Result<std::vector<std::string>> names_in(Database& database) {
  auto statement = database.prepare(
      "SELECT DISTINCT Name FROM ReportDataDictionary WHERE IsMeter = 1 AND Units = 'J' "
      "ORDER BY Name");
  if (!statement) return tl::unexpected(statement.error());
  std::vector<std::string> names;
  for (;;) {
    const auto has_row = statement->step();
    if (!has_row) return tl::unexpected(has_row.error());
    if (!*has_row) return names;
    names.push_back(statement->text(0));
  }
}

/// The end of an interval as the table has it: hour 24 and minute 60 occur.
Instant end_of(int year, int month, int day, int hour, int minute) {
  using namespace std::chrono;
  return sys_days{std::chrono::year{year} / month / day} + hours{hour} + minutes{minute};
}

Result<MeterOutput> read_meter(Database& database, const std::string& name,
                               std::chrono::seconds utc_offset) {
  auto statement = database.prepare(
      "SELECT t.Year, t.Month, t.Day, t.Hour, t.Minute, t.Interval, d.Value "
      "FROM ReportData d JOIN Time t ON t.TimeIndex = d.TimeIndex "
      "JOIN ReportDataDictionary m ON m.ReportDataDictionaryIndex = d.ReportDataDictionaryIndex "
      "JOIN EnvironmentPeriods e ON e.EnvironmentPeriodIndex = t.EnvironmentPeriodIndex "
      "WHERE m.IsMeter = 1 AND m.Name = ?1 COLLATE NOCASE AND e.EnvironmentType = ?2 "
      "AND coalesce(t.WarmupFlag, 0) = 0 AND m.ReportingFrequency LIKE '%Timestep' "
      "ORDER BY d.TimeIndex");
  if (!statement) return tl::unexpected(statement.error());
  statement->bind(0, std::string_view{name}).bind(1, std::int64_t{kWeatherRun});
  MeterOutput meter{name, {}, {}};
  for (;;) {
    const auto has_row = statement->step();
    if (!has_row) return tl::unexpected(has_row.error());
    if (!*has_row) break;
    const auto whole = [&](int column) { return static_cast<int>(statement->integer(column)); };
    const Instant end = end_of(whole(0), whole(1), whole(2), whole(3), whole(4));
    meter.starts.push_back(end - std::chrono::minutes{whole(5)} - utc_offset);
    meter.energy_kWh.push_back(statement->real(6) / kJoulePerKilowattHour);
  }
  if (!meter.starts.empty()) return meter;
  const auto names = names_in(database);
  if (!names) return tl::unexpected(names.error());
  const std::vector<std::string_view> views{names->begin(), names->end()};
  const std::string_view nearest = nearest_name(name, views);
  return failure(ErrorCode::not_found,
                 fmt::format("the model does not report a meter '{}'{}", name,
                             nearest.empty() ? "; `recald engine show` lists what it reports"
                                             : fmt::format("; did you mean '{}'?", nearest)));
}

}  // namespace

Result<std::vector<MeterOutput>> read_meters(const std::filesystem::path& file,
                                             const std::vector<std::string>& names,
                                             std::chrono::seconds utc_offset) {
  auto database = open(file);
  if (!database) return tl::unexpected(database.error());
  std::vector<MeterOutput> meters;
  for (const std::string& name : names) {
    auto meter = read_meter(*database, name, utc_offset);
    if (!meter) return tl::unexpected(meter.error());
    meters.push_back(std::move(*meter));
  }
  return meters;
}

}  // namespace recald::energyplus
