#include "adapters/energyplus/run/meter_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "adapters/sqlite/tables/database.hpp"
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
  auto statement = TRY(database.prepare(
      "SELECT DISTINCT Name FROM ReportDataDictionary WHERE IsMeter = 1 AND Units = 'J' "
      "ORDER BY Name"));
  std::vector<std::string> names;
  for (;;) {
    const auto has_row = TRY(statement.step());
    if (!has_row) return names;
    names.push_back(statement.text(0));
  }
}

tl::unexpected<Error> no_such_meter(Database& database, const std::string& name) {
  const auto names = TRY(names_in(database));
  const std::vector<std::string_view> views{names.begin(), names.end()};
  const std::string_view nearest = nearest_name(name, views);
  return failure(ErrorCode::not_found,
                 fmt::format("the model does not report a meter '{}'{}", name,
                             nearest.empty() ? "; `recald engine show` lists what it reports"
                                             : fmt::format("; did you mean '{}'?", nearest)));
}

/// The end of an interval as the table has it: hour 24 and minute 60 occur.
Instant end_of(int year, int month, int day, int hour, int minute) {
  using namespace std::chrono;
  return sys_days{std::chrono::year{year} / month / day} + hours{hour} + minutes{minute};
}

/// Starts of the run's steps by their place in the table Time; absent: of a design day or warm-up.
using Starts = std::unordered_map<std::int64_t, Instant>;

Result<Starts> read_starts(Database& database, std::chrono::seconds utc_offset) {
  auto statement = TRY(database.prepare(
      "SELECT t.TimeIndex, t.Year, t.Month, t.Day, t.Hour, t.Minute, t.Interval FROM Time t "
      "JOIN EnvironmentPeriods e ON e.EnvironmentPeriodIndex = t.EnvironmentPeriodIndex "
      "WHERE e.EnvironmentType = ?1 AND coalesce(t.WarmupFlag, 0) = 0"));
  statement.bind(0, std::int64_t{kWeatherRun});
  Starts starts;
  for (;;) {
    const auto has_row = TRY(statement.step());
    if (!has_row) return starts;
    const auto whole = [&](int column) { return static_cast<int>(statement.integer(column)); };
    const Instant end = end_of(whole(1), whole(2), whole(3), whole(4), whole(5));
    starts.emplace(statement.integer(0), end - std::chrono::minutes{whole(6)} - utc_offset);
  }
}

/// What a meter is called in the run's data, or that there is no such meter.
Result<std::int64_t> meter_number(Database& database, const std::string& name) {
  auto statement = TRY(database.prepare(
      "SELECT ReportDataDictionaryIndex FROM ReportDataDictionary WHERE IsMeter = 1 AND Name = ?1 "
      "COLLATE NOCASE AND ReportingFrequency LIKE '%Timestep'"));
  statement.bind(0, std::string_view{name});
  const auto has_row = TRY(statement.step());
  if (has_row) return statement.integer(0);
  return no_such_meter(database, name);
}

/// One pass over the data, which has no index but its order in time.
Result<void> read_data(Database& database, const Starts& starts,
                       const std::unordered_map<std::int64_t, MeterOutput*>& meters) {
  auto statement = TRY(database.prepare(
      "SELECT TimeIndex, ReportDataDictionaryIndex, Value FROM ReportData ORDER BY "
      "ReportDataIndex"));
  for (;;) {
    const auto has_row = TRY(statement.step());
    if (!has_row) return {};
    const auto meter = meters.find(statement.integer(1));
    if (meter == meters.end()) continue;
    const auto start = starts.find(statement.integer(0));
    if (start == starts.end()) continue;
    meter->second->starts.push_back(start->second);
    meter->second->energy_kWh.push_back(statement.real(2) / kJoulePerKilowattHour);
  }
}

}  // namespace

Result<std::vector<MeterOutput>> read_meters(const std::filesystem::path& file,
                                             const std::vector<std::string>& names,
                                             std::chrono::seconds utc_offset) {
  auto database = TRY(open(file));
  const auto starts = TRY(read_starts(database, utc_offset));
  std::vector<MeterOutput> meters(names.size());
  std::unordered_map<std::int64_t, MeterOutput*> by_number;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto number = TRY(meter_number(database, names[i]));
    meters[i] = {names[i], {}, {}};
    by_number[number] = &meters[i];
  }
  TRY(read_data(database, starts, by_number));
  for (const MeterOutput& meter : meters) {
    if (meter.starts.empty()) return no_such_meter(database, meter.name);
  }
  return meters;
}

}  // namespace recald::energyplus
