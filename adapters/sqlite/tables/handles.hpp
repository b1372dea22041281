/// SQLite's own types, for the files of this folder that call the library; no other
/// file includes it.
#pragma once

#include <sqlite3.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using DatabaseHandle = std::unique_ptr<sqlite3, CloseDatabase>;
using StatementHandle = std::unique_ptr<sqlite3_stmt, FinalizeStatement>;

/// The kind of failure behind a result code of SQLite.
[[nodiscard]] ErrorCode code_of(int result);

/// @param database  The one that failed, for its error message; null: only the code is known.
[[nodiscard]] tl::unexpected<Error> failed(int result, sqlite3* database, std::string_view file);

/// Adds the function row_sum(table, value, …) of tables.hpp to a connection.
void add_row_sum(sqlite3* database);

struct Database::Impl {
  DatabaseHandle handle;
  std::string file;
  std::function<void()> on_progress{};
  // Kept, because parsing them anew takes longer than a small transaction itself.
  StatementHandle begin{};
  StatementHandle commit{};
};

}  // namespace recald::sqlite
