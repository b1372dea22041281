#include "adapters/views/drift/drift_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/views/drift/forecast_table.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/html.hpp"
#include "adapters/views/frame/page.hpp"
#include "adapters/views/frame/script_json.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

constexpr std::string_view kForecastKey =
    "<p class=\"key\" aria-hidden=\"true\">"
    "<span><i class=\"sign model\"></i>forecast</span>"
    "<span><i class=\"sign band\"></i>90 % band</span>"
    "<span><i class=\"sign\">★</i>measured</span>"
    "<span><i class=\"sign different\">◆</i>measured, outside the band</span>"
    "<span><i class=\"sign ground\"></i>alarm</span></p>\n";

constexpr std::string_view kBelievedKey =
    "<p class=\"key\" aria-hidden=\"true\">"
    "<span><i class=\"sign model\"></i>mean, from all months so far</span>"
    "<span><i class=\"sign band\"></i>90 % band</span>"
    "<span><i class=\"sign last-year\"></i>mean, from the last twelve months alone</span></p>\n";

void write_alarm(Html& html, const AlarmCard& card) {
  html.markup("<li class=\"warning\">")
      .element("span", "▲ Alarm", "badge")
      .element("strong", card.title)
      .element("p", card.sentence);
  if (!card.cost.empty()) html.element("p", card.cost);
  if (!card.causes.empty()) {
    Table table("What it may come from");
    table.columns({"Cause", "Probability"});
    for (const LikelyCause& cause : card.causes) {
      table.row({{cause.words}, {probability_text(cause.probability), "number"}});
    }
    table.write(html);
  }
  for (const std::string& more : {card.advice, card.consequence}) {
    if (!more.empty()) html.element("p", more);
  }
  html.markup("</li>\n");
}

void write_changes_section(Html& html, const DriftData& data) {
  open_section(html, "changes", "In short");
  html.markup(data.alarms.empty() ? "<p class=\"pass\">" : "<p class=\"warning\">")
      .element("span", data.alarms.empty() ? "✓ No alarm" : "▲ Something has changed", "badge")
      .markup("</p>\n");
  html.element("p", data.headline, "headline");
  if (!data.alarms.empty()) {
    html.markup("<ul class=\"verdicts\">\n");
    for (const AlarmCard& card : data.alarms) write_alarm(html, card);
    html.markup("</ul>\n");
  }
  for (const std::string& sentence : data.meter_changes) html.element("p", sentence, "lead");
  write_notices(html, data.notices);
  html.markup("</section>\n");
}

void write_forecast_section(Html& html, const DriftData& data) {
  if (data.outputs.empty()) return;
  open_section(html, "forecasts", "What was forecast, and what came");
  html.element("p",
               "Each month was forecast from the months before it and its own weather, before its "
               "figures were looked at. What was said then is not changed by what came later.");
  html.markup(kForecastKey);
  for (std::size_t i = 0; i < data.outputs.size(); ++i) {
    const ForecastSeries& series = data.outputs[i];
    write_figure(html,
                 {.kind = "forecast",
                  .index = static_cast<int>(i),
                  .title = series.label,
                  .description = fmt::format(
                      "Forecasts of {} with their 90 % band, {} months, and the measured figures.",
                      series.label, series.months.size()),
                  .caption = series.trust +
                             " Band: nine of ten months should lie inside. Shaded: from the "
                             "earliest month that an alarm may date from until it was raised."},
                 forecast_table(series, "forecast"));
  }
  html.markup("</section>\n");
}

/// "Outdoor airflow rate, m³/s"
std::string titled(const BelievedParameter& parameter) {
  return parameter.unit.empty() ? parameter.label
                                : fmt::format("{}, {}", parameter.label, parameter.unit);
}

Table believed_table(const BelievedParameter& parameter) {
  Table table(titled(parameter));
  table.columns({"After", "5 %", "Mean", "95 %", "Mean of the last twelve months alone"});
  for (std::size_t i = 0; i < parameter.months.size(); ++i) {
    const BelievedMonth& month = parameter.months[i];
    table.row({{month_text(month.month)},
               {number_text(month.q05), "number"},
               {number_text(month.mean), "number"},
               {number_text(month.q95), "number"},
               {number_text(parameter.last_year_mean[i]), "number"}});
  }
  return table;
}

void write_believed_section(Html& html, const DriftData& data) {
  if (data.parameters.empty()) return;
  open_section(html, "believed", "What is believed of the building");
  html.markup(kBelievedKey).markup("<div class=\"multiples\">\n");
  for (std::size_t i = 0; i < data.parameters.size(); ++i) {
    const BelievedParameter& parameter = data.parameters[i];
    write_figure(html,
                 {.kind = "believed",
                  .index = static_cast<int>(i),
                  .title = titled(parameter),
                  .description = fmt::format("Posterior mean and 90 % band of {} after each month.",
                                             parameter.label),
                  .caption = "Line and band: all months so far. Dashed: the last twelve alone.",
                  .size = "small"},
                 believed_table(parameter));
  }
  html.markup("</div>\n");
  Table table("Which past serves best? Log score of all forecasts, larger is better");
  table.columns({"Window", "Log score", "Times sampled from the prior"});
  for (const WindowRow& row : data.windows) {
    table.row({{row.name},
               {number_text(row.log_score), "number"},
               {std::to_string(row.sampled_anew), "number"}});
  }
  table.write(html);
  html.markup("</section>\n");
}

void write_history_section(Html& html, const DriftData& data) {
  if (data.history.empty()) return;
  open_section(html, "history", "What was believed since when");
  Table table("Each row holds until the next");
  table.columns({"Since", "What"});
  for (const HistoryRow& row : data.history) {
    table.row({{month_text(row.since)}, {row.what}});
  }
  table.write(html);
  html.markup("</section>\n");
}

nlohmann::json optional_number(std::optional<double> value) {
  return value ? json_number(*value) : nlohmann::json(nullptr);
}

nlohmann::json forecast_json(const ForecastSeries& series) {
  nlohmann::json months = nlohmann::json::array();
  for (const ForecastMonth& month : series.months) {
    months.push_back({{"month", month_key(month.month)},
                      {"q05", optional_number(month.q05)},
                      {"q50", optional_number(month.q50)},
                      {"q95", optional_number(month.q95)},
                      {"measured", optional_number(month.measured)}});
  }
  nlohmann::json alarms = nlohmann::json::array();
  for (const AlarmSpan& span : series.alarms) {
    alarms.push_back({{"first", month_key(span.first)}, {"last", month_key(span.last)}});
  }
  return {{"label", series.label}, {"unit", series.unit}, {"months", months}, {"alarms", alarms}};
}

nlohmann::json believed_json(const BelievedParameter& parameter) {
  nlohmann::json months = nlohmann::json::array();
  for (std::size_t i = 0; i < parameter.months.size(); ++i) {
    const BelievedMonth& month = parameter.months[i];
    months.push_back({{"month", month_key(month.month)},
                      {"q05", json_number(month.q05)},
                      {"q50", json_number(month.mean)},
                      {"q95", json_number(month.q95)},
                      {"lastYear", json_number(parameter.last_year_mean[i])}});
  }
  return {{"label", parameter.label}, {"unit", parameter.unit}, {"months", months}};
}

}  // namespace

std::string drift_figure_json(const DriftData& data) {
  nlohmann::json forecasts = nlohmann::json::array();
  for (const ForecastSeries& series : data.outputs) forecasts.push_back(forecast_json(series));
  nlohmann::json believed = nlohmann::json::array();
  for (const BelievedParameter& one : data.parameters) believed.push_back(believed_json(one));
  return script_safe_text({{"forecasts", forecasts}, {"believed", believed}});
}

std::string render_drift(const DriftData& data) {
  std::vector<PagePart> parts;
  const auto add = [&](std::string_view id, std::string_view link_text, auto write) {
    Html html;
    write(html, data);
    parts.push_back({id, link_text, html.str()});
  };
  add("changes", "In short", write_changes_section);
  add("forecasts", "Forecasts", write_forecast_section);
  add("believed", "Parameters", write_believed_section);
  add("history", "History", write_history_section);
  add("provenance", "Provenance", [](Html& html, const DriftData& drift) {
    write_provenance(html, drift.provenance, drift.site.time_zone, drift.generated_at);
  });
  return render_page({data.title, data.site, data.generated_at}, parts, drift_figure_json(data));
}

}  // namespace recald::views
