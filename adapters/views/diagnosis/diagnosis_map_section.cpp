#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/format.hpp"

namespace recald::views {
namespace {

constexpr int kPartsOfWeek = 42;
constexpr int kPartsOfDay = 6;

Cell share_cell(double share) { return {signed_percent_text(share), "number"}; }

std::string use_words(diagnosis::Role use) {
  switch (use) {
    case diagnosis::Role::fit:
    case diagnosis::Role::buffer:
      break;
    case diagnosis::Role::select:
      return "to choose";
    case diagnosis::Role::show:
      return "kept back";
  }
  return "fitted";
}

/// One row per part of the week, Monday first as in the figure.
void add_month_rows(Table& table, const char* label, const Eigen::ArrayXXd& cells) {
  table.group(label);
  for (int i = 0; i < kPartsOfWeek; ++i) {
    const int part = (i + kPartsOfDay) % kPartsOfWeek;
    std::vector<Cell> row{{part_of_week_text(part)}};
    for (Eigen::Index month = 0; month < cells.cols(); ++month) {
      row.push_back(share_cell(cells(part, month)));
    }
    table.row(std::move(row));
  }
}

Table month_table(const DiagnosisData& data, const MeterMaps& maps) {
  Table table(maps.meter + ": measured minus modelled by part of the week and month");
  std::vector<std::string> columns{"Part of the week"};
  for (std::size_t i = 0; i < data.months.size(); ++i) {
    columns.push_back(fmt::format("{}, {}", month_text(data.months[i]), use_words(data.uses[i])));
  }
  table.columns(std::move(columns));
  add_month_rows(table, "Before", maps.before.by_month);
  if (maps.after) add_month_rows(table, "After", maps.after->by_month);
  return table;
}

void add_temperature_rows(Table& table, const char* label, const Eigen::ArrayXXd& cells) {
  table.group(label);
  for (int part = 0; part < kPartsOfDay; ++part) {
    std::vector<Cell> row{{part_of_day_text(part)}};
    for (Eigen::Index bin = 0; bin < cells.cols(); ++bin)
      row.push_back(share_cell(cells(part, bin)));
    table.row(std::move(row));
  }
}

Table temperature_table(const DiagnosisData& data, const MeterMaps& maps) {
  Table table(maps.meter + ": measured minus modelled by outdoor temperature and part of the day");
  std::vector<std::string> columns{"Part of the day"};
  for (std::size_t i = 0; i + 1 < data.temperature_limits.size(); ++i) {
    columns.push_back(fmt::format("{} to {} {}", count_text(data.temperature_limits[i]),
                                  count_text(data.temperature_limits[i + 1]),
                                  data.temperature_unit));
  }
  table.columns(std::move(columns));
  add_temperature_rows(table, "Before", maps.before.by_temperature);
  if (maps.after) add_temperature_rows(table, "After", maps.after->by_temperature);
  return table;
}

std::string map_caption(const MeterMaps& maps) {
  return fmt::format(
      "Orange: the meter reads more than the model; blue: less. Colours are full at {} of the "
      "meter's mean of {}{}. Hatched: no reading there.",
      percent_text(colour_scale(maps), 0), maps.mean_load,
      maps.after ? ", on the left and on the right" : "");
}

void write_meter(Html& html, const DiagnosisData& data, const MeterMaps& maps, int index) {
  html.element("h3", maps.meter);
  const char* when = maps.after ? ", before and after" : "";
  write_figure(html,
               {.kind = "weekmap",
                .index = index,
                .title = fmt::format("{} by part of the week and month{}", maps.meter, when),
                .description = "Heat map of measured minus modelled power of " + maps.meter +
                               " by part of the week and month. " + map_caption(maps),
                .caption = map_caption(maps),
                .size = "map"},
               month_table(data, maps));
  if (data.temperature_limits.size() < 2) return;
  write_figure(
      html,
      {.kind = "temperaturemap",
       .index = index,
       .title = fmt::format("{} by outdoor temperature and part of the day{}", maps.meter, when),
       .description = "Heat map of measured minus modelled power of " + maps.meter +
                      " by outdoor temperature and part of the day. " + map_caption(maps),
       .caption = map_caption(maps),
       .size = "small pair"},
      temperature_table(data, maps));
}

constexpr std::string_view kMapKey =
    "<p class=\"key\" aria-hidden=\"true\">"
    "<span><i class=\"sign kept\"></i>month kept back until the end</span>"
    "<span><i class=\"sign choose\"></i>month used to choose between explanations</span>"
    "<span><i class=\"sign missing\"></i>no reading there</span></p>\n";

}  // namespace

void write_map_section(Html& html, const DiagnosisData& data) {
  if (data.maps.empty()) return;
  assert(data.uses.size() == data.months.size());
  open_section(html, "maps", "What does the gap look like?");
  html.element("p",
               "Each cell is a mean of four-hour parts. An effect that the model lacks leaves a "
               "pattern: nights, weekends, warm days, all days since a date. Where the model has "
               "all that matters the map looks like noise.");
  const bool kept = std::ranges::find(data.uses, diagnosis::Role::show) != data.uses.end();
  html.element("p", kept
                        ? "Neither the fit nor the choice between explanations has seen the months "
                          "kept back: if the pattern is gone there too, the addition is real."
                        : "No month was kept back: the record is too short for it.");
  html.markup(kMapKey);
  for (std::size_t i = 0; i < data.maps.size(); ++i) {
    write_meter(html, data, data.maps[i], static_cast<int>(i));
  }
  html.markup("</section>\n");
}

}  // namespace recald::views
