#include "adapters/sqlite/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/sqlite/tables/rows.hpp"
#include "adapters/sqlite/tables/schema.hpp"

namespace recald::sqlite {

bool is_still(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file.string() + "-wal", error);
  return error || size == 0;
}

Result<Database> open_untouched(const std::filesystem::path& file) {
  return Database::open(file, {.access = Database::Access::read_only, .is_still = is_still(file)});
}

Result<StoreSummary> summary_of(const std::filesystem::path& file) {
  auto database = TRY(open_untouched(file));
  return summary_of(database);
}

Result<StoreSummary> summary_of(Database& database) {
  const auto version = TRY(schema_version(database));
  if (version == 0) return failure(ErrorCode::malformed, "the file has no tables");
  StoreSummary summary{.schema_version = version};
  // A meter's newest interval is one step in the index.
  auto query = TRY(database.prepare(
      "SELECT id, (SELECT max(t_start) FROM interval WHERE meter = number) FROM meter "
      "ORDER BY number"));
  TRY(for_each_row(query, [&](const Statement& row) {
    Columns columns{row};
    summary.meters.push_back(columns);
    summary.newest = std::max(summary.newest, columns.next<std::optional<metering::Instant>>());
  }));
  return summary;
}

}  // namespace recald::sqlite
