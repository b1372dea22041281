#include "adapters/sqlite/tables/forecast_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "adapters/sqlite/tables/rows.hpp"

namespace recald::sqlite {
namespace {

/// Skips a forecast that the same model already made of the same figure.
constexpr auto kInsert = R"sql(
INSERT INTO forecast
SELECT NULL, ?1, ?2, revision, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15,
       row_sum('forecast', ?1, ?2, revision, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15)
FROM (SELECT coalesce(max(revision) + 1, 0) AS revision FROM forecast WHERE output = ?1 AND month = ?2)
WHERE NOT EXISTS (SELECT 1 FROM forecast WHERE output = ?1 AND month = ?2 AND model_version = ?3
                  AND measured = ?11)
)sql";

/// A NaN would become a NULL, which the table refuses.
bool is_storable(const StoredForecast& one) {
  const std::array figures{one.mean,     one.sd,  one.q05,          one.q50,       one.q95,
                           one.measured, one.pit, one.standardised, one.log_score, one.crps};
  return std::ranges::none_of(figures, [](double figure) { return std::isnan(figure); });
}

/// Columns in the order of the struct. @return malformed when the month's name is invalid.
Result<StoredForecast> read_forecast(Columns columns) {
  StoredForecast one{.output = columns, .month = {}};
  one.month = TRY(columns.month());
  one.revision = columns;
  one.model_version = columns.next<std::string>();
  one.data_revision = columns.next<std::string>();
  one.made = columns;
  for (double* const figure : {&one.mean, &one.sd, &one.q05, &one.q50, &one.q95, &one.measured,
                               &one.pit, &one.standardised, &one.log_score, &one.crps}) {
    *figure = columns;
  }
  return one;
}

}  // namespace

Result<void> insert_forecasts(Database& database, std::span<const StoredForecast> forecasts) {
  auto insert = TRY(database.prepare(kInsert));
  for (const StoredForecast& one : forecasts) {
    if (!is_storable(one)) continue;
    TRY(bound(insert, one.output, one.month, one.model_version, one.data_revision, one.made,
              one.mean, one.sd, one.q05, one.q50, one.q95, one.measured, one.pit, one.standardised,
              one.log_score, one.crps)
            .run());
  }
  return {};
}

Result<std::vector<StoredForecast>> stored_forecasts(Database& database) {
  auto query = TRY(database.prepare(
      "SELECT output, month, revision, model_version, data_revision, made, mean, sd, q05, q50, q95,"
      " measured, pit, standardised, log_score, crps FROM forecast"
      " ORDER BY output, month, revision"));
  return all_rows(query, read_forecast);
}

}  // namespace recald::sqlite
