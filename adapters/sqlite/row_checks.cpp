#include "adapters/sqlite/row_checks.hpp"

#include <fmt/format.h>

#include "adapters/sqlite/tables/rows.hpp"

namespace recald::sqlite {
namespace {

/// A possible fault of rows, as a query that returns the wrong rows, with the parts of the
/// sentence in order.
struct RowCheck {
  const char* sql;
  const char* sentence;
};
constexpr RowCheck kRowChecks[] = {
    {"SELECT \"table\", count(*) FROM pragma_foreign_key_check GROUP BY 1",
     "table '{}' has {} rows that refer to a missing row"},
    {"SELECT id, datetime(t_start, 'unixepoch') FROM interval JOIN meter ON number = meter "
     "GROUP BY meter, t_start HAVING max(revision) <> count(*) - 1",
     "meter '{}': the revisions of the interval at {} UTC have a gap"},
    {"SELECT id, month FROM month JOIN meter ON number = meter GROUP BY meter, month "
     "HAVING max(revision) <> count(*) - 1",
     "meter '{}': the revisions of month {} have a gap"},
    {"SELECT id, count(*) FROM interval JOIN meter ON number = meter, (SELECT meter AS m, "
     "min(t_start) AS first FROM interval GROUP BY meter) ON m = meter "
     "WHERE (t_start - first) % interval_s <> 0 GROUP BY meter",
     "meter '{}' has {} intervals that are not on its interval grid"},
};

/// At most this many of one kind: a broken table would fill the screen.
constexpr std::size_t kListedMax = 20;

Result<void> check_rows(Database& database, const RowCheck& check,
                        std::vector<std::string>& problems) {
  auto query = TRY(database.prepare(check.sql));
  std::size_t found = 0;
  TRY(for_each_row(query, [&](const Statement& row) {
    if (++found > kListedMax) return;
    problems.push_back(fmt::format(fmt::runtime(check.sentence), row.text(0), row.text(1)));
  }));
  if (found > kListedMax) {
    problems.push_back(fmt::format("… and {} more like the last one", found - kListedMax));
  }
  return {};
}

}  // namespace

Result<std::vector<std::string>> row_problems(Database& database) {
  std::vector<std::string> problems;
  for (const RowCheck& check : kRowChecks) {
    TRY(check_rows(database, check, problems));
  }
  return problems;
}

Result<std::uint64_t> count_intervals(Database& database) {
  auto query = TRY(database.prepare("SELECT count(*) FROM interval"));
  TRY(query.step());
  return static_cast<std::uint64_t>(query.integer(0));
}

}  // namespace recald::sqlite
