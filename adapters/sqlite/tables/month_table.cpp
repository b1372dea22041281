#include "adapters/sqlite/tables/month_table.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/sqlite/tables/outbox_table.hpp"
#include "adapters/sqlite/tables/rows.hpp"
#include "adapters/sqlite/tables/tables.hpp"

namespace recald::sqlite {
namespace {

using metering::Instant;
using metering::MonthlyFigure;
using metering::PeakDemand;

void bind_month(Statement& insert, std::uint32_t meter, const StoredMonth& month, int revision) {
  const MonthlyFigure& figure = month.figure;
  const auto peak = [&](auto member) {
    return figure.peak ? std::optional{(*figure.peak).*member} : std::nullopt;
  };
  const auto& [ok, missing, filled, scaled, suspect] = figure.slots_by_validity;
  bound(insert, meter, figure.month, revision, month.closed_at, month.time_zone_release,
        figure.daily_average_kWh, figure.daily_average_variance_kWh2, peak(&PeakDemand::kW),
        peak(&PeakDemand::start), peak(&PeakDemand::could_be_exceeded), figure.peak_window,
        figure.coverage, figure.filled_share, ok, missing, filled, scaled, suspect, figure.slots,
        figure.usable ? std::nullopt : std::optional{figure.unusable_because}, figure.reasons);
}

/// Reads columns as in `kMonthColumns`. @return malformed when the month's name is invalid.
Result<StoredMonth> read_month(Columns columns) {
  StoredMonth month{};
  MonthlyFigure& figure = month.figure;
  figure.month = TRY(columns.month());
  figure.revision = columns;
  figure.daily_average_kWh = columns;
  figure.daily_average_variance_kWh2 = columns;
  const auto peak_kW = columns.next<std::optional<double>>();
  const PeakDemand peak{peak_kW.value_or(kAbsent), columns, columns};
  if (peak_kW) figure.peak = peak;
  figure.peak_window = columns;
  figure.coverage = columns;
  figure.filled_share = columns;
  for (int& slots : figure.slots_by_validity) slots = columns;
  figure.slots = columns;
  const auto because = columns.next<std::optional<std::string>>();
  figure.usable = !because;
  figure.unusable_because = because.value_or("");
  figure.reasons = columns;
  month.closed_at = columns;
  month.time_zone_release = columns.next<std::string>();
  return month;
}

constexpr auto kMonthColumns =
    "month, revision, daily_average_kWh, daily_average_variance, peak_kW, peak_at, "
    "peak_could_be_exceeded, peak_window_s, coverage, filled_share, slots_ok, slots_missing, "
    "slots_filled, slots_scaled, slots_suspect, slots, unusable_because, reasons, closed_at, "
    "tzdata";

}  // namespace

Result<int> insert_month(Database& database, std::uint32_t meter, const StoredMonth& month) {
  return database.transaction([&]() -> Result<int> {
    auto last = TRY(database.prepare(
        "SELECT coalesce(max(revision), -1) FROM month WHERE meter = ? AND month = ?"));
    TRY(bound(last, meter, month.figure.month).step());
    const int revision = static_cast<int>(last.integer(0)) + 1;
    last.reset();
    auto insert = TRY(database.prepare(insert_into("month", 21)));
    bind_month(insert, meter, month, revision);
    TRY(insert.run());
    auto entry = TRY(database.prepare(insert_outbox_entry()));
    TRY(bound(entry, meter, std::optional<Instant>{}, month.figure.month, revision).run());
    auto settled = TRY(database.prepare("DELETE FROM reopened WHERE meter = ? AND month = ?"));
    TRY(bound(settled, meter, month.figure.month).run());
    return revision;
  });
}

Result<std::optional<StoredMonth>> stored_month(Database& database, std::uint32_t meter,
                                                const std::string& month, int revision) {
  auto query = TRY(database.prepare(fmt::format(
      "SELECT {} FROM month WHERE meter = ? AND month = ? AND revision = ?", kMonthColumns)));
  const auto row = TRY(bound(query, meter, month, revision).step());
  if (!row) return std::optional<StoredMonth>{};
  auto read = TRY(read_month(Columns{query}));
  return std::optional{std::move(read)};
}

Result<std::vector<StoredMonth>> stored_months(Database& database, std::uint32_t meter) {
  auto query = TRY(database.prepare(
      fmt::format("SELECT {} FROM month WHERE meter = ? ORDER BY month, revision", kMonthColumns)));
  auto months = TRY(all_rows(bound(query, meter), read_month));
  // The last revision of each.
  std::vector<StoredMonth> last;
  for (StoredMonth& month : months) {
    if (!last.empty() && last.back().figure.month == month.figure.month) last.pop_back();
    last.push_back(std::move(month));
  }
  return last;
}

Result<std::vector<MeterMonth>> reopened_months(Database& database) {
  auto query = TRY(database.prepare("SELECT meter, month FROM reopened ORDER BY meter, month"));
  return all_rows(query, [](Columns columns) -> Result<MeterMonth> {
    const auto meter = columns.next<std::uint32_t>();
    return MeterMonth{meter, TRY(columns.month())};
  });
}

Result<std::string> closing_rules_of(Database& database, std::uint32_t meter) {
  auto query = TRY(database.prepare("SELECT rules FROM closing WHERE meter = ?"));
  const auto row = TRY(bound(query, meter).step());
  return row ? query.text(0) : std::string{};
}

Result<int> replace_closing_rules(Database& database, std::uint32_t meter,
                                  const std::string& rules) {
  return database.transaction([&]() -> Result<int> {
    const auto known = TRY(closing_rules_of(database, meter));
    if (known == rules) return 0;
    auto reopen = TRY(database.prepare(
        "INSERT OR IGNORE INTO reopened SELECT DISTINCT meter, month FROM month WHERE meter = ?"));
    TRY(bound(reopen, meter).run());
    auto count = TRY(database.prepare("SELECT count(DISTINCT month) FROM month WHERE meter = ?"));
    TRY(bound(count, meter).step());
    const auto months = static_cast<int>(count.integer(0));
    count.reset();
    auto put = TRY(database.prepare("INSERT OR REPLACE INTO closing VALUES (?, ?)"));
    TRY(bound(put, meter, rules).run());
    return months;
  });
}

}  // namespace recald::sqlite
