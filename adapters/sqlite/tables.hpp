/// What the rows of the store's tables look like, and the sum that each of them carries.
///
/// SQLite finds damage to the structure of a file, not a bit that flipped inside a value. So every
/// row that holds data has the sum of its values in its last column. The table's name is part of
/// it: a row that is found on a page whose table nobody knows proves where it belongs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

struct TableShape {
  const char* name;
  bool has_rowid;  ///< Its first column is the rowid.
  /// A letter a column, without the sum: i integer, n integer or null, r real or null, t text, u
  /// text or null.
  const char* types;
  std::size_t columns_first;  ///< Of the oldest schema: rows from then are shorter.
  int summed_from;    ///< First column of the sum, past a number that SQLite gives; -1: no sum.
  const char* newer;  ///< Whether `excluded` replaces the row of the same key; null: never.

  [[nodiscard]] std::size_t columns() const { return std::string_view{types}.size(); }
  [[nodiscard]] bool has_sum() const { return summed_from >= 0; }
};

/// In an order in which rows come after those that they refer to.
[[nodiscard]] std::span<const TableShape> table_shapes();

/// Names of a table's columns in this file, in order; empty: there is no such table.
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

/// The sum of a row's values: the CRC-32 of the table's name and of each value with its type.
[[nodiscard]] std::uint32_t row_sum(std::string_view table, std::span<const Value> values);

/// "row_sum('edit', ?1, ?2)", for a row's values among a statement's parameters.
[[nodiscard]] std::string sum_of(std::string_view table, int parameters);

/// "INSERT INTO edit VALUES (?1, ?2, row_sum('edit', ?1, ?2))"
/// @param parameters  All columns but the sum.
[[nodiscard]] std::string insert_into(std::string_view table, int parameters,
                                      std::string_view verb = "INSERT");

/// Rows whose sum is not that of their values: "2 rows of interval have a wrong check sum; …".
/// Empty: none. Rows from before there were sums are taken as they are.
[[nodiscard]] Result<std::string> wrong_sums(Database& database);

}  // namespace recald::sqlite
