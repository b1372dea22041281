#include "adapters/sqlite/edit_table.hpp"

#include <fmt/format.h>

#include "adapters/sqlite/interval_row.hpp"
#include "adapters/sqlite/tables.hpp"

namespace recald::sqlite {

Result<std::int64_t> insert_edit(Database& database, const StoreEdit& edit) {
  auto insert = TRY(database.prepare(
      fmt::format("INSERT INTO edit VALUES (NULL, ?1, ?2, ?3, ?4, ?5, {}) RETURNING number",
                  sum_of("edit", 5))));
  insert.bind(0, seconds_of(edit.time))
      .bind(1, std::string_view{edit.author})
      .bind(2, std::string_view{edit.reason})
      .bind(3, std::string_view{edit.file})
      .bind(4, std::string_view{edit.sha256});
  TRY(insert.step());
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
  query.bind(0, std::int64_t{meter});
  std::set<metering::Instant> days;
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return days;
    days.insert(metering::Instant{std::chrono::days{query.integer(0)}});
  }
}

}  // namespace recald::sqlite
