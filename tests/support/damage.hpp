/// Pages of a SQLite file, overwritten as a failing disk does.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "adapters/sqlite/tables/database.hpp"

namespace recald::testing {

inline constexpr std::streamoff kPageBytes = 4096;

inline void damage_page(const std::filesystem::path& file, std::int64_t page) {
  std::fstream bytes{file, std::ios::in | std::ios::out | std::ios::binary};
  bytes.seekp((page - 1) * kPageBytes);
  bytes << std::string(static_cast<std::size_t>(kPageBytes), '\xA5');
  if (!bytes.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// The n-th of the pages that hold a table's rows. @pre nobody has the file open.
inline void damage_leaf(const std::filesystem::path& file, const std::string& table, int n) {
  std::int64_t page = 0;
  {
    auto database = sqlite::Database::open(file, {}).value();
    auto query = database
                     .prepare(fmt::format("SELECT pageno FROM dbstat WHERE name = '{}' AND "
                                          "pagetype = 'leaf' ORDER BY path LIMIT 1 OFFSET {}",
                                          table, n))
                     .value();
    if (!query.step().value_or(false)) throw std::runtime_error("no such page");
    page = query.integer(0);
    query.reset();
  }
  damage_page(file, page);
}

}  // namespace recald::testing
