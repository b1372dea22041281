#include "adapters/sqlite/sample_table.hpp"

#include "adapters/sqlite/interval_row.hpp"

namespace recald::sqlite {

Result<void> for_each_sample(Database& database, std::uint32_t meter, const std::string& field,
                             const std::function<void(const metering::RegisterSample&)>& visit) {
  auto query =
      TRY(database.prepare("SELECT t, value FROM sample WHERE meter = ? AND field = ? ORDER BY t"));
  query.bind(0, std::int64_t{meter}).bind(1, std::string_view{field});
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return {};
    visit({instant_of(query.integer(0)), query.real(1)});
  }
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
    const auto more = TRY(oldest_to_stay.bind(0, number)
                              .bind(1, seconds_of(keep_from))
                              .bind(2, std::int64_t{rows_max} - removed)
                              .step());
    const std::int64_t until = more ? oldest_to_stay.integer(0) : seconds_of(keep_from);
    oldest_to_stay.reset();
    remove.bind(0, number).bind(1, until);
    for (;;) {
      const auto row = TRY(remove.step());
      if (!row) break;
      ++removed;
    }
  }
}

}  // namespace recald::sqlite
