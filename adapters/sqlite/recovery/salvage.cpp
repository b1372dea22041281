#include "adapters/sqlite/recovery/salvage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace recald::sqlite {
namespace {

constexpr std::uint32_t kPagesAtOnce = 2000;  // per transaction

/// Converts a value to this column type. @return whether that is possible.
bool takes(char type, Value& value) {
  using Kind = Value::Kind;
  switch (type) {
    case 'i':
      return value.kind == Kind::integer;
    case 'n':
      return value.kind == Kind::integer || value.kind == Kind::null;
    case 't':
      return value.kind == Kind::text;
    case 'u':
      return value.kind == Kind::text || value.kind == Kind::null;
    default:
      break;
  }
  // SQLite stores a whole number in a real column as an integer.
  if (value.kind == Kind::integer) {
    value = {.kind = Kind::real, .real = static_cast<double>(value.integer)};
  }
  return value.kind == Kind::real || value.kind == Kind::null;
}

/// The row as one of this table, or nothing if it cannot be one.
std::optional<std::vector<Value>> as_row_of(const TableShape& table, const PageRow& row) {
  const std::size_t count = row.values.size();
  const std::size_t most = table.columns() + (table.has_sum() ? 1 : 0);
  if (row.rowid.has_value() != table.has_rowid || count < table.columns_first || count > most) {
    return {};
  }
  std::vector<Value> values = row.values;
  if (row.rowid) {
    if (values[0].kind != Value::Kind::null) return {};
    values[0] = {.kind = Value::Kind::integer, .integer = *row.rowid};
  }
  const std::string types = std::string{table.types} + 'n';
  for (std::size_t i = 0; i < count; ++i) {
    if (!takes(types[i], values[i])) return {};
  }
  return values;
}

/// Rows from before the checksums have none and are accepted.
bool has_right_sum(const TableShape& table, std::span<const Value> values) {
  if (values.size() <= table.columns() || values.back().kind == Value::Kind::null) return true;
  const auto summed = values.subspan(static_cast<std::size_t>(table.summed_from),
                                     table.columns() - static_cast<std::size_t>(table.summed_from));
  return values.back().integer == row_sum(table.name, summed);
}

/// Writes rows of a table, in any schema that recald has had.
class RowWriter {
 public:
  RowWriter(Database& to, const TableShape& table) : to_(to), table_(table) {}

  /// @return whether the row was taken; invalid_value if the schema refuses it.
  [[nodiscard]] Result<bool> put(std::span<const Value> values) {
    auto statement = TRY(statement_for(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      bind(*statement, static_cast<int>(i), values[i]);
    }
    const auto row = TRY(statement->step());
    statement->reset();
    return row;
  }

 private:
  static void bind(Statement& statement, int parameter, const Value& value) {
    switch (value.kind) {
      case Value::Kind::null:
        statement.bind_null(parameter);
        return;
      case Value::Kind::integer:
        statement.bind(parameter, value.integer);
        return;
      case Value::Kind::real:
        statement.bind(parameter, value.real);
        return;
      case Value::Kind::text:
        statement.bind(parameter, std::string_view{value.text});
        return;
    }
  }

  Result<Statement*> statement_for(std::size_t count) {
    if (const auto known = statements_.find(count); known != statements_.end()) {
      return &known->second;
    }
    auto names = TRY(columns_of(to_, table_.name));
    names.resize(count);
    const auto list = fmt::format("{}", fmt::join(names, ", "));
    std::string sql = fmt::format("INTO {} ({}) VALUES (?{})", table_.name, list,
                                  fmt::join(std::vector<std::string>(count, ""), ", ?"));
    if (table_.newer == nullptr) {
      sql = "INSERT OR IGNORE " + sql;
    } else {
      std::vector<std::string> updates;
      for (const std::string& name : names) {
        updates.push_back(fmt::format("{0} = excluded.{0}", name));
      }
      sql = fmt::format("INSERT {} ON CONFLICT DO UPDATE SET {} WHERE {}", sql,
                        fmt::join(updates, ", "), table_.newer);
    }
    auto statement = TRY(to_.prepare(sql + " RETURNING 1"));
    return &statements_.emplace(count, std::move(statement)).first->second;
  }

  Database& to_;
  const TableShape& table_;
  std::map<std::size_t, Statement> statements_;  ///< By number of columns.
};

/// Assigns each row to its table.
class Sorting {
 public:
  explicit Sorting(Database& to) {
    for (const TableShape& table : table_shapes()) writers_.emplace_back(to, table);
  }

  Result<void> put(const PageRow& row) {
    bool was_close = false;
    for (std::size_t i = 0; i < writers_.size(); ++i) {
      const TableShape& table = table_shapes()[i];
      const auto values = as_row_of(table, row);
      if (!values) continue;
      was_close = true;
      if (!has_right_sum(table, *values)) continue;
      const auto taken = writers_[i].put(*values);
      if (!taken && taken.error().code == ErrorCode::invalid_value) continue;
      if (!taken) return tl::unexpected(taken.error());
      done_.rows[table.name] += static_cast<int>(*taken);
      return {};
    }
    done_.refused += static_cast<int>(was_close);
    return {};
  }

  [[nodiscard]] SalvagedRows done() && { return std::move(done_); }

 private:
  std::vector<RowWriter> writers_;  ///< By table.
  SalvagedRows done_;
};

/// Runs a statement until it changes nothing more. @pre it ends with RETURNING.
Result<void> run_while_it_changes(Database& database, std::string_view sql) {
  auto statement = TRY(database.prepare(sql));
  for (;;) {
    const auto row = TRY(statement.step());
    if (!row) return {};
    if (auto done = statement.run(); !done) return done;
  }
}

}  // namespace

Result<SalvagedRows> salvage(const PagedFile& from, Database& to, const OnProgress& on_progress) {
  const PageOf page_of = [&](std::uint32_t number) { return from.page(number); };
  Sorting sorting{to};
  for (std::uint32_t first = 1; first <= from.pages(); first += kPagesAtOnce) {
    TRY(to.transaction([&]() -> Result<void> {
      for (std::uint32_t n = first; n < first + kPagesAtOnce && n <= from.pages(); ++n) {
        for (const PageRow& row : rows_on_page(from.page(n), n == 1, page_of)) {
          if (auto put = sorting.put(row); !put) return put;
        }
      }
      return {};
    }));
    if (on_progress) on_progress();
  }
  return std::move(sorting).done();
}

Result<void> mend_references(Database& database) {
  auto mended = database.execute(R"sql(
INSERT INTO edit SELECT DISTINCT edit, 0, '', 'its reason was lost with a damaged page', '', '', NULL
FROM interval WHERE edit NOT IN (SELECT number FROM edit);
DELETE FROM interval WHERE meter NOT IN (SELECT number FROM meter)
  AND meter IN (SELECT meter FROM interval GROUP BY meter HAVING count(*) < 4);
INSERT INTO meter SELECT DISTINCT meter, 'unknown-' || meter, 900, NULL
FROM interval WHERE meter NOT IN (SELECT number FROM meter);
DELETE FROM register WHERE meter NOT IN (SELECT number FROM meter);
DELETE FROM sample WHERE meter NOT IN (SELECT number FROM meter);
DELETE FROM month WHERE meter NOT IN (SELECT number FROM meter);
DELETE FROM reopened WHERE meter NOT IN (SELECT number FROM meter);
DELETE FROM closing WHERE meter NOT IN (SELECT number FROM meter);
)sql");
  if (!mended) return mended;
  // A revision moves down only if the number below is free, so this takes several rounds.
  mended = run_while_it_changes(database, R"sql(
UPDATE OR IGNORE interval SET revision = revision - 1, sum = row_sum('interval', meter, t_start,
  revision - 1, mean_kW, validity, late, reasons, edit)
WHERE revision > 0 AND NOT EXISTS (SELECT 1 FROM interval AS below WHERE below.meter = interval.meter
  AND below.t_start = interval.t_start AND below.revision = interval.revision - 1)
RETURNING 1)sql");
  if (!mended) return mended;
  return run_while_it_changes(database, R"sql(
UPDATE OR IGNORE month SET revision = revision - 1, sum = NULL
WHERE revision > 0 AND NOT EXISTS (SELECT 1 FROM month AS below WHERE below.meter = month.meter
  AND below.month = month.month AND below.revision = month.revision - 1)
RETURNING 1)sql");
}

}  // namespace recald::sqlite
