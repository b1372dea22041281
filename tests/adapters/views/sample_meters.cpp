#include "tests/adapters/views/sample_meters.hpp"

#include <cmath>

#include "core/random/rng.hpp"
#include "tests/adapters/views/sample_report.hpp"

namespace recald::views {
namespace {

using model::DayType;

/// Three lines by kind of day: 200 kWh/day and 12 kWh/day per kelvin below 15 °C on working days.
TemperatureFit temperature_fit(Rng& rng) {
  TemperatureFit fit;
  fit.sentence =
      "3-parameter heating: 200 kWh/day on workdays, 80 on Saturdays and Sundays and holidays; "
      "12.0 kWh/day more per K below 15 °C.";
  fit.trust =
      "Forecasting the months that it had not seen, it was off by 5.1\u00a0% on average "
      "(CV(RMSE)), "
      "its sum by +0.7\u00a0%; 11 of 12 months lay inside the 90\u00a0% band.";
  fit.rows = {{"Working days", 200.0, 12.0, 15.0, NAN, NAN},
              {"Saturdays, Sundays and holidays", 80.0, 12.0, 15.0, NAN, NAN}};
  fit.lines = {{DayType::workday, {{-8.0, 476.0}, {15.0, 200.0}, {27.0, 200.0}}},
               {DayType::saturday, {{-8.0, 356.0}, {15.0, 80.0}, {27.0, 80.0}}}};
  const std::chrono::sys_days first{std::chrono::year{2019} / 1 / 1};
  for (int day = 0; day < 730; ++day) {
    const metering::Day date{first + std::chrono::days{day}};
    const DayType kind = model::day_type(date, {});
    const double dry_bulb_C = 9.0 - 11.0 * std::cos(day * 0.01721) + 3.0 * rng.normal();
    const double base_kWh = kind == DayType::workday ? 200.0 : 80.0;
    const double energy_kWh =
        base_kWh + 12.0 * std::max(0.0, 15.0 - dry_bulb_C) + 15.0 * rng.normal();
    fit.days.push_back({date, kind, dry_bulb_C, energy_kWh, day >= 365});
  }
  return fit;
}

MeterPart meter_part(const OutputResult& output, Rng& rng) {
  MeterPart part;
  const OutputMonth& last = output.months.back();
  part.year = {.first = last.figure.month - std::chrono::months{11},
               .last = last.figure.month,
               .energy_kWh = 365.0 * 11'800.0,
               .months = 12,
               .change = -0.034,
               .compared = 12};
  for (std::size_t i = 0; i < output.months.size(); ++i) {
    part.month_base_kW.push_back(170.0 + 5.0 * rng.normal());
  }
  for (std::size_t kind = 0; kind < model::kDayTypes; ++kind) {
    for (int hour = 0; hour < 24; ++hour) {
      part.shape.mean_kW.at(static_cast<DayType>(kind), hour) =
          180.0 + (hour >= 7 && hour < 19 ? 260.0 / static_cast<double>(1 + 3 * kind) : 0.0);
    }
  }
  part.shape.days = {251, 52, 62};
  part.shape.base_kW = 172.4;
  part.shape.base_share = 0.41;
  return part;
}

}  // namespace

MetersData sample_meters() {
  Rng rng{20'261'124};
  MetersData data;
  data.common = sample_report();
  ReportData& common = data.common;
  common.title = "Meters (sample, invented numbers)";
  common.headlines.clear();
  common.verdicts.clear();
  common.parameters.clear();
  common.not_known.clear();
  common.profile = {};
  for (OutputResult& output : common.outputs) {
    output.assessment.reset();
    for (OutputMonth& month : output.months) month.box.reset();
    data.meters.push_back(meter_part(output, rng));
  }
  data.meters[0].temperature = temperature_fit(rng);
  data.meters[1].temperature = temperature_fit(rng);
  data.meters[2].no_temperature_because =
      "Electricity: nearly all usable days lie between 8 and 10 °C, too close together for a "
      "slope.";
  for (OutputMonth& month : common.outputs[2].months) month.forecast.reset();
  data.first = {
      .sentence =
          "Steam has changed since Nov 2021: 40\u00a0% less in that "
          "month than in the same months before.",
      .more = "In the months that were not fitted, the weather explains 1 of 2 meters.",
      .numbers = {{"+0.7\u00a0%", "Chilled water, against the forecast from its weather"},
                  {"−12.4\u00a0%", "Steam, against the forecast from its weather"},
                  {"−3.4\u00a0%", "Electricity, 12 months to Dec 2021 against a year before"}}};
  data.changes = {
      "Steam has changed since Nov 2021: 40\u00a0% less in that month than in the "
      "same months before."};
  return data;
}

MetersData young_meters() {
  MetersData data;
  data.common = readings_only_report();
  data.common.title = "Meters of five months (sample, invented numbers)";
  data.common.headlines.clear();
  for (const OutputResult& output : data.common.outputs) {
    MeterPart part;
    part.month_base_kW.assign(output.months.size(), NAN);
    for (std::size_t kind = 0; kind < model::kDayTypes; ++kind) {
      for (int hour = 0; hour < 24; ++hour) {
        part.shape.mean_kW.at(static_cast<DayType>(kind), hour) = NAN;
      }
    }
    part.shape.base_kW = part.shape.base_share = NAN;
    data.meters.push_back(part);
  }
  for (OutputResult& output : data.common.outputs) {
    for (OutputMonth& month : output.months) month.forecast.reset();
  }
  data.no_changes =
      "That shows against the same months of the year before, and no meter has more than one year "
      "yet.";
  data.first.sentence = "Chilled water: 1,200 MWh in 5 months to Mar 2020.";
  data.left_out = "The site has 2 more meters; months.csv has the figures of all.";
  return data;
}

}  // namespace recald::views
