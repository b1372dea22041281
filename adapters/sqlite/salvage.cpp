#include "adapters/sqlite/salvage.hpp"

#include <fmt/format.h>

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "adapters/sqlite/schema.hpp"

namespace recald::sqlite {
namespace {

constexpr std::int64_t kMetersMax = 1000;
constexpr int kHolesMax = 3000;  // of one table, or of one meter in it

struct KeyRange {
  std::int64_t first;
  std::int64_t last;
};

Result<std::vector<std::string>> columns_of(Database& database, const char* table) {
  auto query = database.prepare("SELECT name FROM pragma_table_info(?)");
  if (!query) return tl::unexpected(query.error());
  query->bind(0, std::string_view{table});
  std::vector<std::string> columns;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return columns;
    columns.push_back(query->text(0));
  }
}

std::string joined(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, ", "));
}

Result<std::vector<std::int64_t>> meters_of(Database& database) {
  auto query = database.prepare("SELECT number FROM meter ORDER BY number");
  if (!query) return tl::unexpected(query.error());
  std::vector<std::int64_t> meters;
  for (;;) {
    const auto row = query->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return meters;
    meters.push_back(query->integer(0));
  }
}

/// Copies one table. Failures of `from` make holes, failures of `to` end it.
class TableSalvage {
 public:
  TableSalvage(Database& from, const SalvagedTable& table, Statement insert,
               std::vector<std::string> columns)
      : from_(from), table_(table), insert_(std::move(insert)), columns_(std::move(columns)) {}

  [[nodiscard]] Result<SalvagedRows> run(const std::vector<std::int64_t>& meters) {
    if (!table_.by_meter) {
      if (auto copied = copy({}, whole()); !copied) return tl::unexpected(copied.error());
    }
    for (const std::int64_t meter : table_.by_meter ? meters : std::vector<std::int64_t>{}) {
      if (auto copied = copy(meter, whole()); !copied) return tl::unexpected(copied.error());
    }
    return done_;
  }

 private:
  [[nodiscard]] KeyRange whole() const {
    // Times end with 2037, numbers long before that.
    return {0, table_.key == nullptr ? 0 : std::int64_t{1} << 31};
  }

  [[nodiscard]] std::string select() const {
    std::vector<std::string> conditions;
    if (table_.by_meter) conditions.emplace_back("meter = ?1");
    if (table_.key != nullptr)
      conditions.push_back(fmt::format("{} BETWEEN ?2 AND ?3", table_.key));
    std::string sql = fmt::format("SELECT {} FROM {}", joined(columns_), table_.name);
    if (!conditions.empty()) sql += fmt::format(" WHERE {}", fmt::join(conditions, " AND "));
    if (table_.key != nullptr) sql += fmt::format(" ORDER BY {}", table_.key);
    return sql;
  }

  /// The large ranges first: where one ends in a hole, what lies behind it is halved, and the
  /// halves wait for their turn. So a hole costs little more than itself, and many holes cost
  /// bounded time.
  Result<void> copy(std::optional<std::int64_t> meter, KeyRange whole_range) {
    std::deque<KeyRange> ranges{whole_range};
    for (int holes = 0; !ranges.empty() && holes < kHolesMax;) {
      const KeyRange range = ranges.front();
      ranges.pop_front();
      const auto hole = copy_range(meter, range);
      if (!hole) return tl::unexpected(hole.error());
      if (!*hole) continue;
      ++holes;
      done_.is_whole = false;
      if (table_.key == nullptr || range.last - **hole < table_.narrow_down) continue;
      const std::int64_t middle = **hole + (range.last - **hole) / 2;
      ranges.push_back({**hole, middle});
      ranges.push_back({middle + 1, range.last});
    }
    return {};
  }

  /// @return the last key before a hole, or none when all of the range could be read.
  Result<std::optional<std::int64_t>> copy_range(std::optional<std::int64_t> meter,
                                                 KeyRange range) {
    std::optional<std::int64_t> read_until = range.first;
    auto query = from_.prepare(select());
    if (!query) return read_until;
    if (meter) query->bind(0, *meter);
    if (table_.key != nullptr) query->bind(1, range.first).bind(2, range.last);
    for (;;) {
      const auto row = query->step();
      if (!row) return read_until;
      if (!*row) return std::optional<std::int64_t>{};
      if (table_.key != nullptr) read_until = query->integer(key_column());
      if (auto put = put_row(*query); !put) return tl::unexpected(put.error());
    }
  }

  [[nodiscard]] int key_column() const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i] == table_.key) return static_cast<int>(i);
    }
    return 0;
  }

  Result<void> put_row(const Statement& row) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      insert_.bind_column(static_cast<int>(i), row, static_cast<int>(i));
    }
    const auto put = insert_.step();
    if (put) {
      if (*put) ++done_.rows;
      insert_.reset();
      return {};
    }
    // What no row may be was damaged without looking so.
    done_.is_whole = false;
    if (put.error().code == ErrorCode::invalid_value) return {};
    return tl::unexpected(put.error());
  }

  Database& from_;
  const SalvagedTable& table_;
  Statement insert_;
  std::vector<std::string> columns_;
  SalvagedRows done_;
};

}  // namespace

const std::vector<SalvagedTable>& salvaged_tables() {
  static const std::vector<SalvagedTable> tables{
      {"meter", false, "number", 1},      {"edit", false, "number", 1},
      {"interval", true, "t_start", 900}, {"register", true, nullptr, 0},
      {"sample", true, "t", 900},         {"month", true, nullptr, 0},
      {"reopened", true, nullptr, 0},     {"closing", true, nullptr, 0},
      {"event", false, "number", 1},      {"job", false, "number", 1},
      {"forecast", false, "number", 1}};
  return tables;
}

Result<SalvagedRows> salvage(Database& from, Database& to, const SalvagedTable& table) {
  const auto columns = columns_of(from, table.name);
  // A table that the file's version did not have, or a schema that cannot be read.
  if (!columns || columns->empty()) return SalvagedRows{.is_whole = columns.has_value()};
  const auto meters = meters_of(to);
  if (!meters) return tl::unexpected(meters.error());
  auto insert = to.prepare(fmt::format("INSERT OR IGNORE INTO {} ({}) VALUES ({}) RETURNING 1",
                                       table.name, joined(*columns),
                                       joined(std::vector<std::string>(columns->size(), "?"))));
  if (!insert) return tl::unexpected(insert.error());
  return to.transaction([&] {
    return TableSalvage{from, table, std::move(*insert), *columns}.run(*meters);
  });
}

Result<void> name_unknown_meters(Database& from, Database& to) {
  auto has_rows = from.prepare("SELECT 1 FROM interval WHERE meter = ? LIMIT 1");
  if (!has_rows) return {};  // then there is nothing to read
  auto add = to.prepare("INSERT OR IGNORE INTO meter VALUES (?, ?, 900)");
  if (!add) return tl::unexpected(add.error());
  for (std::int64_t number = 0; number < kMetersMax; ++number) {
    const auto row = has_rows->bind(0, number).step();
    const bool has_any = row && *row;
    has_rows->reset();
    if (!has_any) continue;
    const std::string id = fmt::format("unknown-{}", number);
    if (auto added = add->bind(0, number).bind(1, std::string_view{id}).run(); !added) return added;
  }
  return {};
}

}  // namespace recald::sqlite
