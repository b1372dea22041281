#include "daemon/site/config/tariff_config.hpp"

#include <fmt/format.h>

#include <array>

namespace recald::daemon {
namespace {

constexpr std::array kUtilities{metering::Utility::electricity, metering::Utility::chilled_water,
                                metering::Utility::heating,     metering::Utility::steam,
                                metering::Utility::gas,         metering::Utility::water};
constexpr NumberRange kPrice{0.0, 1e6};
constexpr NumberRange kHour{0.0, 24.0};
constexpr NumberRange kEmission_kg_kWh{0.0, 10.0};

std::string name_of(metering::Utility utility) { return std::string{metering::to_string(utility)}; }

tariff::PricePeriod read_price_period(TomlReader& table) {
  tariff::PricePeriod period{.from_hour = table.whole_number_or("from", 0, kHour),
                             .to_hour = table.whole_number_or("to", 24, kHour),
                             .days = {true, true, true},
                             .per_kWh = table.required_number("per_kWh", kPrice)};
  const auto days = table.word("days", {"all", "workday", "weekend"});
  if (days == "workday") period.days = {true, false, false};
  if (days == "weekend") period.days = {false, true, true};
  if (period.from_hour == period.to_hour) {
    table.problem("'from' and 'to' are the same hour; leave both out for the whole day");
  }
  table.finish();
  return period;
}

tariff::Prices read_prices(TomlReader& table) {
  tariff::Prices prices{.per_kWh = table.required_number("per_kWh", kPrice),
                        .per_kW_month = table.number_or("per_kW_month", 0.0, kPrice)};
  for (TomlReader& period : table.tables("period"))
    prices.periods.push_back(read_price_period(period));
  table.finish();
  return prices;
}

}  // namespace

void read_tariff(TomlReader& table, tariff::Tariff& tariff) {
  tariff.currency = table.required_text("currency");
  for (const metering::Utility utility : kUtilities) {
    if (auto prices = table.table(name_of(utility))) {
      tariff.prices[static_cast<std::size_t>(utility)] = read_prices(*prices);
    }
  }
  table.finish();
}

void read_emissions(TomlReader& table, tariff::Tariff& tariff) {
  for (const metering::Utility utility : kUtilities) {
    tariff.emissions_kg_per_kWh[static_cast<std::size_t>(utility)] =
        table.number(name_of(utility), kEmission_kg_kWh);
  }
  table.finish();
}

}  // namespace recald::daemon
