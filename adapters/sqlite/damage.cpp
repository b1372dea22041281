#include "adapters/sqlite/damage.hpp"

#include <fstream>

#include "adapters/sqlite/tables/schema.hpp"
#include "adapters/sqlite/tables/tables.hpp"

namespace recald::sqlite {
namespace {

/// Whether a file's header says that it has a log, as every database that `Database` opened to
/// write does. With another number there, SQLite reads the file but never writes to it again.
/// @see SQLite, "Database File Format", 1.3.3
bool has_log_mode(const std::filesystem::path& file) {
  constexpr std::streamoff kVersions = 18;  // of writing and of reading
  std::ifstream in{file, std::ios::binary};
  in.seekg(kVersions);
  return in.get() == 2 && in.get() == 2;
}

}  // namespace

Result<std::string> damage_of(const std::filesystem::path& file, const OnProgress& on_progress,
                              const std::stop_token& stop) {
  if (std::error_code ignored; !std::filesystem::exists(file, ignored)) return std::string{};
  if (on_progress) on_progress();
  auto database = Database::open(file, {});
  if (!database) {
    if (database.error().code == ErrorCode::malformed) return database.error().message;
    return tl::unexpected(database.error());
  }
  database->on_progress(on_progress);
  const std::stop_callback stopping{stop, [&] { database->interrupt(); }};
  // A header of another program is still readable.
  if (auto version = schema_version(*database); !version) {
    if (version.error().code == ErrorCode::malformed) return version.error().message;
    return tl::unexpected(version.error());
  }
  if (!has_log_mode(file)) return "its header has the number of another file format";
  // An interrupt before the check starts is forgotten, so ask again here.
  if (stop.stop_requested()) return failure(ErrorCode::cancelled, "the check was stopped");
  auto damage = database->quick_check();
  if (damage && damage->empty()) damage = wrong_sums(*database);
  if (stop.stop_requested()) return failure(ErrorCode::cancelled, "the check was stopped");
  return damage;
}

}  // namespace recald::sqlite
