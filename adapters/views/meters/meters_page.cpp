#include "adapters/views/meters/meters_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/views/frame/figure_data.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/page.hpp"
#include "adapters/views/frame/sections.hpp"
#include "core/display/unit.hpp"

namespace recald::views {
namespace {

using assessment::MonthRole;
using model::DayType;
using nlohmann::json;

constexpr std::array<const char*, model::kDayTypes> kKinds = {"Working days", "Saturdays",
                                                              "Sundays and holidays"};

constexpr std::string_view kKindsKey =
    "<span><i class=\"sign line-0\">●</i>working days</span>"
    "<span><i class=\"sign line-1\">◆</i>Saturdays</span>"
    "<span><i class=\"sign line-2\">▲</i>Sundays and holidays</span>";

bool is_forecast(const OutputResult& output) {
  return std::ranges::any_of(output.months,
                             [](const OutputMonth& month) { return month.forecast.has_value(); });
}

bool any_forecast(const MetersData& data) {
  return std::ranges::any_of(data.common.outputs, is_forecast);
}

std::vector<OverviewMeter> forecast_overview(const MetersData& data) {
  std::vector<OverviewMeter> meters;
  for (const OutputResult& output : data.common.outputs) {
    const display::Unit& daily = output.units.daily;
    OverviewMeter& meter = meters.emplace_back(OverviewMeter{output.label, daily.name, {}});
    for (const OutputMonth& month : output.months) {
      OverviewMonth& shown = meter.months.emplace_back(
          OverviewMonth{month.figure.month,
                        month.number,
                        month.role,
                        month.figure.usable ? daily.shown(month.figure.daily_average_kWh) : NAN,
                        {}});
      if (month.forecast) {
        shown.band = {daily.shown(month.forecast->q05), daily.shown(month.forecast->q50),
                      daily.shown(month.forecast->q95)};
      }
    }
  }
  return meters;
}

// ---------------------------------------------------------------- in short

const metering::MonthlyFigure* highest_peak(const PeakSeries& series) {
  const metering::MonthlyFigure* highest = nullptr;
  for (const metering::MonthlyFigure& figure : series.months) {
    if (!figure.peak) continue;
    if (highest == nullptr || figure.peak->kW > highest->peak->kW) highest = &figure;
  }
  return highest;
}

std::string year_text(const YearComparison& year) {
  const std::string last = month_text(year.last);
  return year.first == year.last ? last : fmt::format("{} to {}", month_text(year.first), last);
}

void write_glance(Html& html, const MetersData& data) {
  Table table("The meters at a glance");
  table.columns({"Meter", "Months", "Used", "Against the year before", "Base load", "Its share",
                 "Highest peak", "Peak began (local time)"});
  for (std::size_t i = 0; i < data.meters.size(); ++i) {
    const MeterPart& meter = data.meters[i];
    const display::MeterUnits& units = data.common.outputs[i].units;
    const auto* peak = highest_peak(data.common.peaks[i]);
    table.row(
        {{data.common.outputs[i].label},
         {meter.year ? year_text(*meter.year) : "–", "nowrap"},
         {meter.year ? amount_text(meter.year->energy_kWh / 1000.0, units.large_energy) : "–",
          "number"},
         {meter.year && meter.year->change ? signed_percent_text(*meter.year->change) : "–",
          "number"},
         {amount_text(meter.shape.base_kW, units.power), "number"},
         {percent_text(meter.shape.base_share, 0), "number"},
         {peak != nullptr ? amount_text(peak->peak->kW, units.power) : "–", "number"},
         {peak != nullptr ? local_text(peak->peak->start, data.common.calendar) : "", "nowrap"}});
  }
  table.write(html);
  html.element(
      "p",
      "The load is above the base load in 95 % of all hours; its share is of all the energy that "
      "the meter counted.",
      "muted");
}

void write_short_section(Html& html, const MetersData& data) {
  open_section(html, "meters", "In short");
  write_first_words(html, data.first);
  write_key_numbers(html, data.first);
  write_overview(
      html, forecast_overview(data),
      {"forecast from the outdoor temperature", "Nine of ten months should lie inside the band."});
  write_glance(html, data);
  if (!data.left_out.empty()) html.element("p", data.left_out);
  write_notices(html, data.common.notices);
  html.markup("</section>\n");
}

// ---------------------------------------------------------------- changes

void write_changes_section(Html& html, const MetersData& data) {
  if (data.meters.empty()) return;
  open_section(html, "level-changes", "What has changed, and when?");
  if (data.changes.empty()) {
    html.element("p", data.no_changes);
  } else {
    html.markup("<ul class=\"plain\">\n");
    for (const std::string& sentence : data.changes) html.element("li", sentence);
    html.markup("</ul>\n");
  }
  html.markup("</section>\n");
}

// ---------------------------------------------------------------- months

std::string remark_of(const OutputMonth& month) {
  std::string remark = month.figure.usable ? "" : "✕ not usable";
  if (month.flagged_different) remark += remark.empty() ? "◆ different" : ", ◆ different";
  return remark;
}

Table month_table(const OutputResult& output, const MeterPart& meter) {
  const bool forecast = is_forecast(output);
  Table table(output.label + " by month");
  const auto& [power, energy, large_energy, daily, per_degree] = output.units;
  std::vector<std::string> columns{"Month",     "Measured, " + daily.name,  "Remark",
                                   "Estimated", "Base load, " + power.name, "Peak, " + power.name};
  if (forecast) columns.insert(columns.end(), {"Forecast, " + daily.name, "5 %", "95 %"});
  table.columns(columns);
  for (std::size_t i = 0; i < output.months.size(); ++i) {
    const OutputMonth& month = output.months[i];
    const auto& peak = month.figure.peak;
    std::vector<Cell> cells{{month_text(month.figure.month)},
                            {number_text(daily.shown(month.figure.daily_average_kWh)), "number"},
                            {remark_of(month), "nowrap"},
                            {percent_text(month.figure.filled_share), "number"},
                            {number_text(power.shown(meter.month_base_kW[i])), "number"},
                            {peak ? number_text(power.shown(peak->kW)) : "–", "number"}};
    if (forecast) {
      const auto& f = month.forecast;
      for (const double value : {f ? f->mean : NAN, f ? f->q05 : NAN, f ? f->q95 : NAN}) {
        cells.push_back({number_text(daily.shown(value)), "number"});
      }
    }
    table.row(std::move(cells));
  }
  return table;
}

void write_months_section(Html& html, const MetersData& data) {
  if (data.meters.empty()) return;
  open_section(html, "months", "How much, month by month?");
  html.markup("<p class=\"key\" aria-hidden=\"true\">");
  if (any_forecast(data)) html.markup("<span><i class=\"sign box\"></i>forecast</span>");
  html.markup(
      "<span><i class=\"sign\">★</i>measured</span>"
      "<span><i class=\"sign hollow\">☆</i>measured, not usable</span>"
      "<span><i class=\"sign different\">◆</i>measured, at another level than before</span></p>\n");
  for (std::size_t i = 0; i < data.meters.size(); ++i) {
    const OutputResult& output = data.common.outputs[i];
    const bool forecast = is_forecast(output);
    write_figure(
        html,
        {.kind = "months",
         .index = static_cast<int>(i),
         .title = output.label + ", daily mean of each month",
         .description =
             fmt::format("Monthly daily mean of {}, {} months{}.", output.label,
                         output.months.size(), forecast ? ", against box plots of forecasts" : ""),
         .caption = std::string{forecast ? "Box: the middle half of the forecast; whiskers: nine "
                                           "tenths of it. A fitted month is forecast from the "
                                           "others. "
                                         : ""} +
                    "The number under a month is the share of its intervals that are estimated, "
                    "not measured."},
        month_table(output, data.meters[i]));
  }
  html.markup("</section>\n");
}

// ---------------------------------------------------------------- temperature

void write_regressions(Html& html, const MetersData& data) {
  Table table("What a day uses, by the outdoor temperature");
  table.columns({"Days", "Without heating and cooling, a day", "Heating, a day per degree", "Below",
                 "Cooling, a day per degree", "Above"});
  const display::Unit outdoor = display::unit_of(data.common.units, "degC");
  const auto balance = [&](double balance_C) {
    return std::isfinite(balance_C) ? fmt::format("{:.1f}", outdoor.shown(balance_C)) : "–";
  };
  for (std::size_t i = 0; i < data.meters.size(); ++i) {
    const auto& fit = data.meters[i].temperature;
    if (!fit) continue;
    const display::MeterUnits& units = data.common.outputs[i].units;
    table.group(
        fmt::format("{}: {}, {}", data.common.outputs[i].label, units.energy.name, outdoor.name));
    for (const TemperatureRow& row : fit->rows) {
      table.row({{row.days},
                 {number_text(units.daily.shown(row.base_kWh)), "number"},
                 {number_text(units.daily_per_degree.shown(row.heating_slope_kWh_K)), "number"},
                 {balance(row.heating_balance_C), "number"},
                 {number_text(units.daily_per_degree.shown(row.cooling_slope_kWh_K)), "number"},
                 {balance(row.cooling_balance_C), "number"}});
    }
  }
  table.write(html);
}

Table days_table(const OutputResult& output, const display::Unit& outdoor,
                 const TemperatureFit& fit) {
  const display::Unit& energy = output.units.energy;
  Table table(output.label + ": days and their temperatures");
  table.columns(
      {"Day", "Kind of day", "Outdoor mean, " + outdoor.name, "Used, " + energy.name, "Fitted"});
  for (const TemperatureDay& day : fit.days) {
    table.row({{day_key(day.date)},
               {kKinds[static_cast<std::size_t>(day.kind)], "nowrap"},
               {fmt::format("{:.1f}", outdoor.shown(day.dry_bulb_C)), "number"},
               {number_text(energy.shown(day.energy_kWh)), "number"},
               {day.unseen ? "no" : "yes"}});
  }
  return table;
}

void write_temperature_figure(Html& html, const OutputResult& output, const display::Unit& outdoor,
                              const TemperatureFit& fit, int index) {
  const std::string& label = output.label;
  write_figure(html,
               {.kind = "temperature",
                .index = index,
                .title = label + " against the outdoor temperature",
                .description = fmt::format("Scatter of {} days of {} against their mean outdoor "
                                           "temperature, with the regression. {}",
                                           fit.days.size(), label, fit.sentence),
                .caption = fit.sentence + (fit.trust.empty() ? "" : " " + fit.trust)},
               days_table(output, outdoor, fit));
}

void write_temperature_section(Html& html, const MetersData& data) {
  const bool any = std::ranges::any_of(
      data.meters, [](const MeterPart& meter) { return meter.temperature.has_value(); });
  const bool none_said = std::ranges::all_of(
      data.meters, [](const MeterPart& meter) { return meter.no_temperature_because.empty(); });
  if (!any && none_said) return;
  open_section(html, "temperature", "How do the meters follow the weather?");
  if (any) {
    html.element("p",
                 "A regression of each meter's days on the mean outdoor temperature. It needs no "
                 "model of the building, and forecasts the months that it has not seen.");
    write_regressions(html, data);
    html.markup("<p class=\"key\" aria-hidden=\"true\">")
        .markup(kKindsKey)
        .markup(
            "<span><i class=\"sign hollow\">○</i>hollow: the regression was not fitted to it"
            "</span><span><i class=\"sign line\"></i>regression</span></p>\n");
  }
  html.markup("<div class=\"multiples wide\">\n");
  for (std::size_t i = 0; i < data.meters.size(); ++i) {
    const MeterPart& meter = data.meters[i];
    if (!meter.temperature) continue;
    write_temperature_figure(html, data.common.outputs[i],
                             display::unit_of(data.common.units, "degC"), *meter.temperature,
                             static_cast<int>(i));
  }
  html.markup("</div>\n");
  std::string last_reason;
  for (const MeterPart& meter : data.meters) {
    if (meter.no_temperature_because.empty() || meter.no_temperature_because == last_reason)
      continue;
    last_reason = meter.no_temperature_because;  // a reason that all meters share is written once
    html.element("p", last_reason);
  }
  html.markup("</section>\n");
}

// ---------------------------------------------------------------- days

Table shape_table(const OutputResult& output, const profile::LoadShape& shape) {
  const display::Unit& power = output.units.power;
  Table table(fmt::format("{}: mean load by hour, {}", output.label, power.name));
  table.columns({"Hour", kKinds[0], kKinds[1], kKinds[2]});
  for (int hour = 0; hour < 24; ++hour) {
    std::vector<Cell> cells{{fmt::format("{:02}–{:02} h", hour, hour + 1)}};
    for (std::size_t kind = 0; kind < model::kDayTypes; ++kind) {
      cells.push_back(
          {number_text(power.shown(shape.mean_kW.at(static_cast<DayType>(kind), hour))), "number"});
    }
    table.row(std::move(cells));
  }
  return table;
}

std::string shape_caption(const profile::LoadShape& shape, const display::Unit& power) {
  std::string caption =
      fmt::format("Mean of {} working days, {} Saturdays and {} Sundays and holidays.",
                  shape.days[0], shape.days[1], shape.days[2]);
  if (std::isfinite(shape.base_kW)) {
    caption += fmt::format(" Base load {}", amount_text(shape.base_kW, power));
    caption += std::isfinite(shape.base_share)
                   ? fmt::format(", {} of the energy.", percent_text(shape.base_share, 0))
                   : ".";
  }
  return caption;
}

bool has_hours(const MeterPart& meter) {
  return std::ranges::any_of(meter.shape.days, [](int days) { return days > 0; });
}

void write_days_section(Html& html, const MetersData& data) {
  if (std::ranges::none_of(data.meters, has_hours)) return;
  open_section(html, "days", "What does a usual day look like?");
  html.markup("<p class=\"key\" aria-hidden=\"true\">")
      .markup(kKindsKey)
      .markup("<span><i class=\"sign base\"></i>base load</span></p>\n")
      .markup("<div class=\"multiples wide\">\n");
  for (std::size_t i = 0; i < data.meters.size(); ++i) {
    const MeterPart& meter = data.meters[i];
    if (!has_hours(meter)) continue;
    const std::string& label = data.common.outputs[i].label;
    write_figure(html,
                 {.kind = "dayprofile",
                  .index = static_cast<int>(i),
                  .title = label + " by hour of the day",
                  .description = "Mean load of " + label + " by hour and kind of day.",
                  .caption = shape_caption(meter.shape, data.common.outputs[i].units.power),
                  .size = "small"},
                 shape_table(data.common.outputs[i], meter.shape));
  }
  html.markup("</div>\n</section>\n");
}

void write_peaks_section(Html& html, const MetersData& data) {
  if (data.common.peaks.empty()) return;
  open_section(html, "peaks", "How high were the peaks?");
  write_peak_figures(html, data.common);
  html.markup("</section>\n");
}

// ---------------------------------------------------------------- what the script draws

json shape_json(const MeterPart& meter, const display::Unit& power) {
  json kinds = json::array();
  for (std::size_t kind = 0; kind < model::kDayTypes; ++kind) {
    HourlyProfile load{};
    for (std::size_t hour = 0; hour < load.size(); ++hour) {
      load[hour] =
          power.shown(meter.shape.mean_kW.at(static_cast<DayType>(kind), static_cast<int>(hour)));
    }
    kinds.push_back({{"label", kKinds[kind]}, {"load", json_numbers(load, 4)}});
  }
  return {{"unit", power.name},
          {"kinds", kinds},
          {"base", json_number(power.shown(meter.shape.base_kW), 4)}};
}

json temperature_json(const MeterPart& meter, const display::MeterUnits& units,
                      const display::Unit& outdoor) {
  json days = json::array();
  json lines = json::array();
  if (meter.temperature) {
    for (const TemperatureDay& day : meter.temperature->days) {
      days.push_back({{"date", day_key(day.date)},
                      {"kind", static_cast<int>(day.kind)},
                      {"outdoor", json_number(outdoor.shown(day.dry_bulb_C), 4)},
                      {"energy", json_number(units.energy.shown(day.energy_kWh), 4)},
                      {"unseen", day.unseen}});
    }
    for (const TemperatureLine& line : meter.temperature->lines) {
      json points = json::array();
      for (const auto& [dry_bulb_C, energy_kWh] : line.points) {
        points.push_back(
            json_numbers(std::array{outdoor.shown(dry_bulb_C), units.energy.shown(energy_kWh)}));
      }
      lines.push_back({{"kind", static_cast<int>(line.kind)}, {"points", points}});
    }
  }
  return {{"days", days},
          {"lines", lines},
          {"energyUnit", units.energy.name},
          {"dailyUnit", units.daily.name},
          {"outdoorUnit", outdoor.name}};
}

}  // namespace

std::string meters_figure_json(const MetersData& data) {
  json root = report_json(data.common);
  root["overview"] = overview_json(forecast_overview(data));
  root["roleNames"] = {
      {"calibration", "Fitted"}, {"validation", "Not seen"}, {"unused", "Not used"}};
  root["shapes"] = json::array();
  root["temperatures"] = json::array();
  for (std::size_t i = 0; i < data.meters.size(); ++i) {
    const display::MeterUnits& units = data.common.outputs[i].units;
    root["shapes"].push_back(shape_json(data.meters[i], units.power));
    root["temperatures"].push_back(
        temperature_json(data.meters[i], units, display::unit_of(data.common.units, "degC")));
  }
  return script_safe_text(root);
}

std::string render_meters(const MetersData& data) {
  std::vector<PagePart> parts;
  const auto add = [&](std::string_view id, std::string_view link_text,
                       void (*write)(Html&, const MetersData&)) {
    Html html;
    write(html, data);
    parts.push_back({id, link_text, html.str()});
  };
  const auto common = [&](std::string_view id, std::string_view link_text,
                          void (*write)(Html&, const ReportData&)) {
    Html html;
    write(html, data.common);
    parts.push_back({id, link_text, html.str()});
  };
  add("meters", "In short", write_short_section);
  add("level-changes", "Changes", write_changes_section);
  add("months", "Months", write_months_section);
  common("costs", "Cost", write_cost_section);
  add("temperature", "Weather", write_temperature_section);
  add("days", "Days", write_days_section);
  add("peaks", "Peaks", write_peaks_section);
  common("load", "Load", write_load_section);
  common("data", "Data", write_data_section);
  common("provenance", "Provenance", write_provenance_section);
  const ReportData& head = data.common;
  return render_page({head.title, head.site, head.generated_at}, parts, meters_figure_json(data));
}

}  // namespace recald::views
