/// What people changed by hand: who, when, why, out of which file. The rows of `interval` that an
/// edit put there name it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adapters/sqlite/database.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::sqlite {

struct StoredEdit {
  std::int64_t number = 0;  ///< Given by the store; 1, 2, 3 …
  metering::Instant time;
  std::string author;
  std::string reason;
  std::string file;    ///< Its name, without the folder.
  std::string sha256;  ///< Of the file's bytes.
};

/// The edit's number is given by the table and returned. @return invalid_value without a reason.
[[nodiscard]] Result<std::int64_t> insert_edit(Database& database, const StoredEdit& edit);

/// The oldest first.
[[nodiscard]] Result<std::vector<StoredEdit>> stored_edits(Database& database);

}  // namespace recald::sqlite
