#include "daemon/site/results/drift_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "adapters/report/format.hpp"
#include "adapters/system/write_file.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"
#include "daemon/site/results/diagnosis_words.hpp"
#include "daemon/site/results/drift_words.hpp"

namespace recald::daemon {
namespace {

/// Causes beyond these are hardly worth a line.
constexpr std::size_t kCausesShown = 4;

metering::Month month_of(const SiteDrift& drift, int month) {
  return metering::parse_month(drift.month_name(month)).value();
}

const FollowedOutput& output_of(const SiteDrift& drift, const drift::Alarm& alarm) {
  return drift.outputs[static_cast<std::size_t>(alarm.output)];
}

std::string label_of(const FollowedOutput& output) {
  return display::capitalised(display::output_words(output.name));
}

std::string consequence_of(const SiteDrift& drift, const ExplainedAlarm& alarm) {
  const std::string since = report::month_text(month_of(drift, alarm.alarm.since));
  switch (alarm.consequence) {
    case ExplainedAlarm::Consequence::began_anew:
      return fmt::format("The model has been learned again from the months since {}.", since);
    case ExplainedAlarm::Consequence::meter_set_aside:
      return fmt::format(
          "The meter is excluded: the model does not learn from its figures since {}.", since);
    case ExplainedAlarm::Consequence::none:
      break;
  }
  return "";
}

report::AlarmCard card_of(const SiteDrift& drift, const ExplainedAlarm& explained) {
  const drift::Alarm& alarm = explained.alarm;
  report::AlarmCard card{
      .title = fmt::format("{} is {} than forecast since {}", label_of(output_of(drift, alarm)),
                           alarm.direction > 0 ? "more" : "less",
                           report::month_text(month_of(drift, alarm.since))),
      .sentence = alarm_sentence(drift, alarm),
      .cost = alarm_cost_words(drift, alarm),
      .causes = {},
      .consequence = consequence_of(drift, explained),
      .advice = explained.causes.empty() ? "The record before the change is too short to say why."
                                         : advice_words(drift, explained)};
  for (const drift::Cause& cause : explained.causes) {
    if (card.causes.size() == kCausesShown) break;
    card.causes.push_back({cause_words(drift, cause), cause.probability});
  }
  return card;
}

report::ForecastSeries series_of(const SiteDrift& drift, std::size_t k) {
  const FollowedOutput& output = drift.outputs[k];
  const display::Unit unit = display::unit_of(drift.units, output.unit, output.utility);
  report::ForecastSeries series{.label = label_of(output),
                                .unit = unit.name,
                                .trust = trust_words(drift, k),
                                .months = {},
                                .alarms = {}};
  for (std::size_t i = 0; i < drift.months.size(); ++i) {
    const double measured = output.measured[i];
    series.months.push_back(
        {.month = month_of(drift, static_cast<int>(i)),
         .q05 = {},
         .q50 = {},
         .q95 = {},
         .measured = std::isnan(measured) ? std::nullopt : std::optional{unit.shown(measured)}});
  }
  for (const drift::PrequentialMonth& month : drift.record) {
    const auto& record = month.outputs[k];
    if (!record) continue;
    report::ForecastMonth& shown = series.months[static_cast<std::size_t>(month.month)];
    shown.q05 = unit.shown(record->q05);
    shown.q50 = unit.shown(record->q50);
    shown.q95 = unit.shown(record->q95);
  }
  for (const ExplainedAlarm& explained : drift.alarms) {
    if (explained.alarm.output != static_cast<int>(k)) continue;
    series.alarms.push_back(
        {month_of(drift, explained.alarm.since_earliest), month_of(drift, explained.alarm.month)});
  }
  return series;
}

report::BelievedParameter believed_of(const SiteDrift& drift, std::size_t j) {
  const ParameterPath& all = drift.windows.front().paths[j];
  const auto last_year = std::ranges::find(drift.windows, kLastYearWindow, &FollowedWindow::name);
  const display::Unit unit = display::unit_of(drift.units, drift.parameters[j].unit);
  report::BelievedParameter shown{
      .label = display::capitalised(display::parameter_words(drift.parameters[j].name)),
      .unit = unit.name,
      .months = {},
      .last_year_mean = last_year->paths[j].mean};
  for (double& mean : shown.last_year_mean) mean = unit.shown(mean);
  for (std::size_t i = 0; i < all.mean.size(); ++i) {
    shown.months.push_back(
        {.month = month_of(drift, drift.learning_months - 1 + static_cast<int>(i)),
         .mean = unit.shown(all.mean[i]),
         .q05 = unit.shown(all.q05[i]),
         .q95 = unit.shown(all.q95[i])});
  }
  return shown;
}

std::vector<report::HistoryRow> history_of(const SiteDrift& drift, const RunFacts& facts) {
  std::vector<report::HistoryRow> rows{
      {month_of(drift, 0),
       fmt::format("Model {}, learned from its first {} months and updated every month since",
                   facts.model_version, drift.learning_months)}};
  for (const ExplainedAlarm& explained : drift.alarms) {
    const std::string what = consequence_of(drift, explained);
    if (what.empty()) continue;
    rows.push_back({month_of(drift, explained.alarm.since), what});
  }
  std::ranges::stable_sort(rows, {}, &report::HistoryRow::since);
  return rows;
}

std::string headline_of(const SiteDrift& drift) {
  const std::size_t count = drift.alarms.size();
  const std::string months = fmt::format("{} months forecast", drift.record.size());
  if (count == 0) return months + ", none of them surprising enough for an alarm.";
  return fmt::format("{}, {} alarm{}.", months, count, count == 1 ? "" : "s");
}

}  // namespace

report::DriftData drift_report_of(const SiteConfig& config, const SiteDrift& drift,
                                  const RunFacts& facts, std::string generated_at) {
  report::DriftData data{.title = "What has changed at " + config.name,
                         .site = {config.id, config.name, config.timezone},
                         .generated_at = std::move(generated_at),
                         .headline = headline_of(drift),
                         .alarms = {},
                         .meter_changes = {},
                         .notices = {},
                         .outputs = {},
                         .parameters = {},
                         .windows = {},
                         .history = history_of(drift, facts),
                         .provenance = {.recald_version = facts.recald_version,
                                        .data_revision = facts.data_revision,
                                        .model_version = facts.model_version,
                                        .time_zone_data = facts.time_zone_data,
                                        .weather_values = facts.weather_values,
                                        .seed = facts.seed}};
  for (const ExplainedAlarm& alarm : drift.alarms) data.alarms.push_back(card_of(drift, alarm));
  for (const MeterChange& change : drift.meter_changes) {
    data.meter_changes.push_back(meter_change_words(change));
  }
  for (const display::Warning& warning : drift.warnings) {
    data.notices.push_back(notice_of(report::Severity::info, warning));
  }
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    data.outputs.push_back(series_of(drift, k));
  }
  for (std::size_t j = 0; j < drift.parameters.size(); ++j) {
    data.parameters.push_back(believed_of(drift, j));
  }
  for (const FollowedWindow& window : drift.windows) {
    const auto anew = std::ranges::count_if(window.taken, &drift::MonthTaken::anew);
    data.windows.push_back({window.name, window.log_score, static_cast<int>(anew)});
  }
  return data;
}

Result<void> write_drift(const SiteConfig& config, const SiteDrift& drift, const RunFacts& facts,
                         std::string generated_at, const std::string& json,
                         const std::filesystem::path& folder) {
  if (auto made = system::make_folder(folder); !made) return made;
  if (auto written = system::write_file(folder / "drift.json", json); !written) return written;
  return system::write_file(
      folder / "drift.html",
      report::render_drift(drift_report_of(config, drift, facts, std::move(generated_at))));
}

}  // namespace recald::daemon
