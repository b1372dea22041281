/// Rows out of a database that cannot be read everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "adapters/sqlite/database.hpp"

namespace recald::sqlite {

/// A table of the store, and by which of its keys a hole in it can be narrowed down.
struct SalvagedTable {
  const char* name;
  bool by_meter;             ///< Its key begins with the meter.
  const char* key;           ///< An integer column, the next part of its key; null: none.
  std::int64_t narrow_down;  ///< To so much of it: 1 for numbers, seconds for times.
};

/// In an order in which rows come after those that they refer to; `meter` is the first.
[[nodiscard]] const std::vector<SalvagedTable>& salvaged_tables();

struct SalvagedRows {
  std::int64_t rows = 0;  ///< That `to` did not have.
  bool is_whole = true;   ///< Nothing of the table was unreadable, nor any row implausible.
};

/// Copies what can be read and `to` does not have.
/// @return or as Database::execute when `to` cannot be written.
[[nodiscard]] Result<SalvagedRows> salvage(Database& from, Database& to,
                                           const SalvagedTable& table);

/// Gives numbers whose meter could not be read an id, "unknown-3", so that its rows have a place.
[[nodiscard]] Result<void> name_unknown_meters(Database& from, Database& to);

}  // namespace recald::sqlite
