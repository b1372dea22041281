/// The page of a site's meters alone: what they used, when, how it follows the weather, what has
/// changed.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/report/first_screen.hpp"
#include "adapters/report/report_data.hpp"
#include "core/model/schedule.hpp"
#include "core/profile/load_shape.hpp"

namespace recald::report {

/// A meter's last months against the same months of the year before.
struct YearComparison {
  metering::Month first;  ///< Of the later months, twelve where the record has two years.
  metering::Month last;
  double energy_kWh;  ///< Of the usable months among them.
  int months;
  std::optional<double> change;  ///< Share against the months a year before that both have.
  int compared = 0;              ///< Months on either side of that comparison.
};

/// What the temperature adds on some kinds of day. Slopes and balance temperatures are NaN where
/// the form has none.
struct TemperatureRow {
  std::string days;  ///< "Working days"
  double base_kWh;   ///< Of a day without heating or cooling.
  double heating_slope_kWh_K;
  double heating_balance_C;
  double cooling_slope_kWh_K;
  double cooling_balance_C;
};

struct TemperatureLine {
  model::DayType kind;
  std::vector<std::array<double, 2>> points;  ///< °C, kWh/day; straight between them.
};

struct TemperatureDay {
  metering::Day date;
  model::DayType kind;
  double dry_bulb_C;
  double energy_kWh;
  bool unseen;  ///< The regression was not fitted to it.
};

/// A regression of the meter's days on the outdoor temperature.
struct TemperatureFit {
  std::string sentence;  ///< The regression in words.
  std::string trust;     ///< How its forecasts did, as a sentence.
  std::vector<TemperatureRow> rows;
  std::vector<TemperatureLine> lines;
  std::vector<TemperatureDay> days;
};

/// What only this page says of a meter.
struct MeterPart {
  std::optional<YearComparison> year;
  std::vector<double> month_base_kW;  ///< (months of the output) NaN: too few hours.
  profile::LoadShape shape;
  std::optional<TemperatureFit> temperature;
  std::string no_temperature_because;  ///< A sentence; empty where there is a fit.
};

struct MetersData {
  /// Title, site, notices, findings, provenance; outputs, peaks and loads of each meter, with
  /// forecasts where there are any, and no boxes.
  ReportData common;
  FirstScreen first;
  std::vector<MeterPart> meters;     ///< In the order of `common.outputs`.
  std::vector<std::string> changes;  ///< What has changed and when, a sentence each.
  std::string no_changes;            ///< Said where there is none.
  std::string left_out;              ///< Meters that the page does not show, as a sentence.
};

/// Renders the page, by the rules of `render_report`.
[[nodiscard]] std::string render_meters(const MetersData& data);

/// The numbers that the page's script draws.
[[nodiscard]] std::string meters_figure_json(const MetersData& data);

}  // namespace recald::report
