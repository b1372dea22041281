/// The page of a site's meters, without a model: what they used, when, how it depends on the
/// weather, what has changed.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "adapters/views/frame/first_screen.hpp"
#include "adapters/views/frame/report_data.hpp"
#include "core/model/schedule.hpp"
#include "core/profile/load_shape.hpp"

namespace recald::views {

/// A meter's latest months compared with the same months of the year before.
struct YearComparison {
  metering::Month first;  ///< Of the later months, twelve if the record has two years.
  metering::Month last;
  double energy_kWh;  ///< Of the usable months among them.
  int months;
  std::optional<double> change;  ///< Relative to the months a year before that both have.
  int compared = 0;              ///< Number of months on either side of that comparison.
};

/// How the temperature affects certain kinds of day. Slopes and balance temperatures are NaN if
/// the form has none.
struct TemperatureRow {
  std::string days;  ///< "Working days"
  double base_kWh;   ///< On a day without heating or cooling.
  double heating_slope_kWh_K;
  double heating_balance_C;
  double cooling_slope_kWh_K;
  double cooling_balance_C;
};

struct TemperatureLine {
  model::DayType kind;
  std::vector<std::array<double, 2>> points;  ///< °C, kWh/day; the line is straight between them.
};

struct TemperatureDay {
  metering::Day date;
  model::DayType kind;
  double dry_bulb_C;
  double energy_kWh;
  bool unseen;  ///< Not used in the fit.
};

/// A regression of the meter's days on the outdoor temperature.
struct TemperatureFit {
  std::string sentence;  ///< The regression in words.
  std::string trust;     ///< How well its forecasts have done, as a sentence.
  std::vector<TemperatureRow> rows;
  std::vector<TemperatureLine> lines;
  std::vector<TemperatureDay> days;
};

/// Data of a meter that only this page shows.
struct MeterPart {
  std::optional<YearComparison> year;
  std::vector<double> month_base_kW;  ///< (months of the output) NaN: too few hours.
  profile::LoadShape shape;
  std::optional<TemperatureFit> temperature;
  std::string no_temperature_because;  ///< A sentence; empty if there is a fit.
};

struct MetersData {
  /// Title, site, notices, findings, provenance; outputs, peaks and loads of each meter, with
  /// forecasts if there are any, but no boxes.
  ReportData common;
  FirstScreen first;
  std::vector<MeterPart> meters;     ///< In the order of `common.outputs`.
  std::vector<std::string> changes;  ///< What has changed and when, one sentence each.
  std::string no_changes;            ///< Shown if there is none.
  std::string left_out;              ///< The meters that the page does not show, as a sentence.
};

/// Renders the page under the rules of `render_report`.
[[nodiscard]] std::string render_meters(const MetersData& data);

/// The numbers that the page's script draws.
[[nodiscard]] std::string meters_figure_json(const MetersData& data);

}  // namespace recald::views
