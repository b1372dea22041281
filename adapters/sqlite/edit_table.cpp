#include "adapters/sqlite/edit_table.hpp"

#include <fmt/format.h>

#include "adapters/sqlite/interval_row.hpp"
#include "adapters/sqlite/tables.hpp"

namespace recald::sqlite {

Result<std::int64_t> insert_edit(Database& database, const StoreEdit& edit) {
  auto insert = database.prepare(
      fmt::format("INSERT INTO edit VALUES (NULL, ?1, ?2, ?3, ?4, ?5, {}) RETURNING number",
                  sum_of("edit", 5)));
  if (!insert) return tl::unexpected(insert.error());
  insert->bind(0, seconds_of(edit.time))
      .bind(1, std::string_view{edit.author})
      .bind(2, std::string_view{edit.reason})
      .bind(3, std::string_view{edit.file})
      .bind(4, std::string_view{edit.sha256});
  const auto row = insert->step();
  if (!row) return tl::unexpected(row.error());
  const std::int64_t number = insert->integer(0);
  if (auto done = insert->run(); !done) return tl::unexpected(done.error());
  return number;
}

Result<void> delete_edit(Database& database, std::int64_t number) {
  auto remove = database.prepare("DELETE FROM edit WHERE number = ?");
  if (!remove) return tl::unexpected(remove.error());
  return remove->bind(0, number).run();
}

Result<std::set<metering::Instant>> edited_days(Database& database, std::uint32_t meter) {
  auto query = database.prepare(
      "SELECT DISTINCT t_start / 86400 FROM interval WHERE meter = ? AND edit IS NOT NULL");
  if (!query) return tl::unexpected(query.error());
  query->bind(0, std::int64_t{meter});
  std::set<metering::Instant> days;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return days;
    days.insert(metering::Instant{std::chrono::days{query->integer(0)}});
  }
}

}  // namespace recald::sqlite
