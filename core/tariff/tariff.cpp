#include "core/tariff/tariff.hpp"

#include <algorithm>
#include <cmath>

namespace recald::tariff {

bool PricePeriod::contains(model::DayType day, int hour) const {
  if (!days[static_cast<std::size_t>(day)]) return false;
  if (from_hour < to_hour) return from_hour <= hour && hour < to_hour;
  return hour >= from_hour || hour < to_hour;
}

double Prices::at(model::DayType day, int hour) const {
  const auto period = std::ranges::find_if(
      periods, [&](const PricePeriod& one) { return one.contains(day, hour); });
  return period == periods.end() ? per_kWh : period->per_kWh;
}

bool Tariff::is_empty() const {
  const auto none = [](const auto& list) {
    return std::ranges::none_of(list, [](const auto& one) { return one.has_value(); });
  };
  return none(prices) && none(emissions_kg_per_kWh);
}

std::optional<double> mean_price_per_kWh(const Tariff& tariff, metering::Utility utility,
                                         std::span<const model::HourlyLoad> hours,
                                         const model::Holidays& holidays) {
  const auto& prices = tariff.prices_of(utility);
  if (!prices) return {};
  if (prices->periods.empty()) return prices->per_kWh;
  double energy_kWh = 0.0;
  double money = 0.0;
  for (const model::HourlyLoad& hour : hours) {
    // What flows back is no reason to pay less for what is drawn.
    if (!(hour.mean_kW > 0.0)) continue;
    energy_kWh += hour.mean_kW;
    money += hour.mean_kW * prices->at(model::day_type(hour.date, holidays), hour.hour);
  }
  if (energy_kWh <= 0.0) return {};
  return money / energy_kWh;
}

MonthBill bill_of(const Tariff& tariff, metering::Utility utility,
                  const metering::MonthlyFigure& figure, std::span<const model::HourlyLoad> hours,
                  const model::Holidays& holidays) {
  MonthBill bill;
  const double energy_kWh = figure.daily_average_kWh * metering::days_in(figure.month);
  if (const auto mean = mean_price_per_kWh(tariff, utility, hours, holidays);
      mean && std::isfinite(energy_kWh)) {
    bill.energy = *mean * energy_kWh;
  }
  if (const auto& prices = tariff.prices_of(utility)) {
    if (prices->per_kW_month == 0.0) {
      bill.demand = 0.0;
    } else if (figure.peak) {
      bill.demand = prices->per_kW_month * figure.peak->kW;
    }
  }
  if (const auto& emissions = tariff.emissions_of(utility);
      emissions && std::isfinite(energy_kWh)) {
    bill.emissions_kg = *emissions * energy_kWh;
  }
  return bill;
}

Rates rates_of(const Tariff& tariff, metering::Utility utility,
               std::span<const model::HourlyLoad> hours, const model::Holidays& holidays) {
  Rates rates{.per_kWh = mean_price_per_kWh(tariff, utility, hours, holidays),
              .emissions_kg_per_kWh = tariff.emissions_of(utility)};
  if (const auto& prices = tariff.prices_of(utility)) rates.per_kW_month = prices->per_kW_month;
  return rates;
}

}  // namespace recald::tariff
