#include "adapters/sqlite/tables/sample_table.hpp"

#include "adapters/sqlite/tables/rows.hpp"

namespace recald::sqlite {

Result<void> for_each_sample(Database& database, std::uint32_t meter, const std::string& field,
                             const std::function<void(const metering::RegisterSample&)>& visit) {
  auto query =
      TRY(database.prepare("SELECT t, value FROM sample WHERE meter = ? AND field = ? ORDER BY t"));
  return for_each_row(bound(query, meter, field), [&](const Statement& row) {
    visit({instant_of(row.integer(0)), row.real(1)});
  });
}

Result<int> delete_old_samples(Database& database, metering::Instant keep_from, int rows_max) {
  // Works meter by meter, where the key leads straight to the oldest row. A table without rowids
  // has no DELETE … LIMIT, so we first look up the oldest row to keep.
  auto oldest_to_stay = TRY(database.prepare(
      "SELECT t FROM sample WHERE meter = ?1 AND t < ?2 ORDER BY t LIMIT 1 OFFSET ?3"));
  auto remove = TRY(database.prepare("DELETE FROM sample WHERE meter = ? AND t < ? RETURNING 1"));
  auto meters = TRY(database.prepare("SELECT number FROM meter"));
  int removed = 0;
  for (;;) {
    const auto meter = TRY(meters.step());
    if (!meter || removed >= rows_max) return removed;
    const std::int64_t number = meters.integer(0);
    const auto more = TRY(bound(oldest_to_stay, number, keep_from, rows_max - removed).step());
    const std::int64_t until = more ? oldest_to_stay.integer(0) : seconds_of(keep_from);
    oldest_to_stay.reset();
    TRY(for_each_row(bound(remove, number, until), [&](const Statement&) { ++removed; }));
  }
}

}  // namespace recald::sqlite
