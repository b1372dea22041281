#include "adapters/sqlite/sample_table.hpp"

#include "adapters/sqlite/interval_row.hpp"

namespace recald::sqlite {

Result<void> for_each_sample(Database& database, std::uint32_t meter, const std::string& field,
                             const std::function<void(const metering::RegisterSample&)>& visit) {
  auto query =
      database.prepare("SELECT t, value FROM sample WHERE meter = ? AND field = ? ORDER BY t");
  if (!query) return tl::unexpected(query.error());
  query->bind(0, std::int64_t{meter}).bind(1, std::string_view{field});
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return {};
    visit({instant_of(query->integer(0)), query->real(1)});
  }
}

Result<int> delete_old_samples(Database& database, metering::Instant keep_from, int rows_max) {
  // Works meter by meter, where the key leads straight to the oldest row. A table without rowids
  // has no DELETE … LIMIT, so we first look up the oldest row to keep.
  auto oldest_to_stay = database.prepare(
      "SELECT t FROM sample WHERE meter = ?1 AND t < ?2 ORDER BY t LIMIT 1 OFFSET ?3");
  if (!oldest_to_stay) return tl::unexpected(oldest_to_stay.error());
  auto remove = database.prepare("DELETE FROM sample WHERE meter = ? AND t < ? RETURNING 1");
  if (!remove) return tl::unexpected(remove.error());
  auto meters = database.prepare("SELECT number FROM meter");
  if (!meters) return tl::unexpected(meters.error());
  int removed = 0;
  for (;;) {
    const auto meter = meters->step();
    if (!meter) return tl::unexpected(meter.error());
    if (!*meter || removed >= rows_max) return removed;
    const std::int64_t number = meters->integer(0);
    const auto more = oldest_to_stay->bind(0, number)
                          .bind(1, seconds_of(keep_from))
                          .bind(2, std::int64_t{rows_max} - removed)
                          .step();
    if (!more) return tl::unexpected(more.error());
    const std::int64_t until = *more ? oldest_to_stay->integer(0) : seconds_of(keep_from);
    oldest_to_stay->reset();
    remove->bind(0, number).bind(1, until);
    for (;;) {
      const auto row = remove->step();
      if (!row) return tl::unexpected(row.error());
      if (!*row) break;
      ++removed;
    }
  }
}

}  // namespace recald::sqlite
