#include "adapters/views/frame/first_screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "adapters/views/frame/format.hpp"
#include "core/display/unit.hpp"

namespace recald::views {
namespace {

std::span<const OverviewMeter> shown_of(const std::vector<OverviewMeter>& meters) {
  return std::span{meters}.first(std::min(meters.size(), kOverviewMeters));
}

bool has_band(std::span<const OverviewMeter> meters) {
  return std::ranges::any_of(meters, [](const OverviewMeter& meter) {
    return std::ranges::any_of(meter.months,
                               [](const OverviewMonth& month) { return month.band.has_value(); });
  });
}

bool has_unseen(std::span<const OverviewMeter> meters) {
  return std::ranges::any_of(meters, [](const OverviewMeter& meter) {
    return std::ranges::any_of(meter.months, [](const OverviewMonth& month) {
      return month.role == assessment::MonthRole::validation;
    });
  });
}

Table overview_table(std::span<const OverviewMeter> meters, bool with_band) {
  Table table("Measured months and what was expected of them");
  std::vector<std::string> columns{"Month", "Measured"};
  if (with_band) columns.insert(columns.end(), {"Expected: 5 %", "Middle", "95 %"});
  table.columns(columns);
  for (const OverviewMeter& meter : meters) {
    table.group(with_unit(meter.label, meter.unit));
    for (const OverviewMonth& month : meter.months) {
      std::vector<Cell> cells{{month_text(month.month, month.number)},
                              {number_text(month.measured), "number"}};
      for (std::size_t i = 0; with_band && i < 3; ++i) {
        cells.push_back({month.band ? number_text((*month.band)[i]) : "–", "number"});
      }
      table.row(std::move(cells));
    }
  }
  return table;
}

void write_overview_key(Html& html, bool with_band, const Expected& expected) {
  html.markup("<p class=\"key\" aria-hidden=\"true\"><span><i class=\"sign\">★</i>measured</span>");
  if (with_band) {
    html.markup("<span><i class=\"sign different\">◆</i>measured, outside the band</span>")
        .markup("<span><i class=\"sign model\"></i><i class=\"sign band\"></i>")
        .text(expected.what)
        .markup("</span>");
  }
  html.markup("</p>\n");
}

}  // namespace

std::vector<OverviewMeter> model_overview(const ReportData& data) {
  std::vector<OverviewMeter> meters;
  for (const OutputResult& output : data.outputs) {
    const display::Unit& unit = output.unit();
    OverviewMeter meter{output.label, unit.name, {}};
    for (const OutputMonth& month : output.months) {
      if (month.role == assessment::MonthRole::unused && !month.box) continue;
      OverviewMonth& shown = meter.months.emplace_back(
          OverviewMonth{month.figure.month,
                        month.number,
                        month.role,
                        month.figure.usable ? unit.shown(measured_of(output, month)) : NAN,
                        {}});
      if (!month.box) continue;
      shown.band = {unit.shown(month.box->low_whisker), unit.shown(month.box->q50),
                    unit.shown(month.box->high_whisker)};
    }
    if (!meter.months.empty()) meters.push_back(std::move(meter));
  }
  return meters;
}

void write_first_words(Html& html, const FirstScreen& first) {
  if (!first.sentence.empty()) html.element("p", first.sentence, "headline");
  if (!first.more.empty()) html.element("p", first.more, "lead");
}

void write_key_numbers(Html& html, const FirstScreen& first) {
  if (first.numbers.empty()) return;
  html.markup("<ul class=\"numbers\">\n");
  for (const KeyNumber& key : first.numbers) {
    html.markup("<li>").element("strong", key.number).element("span", key.what).markup("</li>\n");
  }
  html.markup("</ul>\n");
}

void write_overview(Html& html, const std::vector<OverviewMeter>& meters,
                    const Expected& expected) {
  if (meters.empty()) return;
  const auto shown = shown_of(meters);
  const bool with_band = has_band(shown);
  write_overview_key(html, with_band, expected);
  std::string caption;
  if (with_band) caption = std::string{expected.reading} + " ";
  if (with_band && has_unseen(shown)) {
    caption += "On shaded ground: months that nothing was fitted to. ";
  }
  if (meters.size() > shown.size()) {
    caption += fmt::format("The other {} meters are below.", meters.size() - shown.size());
  }
  write_figure(
      html,
      {.kind = "overview",
       .title = with_band ? "Measured months against what was expected"
                          : "What the meters measured, month by month",
       .description = fmt::format(
           "Monthly daily averages of {} meter{}{}.", shown.size(), shown.size() == 1 ? "" : "s",
           with_band ? fmt::format(", against the band of the {}", expected.what) : ""),
       .caption = caption,
       .size = "overview"},
      overview_table(shown, with_band));
}

nlohmann::json overview_json(const std::vector<OverviewMeter>& meters) {
  using assessment::MonthRole;
  nlohmann::json panels = nlohmann::json::array();
  for (const OverviewMeter& meter : shown_of(meters)) {
    nlohmann::json months = nlohmann::json::array();
    for (const OverviewMonth& month : meter.months) {
      months.push_back(
          {{"month", month_key(month.month, month.number)},
           {"role", month.role == MonthRole::validation ? "validation" : "other"},
           {"measured", json_number(month.measured)},
           {"band", month.band ? json_numbers(*month.band) : nlohmann::json(nullptr)}});
    }
    panels.push_back({{"label", meter.label}, {"unit", meter.unit}, {"months", months}});
  }
  return panels;
}

}  // namespace recald::views
