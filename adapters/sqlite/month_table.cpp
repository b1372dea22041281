#include "adapters/sqlite/month_table.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/sqlite/interval_row.hpp"
#include "adapters/sqlite/outbox_table.hpp"
#include "adapters/sqlite/tables.hpp"

namespace recald::sqlite {
namespace {

using metering::MonthlyFigure;

void bind_month(Statement& insert, std::uint32_t meter, const StoredMonth& month, int revision) {
  const MonthlyFigure& figure = month.figure;
  insert.bind(0, std::int64_t{meter})
      .bind(1, std::string_view{metering::to_string(figure.month)})
      .bind(2, std::int64_t{revision})
      .bind(3, seconds_of(month.closed_at))
      .bind(4, std::string_view{month.time_zone_release})
      .bind(5, figure.daily_average_kWh)
      .bind(6, figure.daily_average_variance_kWh2);
  if (figure.peak) {
    insert.bind(7, figure.peak->kW)
        .bind(8, seconds_of(figure.peak->start))
        .bind(9, std::int64_t{figure.peak->could_be_exceeded});
  } else {
    insert.bind_null(7).bind_null(8).bind_null(9);
  }
  insert.bind(10, std::int64_t{figure.peak_window.count()})
      .bind(11, figure.coverage)
      .bind(12, figure.filled_share);
  for (int i = 0; i < 5; ++i) {
    insert.bind(13 + i, std::int64_t{figure.slots_by_validity[static_cast<std::size_t>(i)]});
  }
  insert.bind(18, std::int64_t{figure.slots});
  if (figure.usable) {
    insert.bind_null(19);
  } else {
    insert.bind(19, std::string_view{figure.unusable_because});
  }
  insert.bind(20, static_cast<std::int64_t>(figure.reasons));
}

/// Reads columns as in `kMonthColumns`. @return malformed when the month's name is invalid.
Result<StoredMonth> read_month(const Statement& row) {
  const auto month = TRY(metering::parse_month(row.text(0)));
  MonthlyFigure figure{.month = month};
  figure.revision = static_cast<int>(row.integer(1));
  figure.daily_average_kWh = row.real(2);
  figure.daily_average_variance_kWh2 = row.real(3);
  if (!row.is_null(4)) {
    figure.peak =
        metering::PeakDemand{row.real(4), instant_of(row.integer(5)), row.integer(6) != 0};
  }
  figure.peak_window = std::chrono::seconds{row.integer(7)};
  figure.coverage = row.real(8);
  figure.filled_share = row.real(9);
  for (int i = 0; i < 5; ++i) {
    figure.slots_by_validity[static_cast<std::size_t>(i)] = static_cast<int>(row.integer(10 + i));
  }
  figure.slots = static_cast<int>(row.integer(15));
  figure.usable = row.is_null(16);
  figure.unusable_because = row.text(16);
  figure.reasons = static_cast<metering::Reason>(row.integer(17));
  return StoredMonth{std::move(figure), instant_of(row.integer(18)), row.text(19)};
}

constexpr auto kMonthColumns =
    "month, revision, daily_average_kWh, daily_average_variance, peak_kW, peak_at, "
    "peak_could_be_exceeded, peak_window_s, coverage, filled_share, slots_ok, slots_missing, "
    "slots_filled, slots_scaled, slots_suspect, slots, unusable_because, reasons, closed_at, "
    "tzdata";

}  // namespace

Result<int> insert_month(Database& database, std::uint32_t meter, const StoredMonth& month) {
  const std::string name = metering::to_string(month.figure.month);
  return database.transaction([&]() -> Result<int> {
    auto last = TRY(database.prepare(
        "SELECT coalesce(max(revision), -1) FROM month WHERE meter = ? AND month = ?"));
    TRY(last.bind(0, std::int64_t{meter}).bind(1, std::string_view{name}).step());
    const int revision = static_cast<int>(last.integer(0)) + 1;
    last.reset();
    auto insert = TRY(database.prepare(insert_into("month", 21)));
    bind_month(insert, meter, month, revision);
    TRY(insert.run());
    auto told = TRY(database.prepare(insert_outbox_entry()));
    told.bind(0, std::int64_t{meter}).bind_null(1).bind(2, std::string_view{name});
    TRY(told.bind(3, std::int64_t{revision}).run());
    auto settled = TRY(database.prepare("DELETE FROM reopened WHERE meter = ? AND month = ?"));
    settled.bind(0, std::int64_t{meter}).bind(1, std::string_view{name});
    TRY(settled.run());
    return revision;
  });
}

Result<std::optional<StoredMonth>> stored_month(Database& database, std::uint32_t meter,
                                                const std::string& month, int revision) {
  auto query = TRY(database.prepare(fmt::format(
      "SELECT {} FROM month WHERE meter = ? AND month = ? AND revision = ?", kMonthColumns)));
  query.bind(0, std::int64_t{meter}).bind(1, std::string_view{month});
  const auto row = TRY(query.bind(2, std::int64_t{revision}).step());
  if (!row) return std::optional<StoredMonth>{};
  auto read = TRY(read_month(query));
  return std::optional{std::move(read)};
}

Result<std::vector<StoredMonth>> stored_months(Database& database, std::uint32_t meter) {
  auto query = TRY(database.prepare(
      fmt::format("SELECT {} FROM month WHERE meter = ? ORDER BY month, revision", kMonthColumns)));
  query.bind(0, std::int64_t{meter});
  std::vector<StoredMonth> months;
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return months;
    auto month = TRY(read_month(query));
    if (!months.empty() && months.back().figure.month == month.figure.month) months.pop_back();
    months.push_back(std::move(month));
  }
}

Result<std::vector<MeterMonth>> reopened_months(Database& database) {
  auto query = TRY(database.prepare("SELECT meter, month FROM reopened ORDER BY meter, month"));
  std::vector<MeterMonth> months;
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return months;
    const auto month = TRY(metering::parse_month(query.text(1)));
    months.push_back({static_cast<std::uint32_t>(query.integer(0)), month});
  }
}

Result<std::string> closing_rules_of(Database& database, std::uint32_t meter) {
  auto query = TRY(database.prepare("SELECT rules FROM closing WHERE meter = ?"));
  const auto row = TRY(query.bind(0, std::int64_t{meter}).step());
  return row ? query.text(0) : std::string{};
}

Result<int> replace_closing_rules(Database& database, std::uint32_t meter,
                                  const std::string& rules) {
  return database.transaction([&]() -> Result<int> {
    const auto known = TRY(closing_rules_of(database, meter));
    if (known == rules) return 0;
    auto reopen = TRY(database.prepare(
        "INSERT OR IGNORE INTO reopened SELECT DISTINCT meter, month FROM month WHERE meter = ?"));
    reopen.bind(0, std::int64_t{meter});
    TRY(reopen.run());
    auto count = TRY(database.prepare("SELECT count(DISTINCT month) FROM month WHERE meter = ?"));
    TRY(count.bind(0, std::int64_t{meter}).step());
    const auto months = static_cast<int>(count.integer(0));
    count.reset();
    auto put = TRY(database.prepare("INSERT OR REPLACE INTO closing VALUES (?, ?)"));
    put.bind(0, std::int64_t{meter}).bind(1, std::string_view{rules});
    TRY(put.run());
    return months;
  });
}

}  // namespace recald::sqlite
