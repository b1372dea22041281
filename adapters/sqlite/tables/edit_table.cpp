#include "adapters/sqlite/tables/edit_table.hpp"

#include <fmt/format.h>

#include "adapters/sqlite/tables/rows.hpp"
#include "adapters/sqlite/tables/tables.hpp"

namespace recald::sqlite {

Result<std::int64_t> insert_edit(Database& database, const StoreEdit& edit) {
  auto insert = TRY(database.prepare(
      fmt::format("INSERT INTO edit VALUES (NULL, ?1, ?2, ?3, ?4, ?5, {}) RETURNING number",
                  sum_of("edit", 5))));
  TRY(bound(insert, edit.time, edit.author, edit.reason, edit.file, edit.sha256).step());
  const std::int64_t number = insert.integer(0);
  TRY(insert.run());
  return number;
}

Result<void> delete_edit(Database& database, std::int64_t number) {
  auto remove = TRY(database.prepare("DELETE FROM edit WHERE number = ?"));
  return remove.bind(0, number).run();
}

Result<std::set<metering::Instant>> edited_days(Database& database, std::uint32_t meter) {
  auto query = TRY(database.prepare(
      "SELECT DISTINCT t_start / 86400 FROM interval WHERE meter = ? AND edit IS NOT NULL"));
  std::set<metering::Instant> days;
  TRY(for_each_row(bound(query, meter), [&](const Statement& row) {
    days.insert(metering::Instant{std::chrono::days{row.integer(0)}});
  }));
  return days;
}

}  // namespace recald::sqlite
