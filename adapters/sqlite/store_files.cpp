#include "adapters/sqlite/store_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/sqlite/tables/rows.hpp"

namespace recald::sqlite {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

std::string stamp_of(metering::Instant t) {
  std::string stamp = metering::to_string(t);
  std::erase_if(stamp, [](char c) { return c == '-' || c == ':'; });
  return stamp;
}

fs::path free_name(const fs::path& wanted) {
  fs::path name = wanted;
  const auto is_taken = [&](const char* part) { return is_there(name.string() + part); };
  for (int n = 2; std::ranges::any_of(kStoreParts, is_taken); ++n) {
    name = fmt::format("{}-{}", wanted.string(), n);
  }
  return name;
}

void remove_store(const fs::path& file) {
  std::error_code ignored;
  for (const char* part : kStoreParts) fs::remove(file.string() + part, ignored);
}

Result<metering::Instant> time_of_event(Database& store, metering::Instant now) {
  auto query = TRY(store.prepare("SELECT coalesce(max(t_start), 0) FROM interval"));
  TRY(query.step());
  return std::max(now, instant_of(query.integer(0)));
}

}  // namespace recald::sqlite
