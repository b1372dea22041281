#include "adapters/sqlite/tables/outbox_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adapters/ports/destination_cursors.hpp"
#include "adapters/sqlite/tables/month_table.hpp"
#include "adapters/sqlite/tables/rows.hpp"
#include "adapters/sqlite/tables/tables.hpp"

namespace recald::sqlite {
namespace {

constexpr std::string_view kPrefix = "outbox ";
/// The number of the last entry ever: SQLite gives the number of a deleted row again.
constexpr auto kLastNumber =
    "max((SELECT coalesce(max(number), 0) FROM outbox), (SELECT coalesce(max(position), 0) FROM "
    "cursor WHERE destination GLOB 'outbox *'))";

Result<std::int64_t> last_number(Database& database) {
  auto query = TRY(database.prepare(fmt::format("SELECT {}", kLastNumber)));
  TRY(query.step());
  return query.integer(0);
}

Result<void> put_cursor(Database& database, const std::string& destination, std::int64_t position) {
  auto put = TRY(database.prepare(insert_into("cursor", 2, "INSERT OR REPLACE")));
  return bound(put, destination, position).run();
}

/// Deletes what every destination has had, and all where there is none.
Result<void> forget_sent(Database& database) {
  return database.execute(
      "DELETE FROM outbox WHERE number <= (SELECT coalesce(min(position), 9223372036854775807) "
      "FROM cursor WHERE destination GLOB 'outbox *')");
}

Result<std::vector<std::string>> kept_cursors(Database& database) {
  auto query =
      TRY(database.prepare("SELECT destination FROM cursor WHERE destination GLOB 'outbox *'"));
  return all_rows(query, &Columns::next<std::string>);
}

}  // namespace

std::string insert_outbox_entry() {
  return fmt::format(
      "INSERT INTO outbox SELECT 1 + {}, ?1, ?2, ?3, ?4, {} WHERE EXISTS (SELECT 1 FROM cursor "
      "WHERE destination GLOB 'outbox *')",
      kLastNumber, sum_of("outbox", 4));
}

Result<void> keep_outbox_for(Database& database, const std::vector<std::string>& destinations) {
  return database.transaction([&]() -> Result<void> {
    const auto last = TRY(last_number(database));
    const auto kept = TRY(kept_cursors(database));
    for (const std::string& destination : destinations) {
      const std::string cursor = std::string{kPrefix} + destination;
      if (std::ranges::find(kept, cursor) != kept.end()) continue;
      if (auto put = put_cursor(database, cursor, last); !put) return put;
    }
    auto forget =
        TRY(database.prepare("DELETE FROM cursor WHERE destination IN (?1, ?2, ?3, ?4, ?5, ?6)"));
    for (const std::string& cursor : kept) {
      const std::string name = cursor.substr(kPrefix.size());
      if (std::ranges::find(destinations, name) != destinations.end()) continue;
      TRY(bound(forget, cursor, events_cursor(name), results_cursor(name), history_cursor(name),
                identity_cursor(name), taken_cursor(name))
              .run());
    }
    return forget_sent(database);
  });
}

Result<std::vector<OutboxEntry>> outbox_after(Database& database, std::int64_t number, int limit) {
  // Revisions never change, so an entry is what was stored then, whatever has come since.
  auto query = TRY(database.prepare(fmt::format(
      "SELECT i.{}, o.number, o.meter, meter.id, o.month, o.revision, i.t_start IS NOT NULL, "
      "meter.interval_s "
      "FROM outbox AS o JOIN meter ON meter.number = o.meter "
      "LEFT JOIN interval AS i ON i.meter = o.meter AND i.t_start = o.t_start AND "
      "i.revision = o.revision WHERE o.number > ? ORDER BY o.number LIMIT ?",
      "t_start, i.revision, i.mean_kW, i.validity, i.late, i.reasons")));
  bound(query, number, limit);
  std::vector<OutboxEntry> entries;
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return entries;
    OutboxEntry entry{.number = query.integer(6),
                      .meter = query.text(8),
                      .interval = std::chrono::seconds{query.integer(12)},
                      .stored = {}};
    const auto meter = static_cast<std::uint32_t>(query.integer(7));
    if (query.integer(11) != 0) {
      entry.stored = read_interval(Columns{query}, meter);
    } else if (!query.is_null(9)) {
      auto month =
          TRY(stored_month(database, meter, query.text(9), static_cast<int>(query.integer(10))));
      if (month) entry.stored = std::move(*month);
    }
    // What a damaged store lost leaves its number behind, so that positions go past it.
    entries.push_back(std::move(entry));
  }
}

Result<OutboxPosition> outbox_position(Database& database, const std::string& destination) {
  auto query = TRY(database.prepare(
      fmt::format("SELECT {}, (SELECT position FROM cursor WHERE destination = ?)", kLastNumber)));
  TRY(bound(query, std::string{kPrefix} + destination).step());
  const std::int64_t last = query.integer(0);
  return OutboxPosition{.sent = query.is_null(1) ? last : query.integer(1), .last = last};
}

Result<void> put_outbox_position(Database& database, const std::string& destination,
                                 std::int64_t number) {
  return database.transaction([&]() -> Result<void> {
    if (auto put = put_cursor(database, std::string{kPrefix} + destination, number); !put) {
      return put;
    }
    return forget_sent(database);
  });
}

Result<void> forget_identities(Database& database) {
  return database.execute(
      "DELETE FROM cursor WHERE destination GLOB 'identity for *' OR "
      "destination GLOB 'history of *'");
}

}  // namespace recald::sqlite
