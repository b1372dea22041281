#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/sections.hpp"
#include "core/display/unit.hpp"

namespace recald::views {
namespace {

Table peak_table(const ReportData& data, const PeakSeries& series) {
  const display::Unit& unit = series.units.power;
  Table table(series.meter + ": monthly peak, measured");
  table.columns({"Month", "Peak, " + unit.name, "Began (local time)", "Measured share", "Remark"});
  for (const metering::MonthlyFigure& figure : series.months) {
    const auto& peak = figure.peak;
    table.row({{month_text(figure.month)},
               {number_text(peak ? unit.shown(peak->kW) : NAN), "number"},
               {peak ? local_text(peak->start, data.calendar) : "", "nowrap"},
               {percent_text(figure.coverage), "number"},
               {peak && peak->could_be_exceeded ? "△ the true peak may be higher" : ""}});
  }
  return table;
}

std::string window_words(std::chrono::seconds window) {
  return window.count() % 3600 == 0
             ? fmt::format("highest {}-hour mean, fixed blocks", window.count() / 3600)
             : fmt::format("highest {}-minute mean, fixed blocks", window.count() / 60);
}

std::string peak_caption(const PeakSeries& series) {
  const bool any = std::ranges::any_of(
      series.months, [](const metering::MonthlyFigure& figure) { return figure.peak.has_value(); });
  return fmt::format(
      "{}Peak: {}. An estimated interval is never a peak.",
      any ? "" : "Nothing was measured in these months. ",
      series.months.empty() ? "as measured" : window_words(series.months.back().peak_window));
}

std::string hour_range(std::size_t hour) { return fmt::format("{:02}–{:02} h", hour, hour + 1); }

Table profile_table(const DayTypeProfile& day_type) {
  Table table(day_type.label + ": mean power by hour, kW");
  std::vector<std::string> columns{"Hour"};
  for (const ProfilePart& part : day_type.parts) columns.push_back(part.label);
  columns.insert(columns.end(), {"Sum of parts", "Measured"});
  table.columns(columns);
  for (std::size_t hour = 0; hour < 24; ++hour) {
    std::vector<Cell> cells{{hour_range(hour)}};
    double sum = 0.0;
    for (const ProfilePart& part : day_type.parts) {
      cells.push_back({number_text(part.mean_kW[hour]), "number"});
      sum += part.mean_kW[hour];
    }
    cells.push_back({number_text(sum), "number"});
    cells.push_back({number_text(day_type.measured_mean_kW[hour]), "number"});
    table.row(std::move(cells));
  }
  return table;
}

/// Summary of one day of a load grid.
struct DaySummary {
  std::array<int, 4> hours_by_status{};  ///< Indexed by HourStatus.
  double sum_kW = 0.0;
  double highest_kW = NAN;
  int hours = 0;  ///< With a value that is neither missing nor suspect.
};

DaySummary summarise_day(const LoadGrid& load, std::size_t day) {
  DaySummary summary;
  for (std::size_t i = 24 * day; i < 24 * (day + 1); ++i) {
    ++summary.hours_by_status[static_cast<std::size_t>(load.status[i])];
    const bool shown =
        load.status[i] == HourStatus::ok || load.status[i] == HourStatus::partly_filled;
    if (!shown || !std::isfinite(load.mean_kW[i])) continue;
    summary.sum_kW += static_cast<double>(load.mean_kW[i]);
    summary.highest_kW = std::fmax(summary.highest_kW, static_cast<double>(load.mean_kW[i]));
    ++summary.hours;
  }
  return summary;
}

/// One row per day: hours would make a table of tens of thousands of cells, which no one reads and
/// every browser struggles with. The hours are in the CSV file that the page's script offers.
Table load_table(const LoadGrid& load) {
  const display::Unit& unit = load.units.power;
  Table table(load.meter + ": measured load by day");
  table.columns({"Day", "Mean, " + unit.name, "Highest hour, " + unit.name, "Hours measured",
                 "Partly estimated", "Missing", "Suspect"});
  const std::chrono::sys_days first{load.first_day};
  for (std::size_t day = 0; day < load.mean_kW.size() / 24; ++day) {
    const DaySummary summary = summarise_day(load, day);
    const auto hours = [&summary](HourStatus status) {
      return std::to_string(summary.hours_by_status[static_cast<std::size_t>(status)]);
    };
    table.row({{day_key(metering::Day{first + std::chrono::days{day}})},
               {number_text(summary.hours > 0 ? unit.shown(summary.sum_kW / summary.hours) : NAN),
                "number"},
               {number_text(unit.shown(summary.highest_kW)), "number"},
               {hours(HourStatus::ok), "number"},
               {hours(HourStatus::partly_filled), "number"},
               {hours(HourStatus::missing), "number"},
               {hours(HourStatus::suspect), "number"}});
  }
  return table;
}

std::string load_caption(const LoadGrid& load) {
  const auto count = [&load](HourStatus status) {
    return std::count(load.status.begin(), load.status.end(), status);
  };
  const auto hours = static_cast<double>(std::max<std::size_t>(load.status.size(), 1));
  return fmt::format(
      "One column a day, midnight at the top. {} of the hours are missing, {} suspect and {} "
      "partly "
      "estimated; missing and suspect hours carry no colour.",
      percent_text(static_cast<double>(count(HourStatus::missing)) / hours),
      percent_text(static_cast<double>(count(HourStatus::suspect)) / hours),
      percent_text(static_cast<double>(count(HourStatus::partly_filled)) / hours));
}

void write_load_figure(Html& html, const LoadGrid& load, int index) {
  assert(load.mean_kW.size() % 24 == 0 && load.status.size() == load.mean_kW.size());
  html.markup(fmt::format("<div class=\"choice\" data-choice=\"{}\">\n", index));
  write_figure(html,
               {.kind = "load",
                .index = index,
                .title = load.meter + ", hour by hour",
                .description = "Calendar heat map of the measured load of " + load.meter + ". " +
                               load_caption(load),
                .caption = load_caption(load),
                .size = "tall"},
               load_table(load));
  html.markup("</div>\n");
}

/// Without the script every meter is shown; with it, only the chosen one.
void write_meter_choice(Html& html, const std::vector<LoadGrid>& loads) {
  if (loads.size() < 2) return;
  html.markup("<p class=\"needs-script\"><label>Meter <select id=\"load-choice\">\n");
  for (std::size_t i = 0; i < loads.size(); ++i) {
    html.markup(fmt::format("<option value=\"{}\">", i)).text(loads[i].meter).markup("</option>\n");
  }
  html.markup("</select></label></p>\n");
}

constexpr std::string_view kPeakKey =
    "<p class=\"key\" aria-hidden=\"true\">"
    "<span><i class=\"sign dot\">●</i>measured peak</span>"
    "<span><i class=\"sign hollow\">△</i>measured, but intervals are missing: may be "
    "higher</span></p>\n";

constexpr std::string_view kLoadKey =
    "<p class=\"key\" aria-hidden=\"true\">"
    "<span><i class=\"sign missing\"></i>missing</span>"
    "<span><i class=\"sign suspect\"></i>suspect, kept out</span>"
    "<span><i class=\"sign partly\"></i>partly estimated</span></p>\n";

}  // namespace

void write_peak_figures(Html& html, const ReportData& data) {
  html.markup(kPeakKey).markup("<div class=\"multiples wide\">\n");
  for (std::size_t i = 0; i < data.peaks.size(); ++i) {
    const PeakSeries& series = data.peaks[i];
    write_figure(html,
                 {.kind = "peaks",
                  .index = static_cast<int>(i),
                  .title = series.meter + ", monthly peak",
                  .description = "Measured monthly peak of " + series.meter + " in " +
                                 series.units.power.name + ".",
                  .caption = peak_caption(series),
                  .size = "small"},
                 peak_table(data, series));
  }
  html.markup("</div>\n");
}

void write_peak_section(Html& html, const ReportData& data) {
  if (data.peaks.empty()) return;
  open_section(html, "peaks", "How high were the peaks?");
  if (!has_model(data)) {
    html.element("p", "There is no calibrated model yet: the figures show measurements only.");
  } else if (std::ranges::any_of(data.outputs, &OutputResult::is_peak)) {
    html.element("p",
                 "The figures show measurements. What the model makes of them stands under Fit.");
  } else {
    html.element("p", "The figures show measurements only: peaks were not calibrated.");
  }
  write_peak_figures(html, data);
  html.markup("</section>\n");
}

void write_profile_section(Html& html, const ReportData& data) {
  if (data.profile.day_types.empty()) return;
  open_section(html, "profile", "What runs when?");
  html.element(
      "p",
      "The electricity meter was split into parts by day type and hour. These schedules are "
      "inputs of the model: they were fixed before the calibration and are not part of it.");
  if (!data.profile.check_sentence.empty()) html.element("p", data.profile.check_sentence);
  html.markup("<p class=\"key\" id=\"profile-key\" aria-hidden=\"true\"></p>\n")
      .markup("<div class=\"multiples\">\n");
  for (std::size_t i = 0; i < data.profile.day_types.size(); ++i) {
    const DayTypeProfile& day_type = data.profile.day_types[i];
    write_figure(html,
                 {.kind = "profile",
                  .index = static_cast<int>(i),
                  .title = day_type.label,
                  .description = "Electric power by hour of the day, " + day_type.label +
                                 ": stacked parts and the measured mean.",
                  .caption = "Mean power in each hour of the local day.",
                  .size = "small"},
                 profile_table(day_type));
  }
  html.markup("</div>\n</section>\n");
}

void write_load_section(Html& html, const ReportData& data) {
  if (data.loads.empty()) return;
  open_section(html, "load", "What did the meters see?");
  write_meter_choice(html, data.loads);
  html.markup(kLoadKey);
  for (std::size_t i = 0; i < data.loads.size(); ++i) {
    write_load_figure(html, data.loads[i], static_cast<int>(i));
  }
  html.markup("</section>\n");
}

}  // namespace recald::views
