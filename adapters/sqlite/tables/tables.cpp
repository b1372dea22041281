#include "adapters/sqlite/tables/tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sqlite3.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "adapters/sqlite/tables/handles.hpp"

namespace recald::sqlite {
namespace {

/// The time of the last sample in a counter's state, which is JSON.
constexpr auto kNewerRegister =
    "json_valid(excluded.state) AND (NOT json_valid(register.state) OR "
    "coalesce(json_extract(excluded.state, '$.power.until'), "
    "json_extract(excluded.state, '$.counter.baseline.time')) > "
    "coalesce(json_extract(register.state, '$.power.until'), "
    "json_extract(register.state, '$.counter.baseline.time')))";

constexpr std::array<TableShape, 13> kShapes{{
    {"meter", true, "iti", 3, 0, nullptr},
    {"edit", true, "iitttt", 6, 1, nullptr},
    {"interval", false, "iiiriiin", 7, 0, nullptr},
    {"register", false, "itt", 3, 0, kNewerRegister},
    {"sample", false, "iitr", 4, 0, nullptr},
    {"month", false, "itiitrrrnnirriiiiiiui", 21, 0, nullptr},
    {"reopened", false, "it", 2, -1, nullptr},
    {"closing", true, "it", 2, -1, nullptr},
    {"event", true, "iiitttin", 6, 1, "excluded.count > event.count"},
    {"job", true, "iiitinnittti", 11, 1,
     "excluded.state > job.state OR excluded.tries > job.tries"},
    {"forecast", true, "ittittirrrrrrrrrr", 17, 1, nullptr},
    {"cursor", false, "ti", 2, 0, "excluded.position > cursor.position"},
    {"outbox", true, "iinui", 5, 1, nullptr},
}};

/// The bytes are gathered first, because most values are short and a call takes as long as a
/// hundred bytes.
class Crc {
 public:
  void add(const void* bytes, std::size_t size) {
    if (size > gathered_.size() - used_) flush();
    if (size > gathered_.size()) {
      sum_ = crc32(sum_, static_cast<const Bytef*>(bytes), static_cast<uInt>(size));
      return;
    }
    std::memcpy(gathered_.data() + used_, bytes, size);
    used_ += size;
  }
  void add(char tag) { add(&tag, 1); }
  void add(std::int64_t value) {
    add('i');
    add(&value, sizeof value);
  }
  /// SQLite returns −0 as 0.
  void add(double value) {
    const double stored = value == 0.0 ? 0.0 : value;
    add('r');
    add(&stored, sizeof stored);
  }
  void add(std::string_view text) {
    const auto size = static_cast<std::uint32_t>(text.size());
    add('t');
    add(&size, sizeof size);
    add(text.data(), text.size());
  }
  [[nodiscard]] std::uint32_t sum() {
    flush();
    return static_cast<std::uint32_t>(sum_);
  }

 private:
  void flush() { sum_ = crc32(sum_, gathered_.data(), static_cast<uInt>(std::exchange(used_, 0))); }

  std::array<Bytef, 256> gathered_;
  std::size_t used_ = 0;
  uLong sum_ = crc32(0, nullptr, 0);
};

void add(Crc& crc, sqlite3_value* value) {
  switch (sqlite3_value_type(value)) {
    case SQLITE_INTEGER:
      return crc.add(static_cast<std::int64_t>(sqlite3_value_int64(value)));
    case SQLITE_FLOAT:
      return crc.add(sqlite3_value_double(value));
    case SQLITE_NULL:
      return crc.add('n');
    default:
      break;
  }
  const auto* text = reinterpret_cast<const char*>(sqlite3_value_text(value));
  const auto size = static_cast<std::size_t>(sqlite3_value_bytes(value));
  crc.add(text == nullptr ? std::string_view{} : std::string_view{text, size});
}

/// row_sum(table, value, …) in SQL.
void sql_row_sum(sqlite3_context* context, int count, sqlite3_value** values) {
  Crc crc;
  for (int i = 0; i < count; ++i) add(crc, values[i]);
  sqlite3_result_int64(context, crc.sum());
}

std::string parameters(int count) {
  std::string list = "?1";
  for (int i = 2; i <= count; ++i) list += fmt::format(", ?{}", i);
  return list;
}

}  // namespace

std::span<const TableShape> table_shapes() { return kShapes; }

Result<std::vector<std::string>> columns_of(Database& database, std::string_view table) {
  auto query = TRY(database.prepare("SELECT name FROM pragma_table_info(?)"));
  query.bind(0, table);
  std::vector<std::string> columns;
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return columns;
    columns.push_back(query.text(0));
  }
}

std::uint32_t row_sum(std::string_view table, std::span<const Value> values) {
  Crc crc;
  crc.add(table);
  for (const Value& value : values) {
    switch (value.kind) {
      case Value::Kind::null:
        crc.add('n');
        break;
      case Value::Kind::integer:
        crc.add(value.integer);
        break;
      case Value::Kind::real:
        crc.add(value.real);
        break;
      case Value::Kind::text:
        crc.add(std::string_view{value.text});
        break;
    }
  }
  return crc.sum();
}

void add_row_sum(sqlite3* database) {
  // Fails only when out of memory; a statement that needs it then reports that it is missing.
  (void)sqlite3_create_function(database, "row_sum", -1,
                                SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS, nullptr,
                                sql_row_sum, nullptr, nullptr);
}

std::string sum_of(std::string_view table, int count) {
  return fmt::format("row_sum('{}', {})", table, parameters(count));
}

std::string insert_into(std::string_view table, int count, std::string_view verb) {
  return fmt::format("{} INTO {} VALUES ({}, {})", verb, table, parameters(count),
                     sum_of(table, count));
}

Result<std::string> wrong_sums(Database& database) {
  std::vector<std::string> found;
  for (const TableShape& table : table_shapes()) {
    if (!table.has_sum()) continue;
    auto columns = TRY(columns_of(database, table.name));
    // A table of an older schema has no checksums yet.
    if (columns.size() != table.columns() + 1) continue;
    columns.pop_back();
    columns.erase(columns.begin(), columns.begin() + table.summed_from);
    auto query = TRY(
        database.prepare(fmt::format("SELECT count(*) FROM {0} WHERE sum <> row_sum('{0}', {1})",
                                     table.name, fmt::join(columns, ", "))));
    TRY(query.step());
    const std::int64_t rows = query.integer(0);
    if (rows > 0) found.push_back(fmt::format("{} of {}", rows, table.name));
  }
  if (found.empty()) return std::string{};
  return fmt::format("rows with a wrong checksum: {}", fmt::join(found, ", "));
}

}  // namespace recald::sqlite
