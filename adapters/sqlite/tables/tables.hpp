/// The rows of the store's tables, and the checksum that each row carries.
///
/// SQLite detects damage to the structure of a file, but not a flipped bit inside a value. So every
/// row with data has a checksum of its values in its last column. The sum includes the table's
/// name: a row on a page of unknown origin proves which table it belongs to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

struct TableShape {
  const char* name;
  bool has_rowid;  ///< Its first column is the rowid.
  /// One letter per column, without the checksum: i integer, n integer or null, r real or null, t
  /// text, u text or null.
  const char* types;
  std::size_t columns_first;  ///< In the oldest schema, whose rows are shorter.
  int summed_from;    ///< First column in the checksum, after a number that SQLite sets; -1: no
                      ///< checksum.
  const char* newer;  ///< SQL: whether `excluded` replaces the row of the same key; null: never.

  [[nodiscard]] std::size_t columns() const { return std::string_view{types}.size(); }
  [[nodiscard]] bool has_sum() const { return summed_from >= 0; }
};

/// Ordered so that rows come after the rows they refer to.
[[nodiscard]] std::span<const TableShape> table_shapes();

/// Names of a table's columns in this file, in order; empty: no such table.
[[nodiscard]] Result<std::vector<std::string>> columns_of(Database& database,
                                                          std::string_view table);

/// One value of a row.
struct Value {
  enum class Kind : std::uint8_t { null, integer, real, text };
  Kind kind = Kind::null;
  std::int64_t integer = 0;
  double real = 0.0;
  std::string text;
};

/// The checksum of a row: the CRC-32 of the table's name and of each value with its type.
[[nodiscard]] std::uint32_t row_sum(std::string_view table, std::span<const Value> values);

/// "row_sum('edit', ?1, ?2)", for a row's values among a statement's parameters.
[[nodiscard]] std::string sum_of(std::string_view table, int parameters);

/// "INSERT INTO edit VALUES (?1, ?2, row_sum('edit', ?1, ?2))"
/// @param parameters  All columns except the checksum.
[[nodiscard]] std::string insert_into(std::string_view table, int parameters,
                                      std::string_view verb = "INSERT");

/// Reports rows whose checksum does not match: "2 rows of interval have a wrong check sum; …".
/// Empty: none. Rows from before the checksums are accepted.
[[nodiscard]] Result<std::string> wrong_sums(Database& database);

}  // namespace recald::sqlite
