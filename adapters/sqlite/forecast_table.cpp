#include "adapters/sqlite/forecast_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "adapters/sqlite/interval_row.hpp"

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

void bind_forecast(Statement& insert, const StoredForecast& one) {
  insert.bind(0, std::string_view{one.output})
      .bind(1, std::string_view{metering::to_string(one.month)})
      .bind(2, std::string_view{one.model_version})
      .bind(3, std::string_view{one.data_revision})
      .bind(4, seconds_of(one.made))
      .bind(5, one.mean)
      .bind(6, one.sd)
      .bind(7, one.q05)
      .bind(8, one.q50)
      .bind(9, one.q95)
      .bind(10, one.measured)
      .bind(11, one.pit)
      .bind(12, one.standardised)
      .bind(13, one.log_score)
      .bind(14, one.crps);
}

/// Reads the columns in the order of the struct. @return malformed when the month's
/// name is invalid.
Result<StoredForecast> read_forecast(const Statement& row) {
  const auto month = TRY(metering::parse_month(row.text(1)));
  return StoredForecast{.output = row.text(0),
                        .month = month,
                        .revision = static_cast<int>(row.integer(2)),
                        .model_version = row.text(3),
                        .data_revision = row.text(4),
                        .made = instant_of(row.integer(5)),
                        .mean = row.real(6),
                        .sd = row.real(7),
                        .q05 = row.real(8),
                        .q50 = row.real(9),
                        .q95 = row.real(10),
                        .measured = row.real(11),
                        .pit = row.real(12),
                        .standardised = row.real(13),
                        .log_score = row.real(14),
                        .crps = row.real(15)};
}

}  // namespace

Result<void> insert_forecasts(Database& database, std::span<const StoredForecast> forecasts) {
  auto insert = TRY(database.prepare(kInsert));
  for (const StoredForecast& one : forecasts) {
    if (!is_storable(one)) continue;
    bind_forecast(insert, one);
    TRY(insert.run());
  }
  return {};
}

Result<std::vector<StoredForecast>> stored_forecasts(Database& database) {
  auto query = TRY(database.prepare(
      "SELECT output, month, revision, model_version, data_revision, made, mean, sd, q05, q50, q95,"
      " measured, pit, standardised, log_score, crps FROM forecast"
      " ORDER BY output, month, revision"));
  std::vector<StoredForecast> forecasts;
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return forecasts;
    auto one = TRY(read_forecast(query));
    forecasts.push_back(std::move(one));
  }
}

}  // namespace recald::sqlite
