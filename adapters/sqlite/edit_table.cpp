#include "adapters/sqlite/edit_table.hpp"

#include "adapters/sqlite/interval_row.hpp"

namespace recald::sqlite {

Result<std::int64_t> insert_edit(Database& database, const StoredEdit& edit) {
  auto insert = database.prepare("INSERT INTO edit VALUES (NULL, ?, ?, ?, ?, ?) RETURNING number");
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

Result<std::vector<StoredEdit>> stored_edits(Database& database) {
  auto query =
      database.prepare("SELECT number, t, author, reason, file, sha256 FROM edit ORDER BY number");
  if (!query) return tl::unexpected(query.error());
  std::vector<StoredEdit> edits;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return edits;
    edits.push_back({query->integer(0), instant_of(query->integer(1)), query->text(2),
                     query->text(3), query->text(4), query->text(5)});
  }
}

}  // namespace recald::sqlite
