#include "adapters/views/drift/forecast_table.hpp"

#include <fmt/format.h>

#include <vector>

#include "adapters/views/frame/format.hpp"

namespace recald::views {

Table forecast_table(const ForecastSeries& series, std::string_view what) {
  Table table(fmt::format("{}: {} and measured by month, {}", series.label, what, series.unit));
  table.columns({"Month", "5 %", "Median", "95 %", "Measured"});
  for (const ForecastMonth& month : series.months) {
    std::vector<Cell> cells{{month_text(month.month)}};
    for (const auto& value : {month.q05, month.q50, month.q95, month.measured}) {
      cells.push_back({number_text(value), "number"});
    }
    table.row(std::move(cells));
  }
  return table;
}

}  // namespace recald::views
