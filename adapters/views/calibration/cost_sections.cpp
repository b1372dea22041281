#include <fmt/format.h>

#include <array>
#include <map>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

/// Sums of bills; absent where no month has the part.
struct BillSum {
  int months = 0;
  std::optional<double> energy{};
  std::optional<double> demand{};
  std::optional<double> emissions_kg{};

  void add(const tariff::MonthBill& bill) {
    ++months;
    const auto to = [](std::optional<double>& sum, const std::optional<double>& part) {
      if (part) sum = sum.value_or(0.0) + *part;
    };
    to(energy, bill.energy);
    to(demand, bill.demand);
    to(emissions_kg, bill.emissions_kg);
  }
};

Cell money_cell(const std::optional<double>& money) {
  return {money ? count_text(*money) : "–", "number"};
}

std::vector<std::string> bill_columns(std::string first, bool with_months,
                                      const std::string& currency) {
  std::vector<std::string> columns{std::move(first)};
  if (with_months) columns.emplace_back("Months");
  if (!currency.empty()) {
    columns.insert(columns.end(), {"Energy, " + currency, "Demand, " + currency});
  }
  columns.emplace_back("CO2, t");
  return columns;
}

void add_bill(std::vector<Cell>& cells, const BillSum& sum, const std::string& currency) {
  if (!currency.empty()) {
    cells.push_back(money_cell(sum.energy));
    cells.push_back(money_cell(sum.demand));
  }
  cells.push_back({sum.emissions_kg ? number_text(1e-3 * *sum.emissions_kg) : "–", "number"});
}

void write_years(Html& html, const ReportData& data) {
  Table table("By calendar year; only the months of the record");
  table.columns(bill_columns("Year", true, data.currency));
  for (const MeterCosts& meter : data.costs) {
    std::map<int, BillSum> years;
    for (const MonthCost& one : meter.months) years[int{one.month.year()}].add(one.bill);
    table.group(meter.meter);
    for (const auto& [year, sum] : years) {
      std::vector<Cell> cells{{std::to_string(year)}, {std::to_string(sum.months), "number"}};
      add_bill(cells, sum, data.currency);
      table.row(std::move(cells));
    }
  }
  table.write(html);
}

void write_months(Html& html, const ReportData& data) {
  Table table("By month");
  table.columns(bill_columns("Month", false, data.currency));
  for (const MeterCosts& meter : data.costs) {
    table.group(meter.meter);
    for (const MonthCost& one : meter.months) {
      BillSum month;
      month.add(one.bill);
      std::vector<Cell> cells{{month_text(one.month)}};
      add_bill(cells, month, data.currency);
      table.row(std::move(cells));
    }
  }
  html.markup("<details class=\"data\"><summary>Cost and CO2 month by month</summary>\n");
  table.write(html);
  html.markup("</details>\n");
}

void add_sum_row(Table& table, const std::string& unit, const std::optional<ForecastSum>& sum,
                 std::string (*text)(double)) {
  if (!sum) return;
  std::vector<Cell> cells{{unit}};
  for (const double value : std::array{sum->mean, sum->q05, sum->q95, sum->measured}) {
    cells.push_back({text(value), "number"});
  }
  table.row(std::move(cells));
}

}  // namespace

void write_cost_section(Html& html, const ReportData& data) {
  if (data.costs.empty()) return;
  open_section(html, "costs", "What did it cost?");
  html.element("p",
               "By the prices and emissions of the site file. Energy that was estimated is priced "
               "like the measured energy of its month.");
  write_years(html, data);
  write_months(html, data);
  html.markup("</section>\n");
}

void write_forecast_cost_section(Html& html, const ReportData& data) {
  if (data.forecast_costs.empty()) return;
  open_section(html, "costs", "What do the forecast months cost?");
  html.element("p",
               "Months that the model has not seen, by the prices and emissions of the site file. "
               "Demand charges are not included.");
  Table table("Forecast with its 90 % band, and what was measured");
  table.columns({"", "Forecast", "5 %", "95 %", "Measured"});
  for (const ForecastCost& cost : data.forecast_costs) {
    table.group(fmt::format("{}, {} month{}, {} to {}", cost.meter, cost.months,
                            cost.months == 1 ? "" : "s", month_text(cost.first),
                            month_text(cost.last)));
    add_sum_row(table, "Cost, " + data.currency, cost.money, count_text);
    add_sum_row(table, "CO2, t", cost.emissions_t, [](double t) { return number_text(t); });
  }
  table.write(html);
  html.markup("</section>\n");
}

}  // namespace recald::views
