/// What energy costs and emits: prices by utility, and a month's bill.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/metering/months/monthly_figure.hpp"
#include "core/metering/reading.hpp"
#include "core/model/electricity_profile.hpp"
#include "core/model/schedule.hpp"

namespace recald::tariff {

/// Hours of some days with a price of their own.
struct PricePeriod {
  int from_hour = 0;  ///< Local, inclusive.
  int to_hour = 24;   ///< Exclusive; smaller than `from_hour`: over midnight.
  std::array<bool, model::kDayTypes> days{true, true, true};
  double per_kWh = 0.0;

  [[nodiscard]] bool contains(model::DayType day, int hour) const;
};

/// Of one utility. Money in the tariff's currency.
struct Prices {
  double per_kWh = 0.0;                ///< At all hours that are in no period.
  std::vector<PricePeriod> periods{};  ///< The first that holds an hour counts.
  double per_kW_month = 0.0;           ///< For each month's highest demand.

  [[nodiscard]] double at(model::DayType day, int hour) const;
};

/// What a site pays and emits, as far as its file says.
struct Tariff {
  std::string currency;                                         ///< "EUR"; empty: no prices.
  std::array<std::optional<Prices>, 6> prices{};                ///< By `metering::Utility`.
  std::array<std::optional<double>, 6> emissions_kg_per_kWh{};  ///< CO2; likewise.

  [[nodiscard]] bool is_empty() const;
  [[nodiscard]] const std::optional<Prices>& prices_of(metering::Utility utility) const {
    return prices[static_cast<std::size_t>(utility)];
  }
  [[nodiscard]] const std::optional<double>& emissions_of(metering::Utility utility) const {
    return emissions_kg_per_kWh[static_cast<std::size_t>(utility)];
  }
};

/// One meter's month. Absent where the tariff does not say.
struct MonthBill {
  std::optional<double> energy;  ///< Money.
  std::optional<double> demand;  ///< Money; 0 where demand is free, absent where no peak is known.
  std::optional<double> emissions_kg;
};

/// @param hours  Of the month: they part its energy among the periods. What was not measured is
///               shared out as what was.
[[nodiscard]] MonthBill bill_of(const Tariff& tariff, metering::Utility utility,
                                const metering::MonthlyFigure& figure,
                                std::span<const model::HourlyLoad> hours,
                                const model::Holidays& holidays);

/// What a kWh of this meter cost on average over its months, demand apart: the price of energy that
/// is saved as the meter uses it. Absent without prices or energy.
[[nodiscard]] std::optional<double> mean_price_per_kWh(const Tariff& tariff,
                                                       metering::Utility utility,
                                                       std::span<const model::HourlyLoad> hours,
                                                       const model::Holidays& holidays);

/// What a meter's use costs and emits. Absent where the tariff does not say.
struct Rates {
  std::optional<double> per_kWh{};       ///< Money; `mean_price_per_kWh`.
  std::optional<double> per_kW_month{};  ///< Money, for a month's highest demand.
  std::optional<double> emissions_kg_per_kWh{};
};

[[nodiscard]] Rates rates_of(const Tariff& tariff, metering::Utility utility,
                             std::span<const model::HourlyLoad> hours,
                             const model::Holidays& holidays);

}  // namespace recald::tariff
