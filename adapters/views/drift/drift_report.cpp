#include "adapters/views/drift/drift_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "adapters/system/files/write_file.hpp"
#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "adapters/views/drift/drift_words.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/provenance.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"
#include "core/drift/follow.hpp"

namespace recald::views {
namespace {

/// Causes beyond these are hardly worth a line.
constexpr std::size_t kCausesShown = 4;

metering::Month month_of(const drift::SiteDrift& drift, int month) {
  return metering::parse_month(drift.month_name(month)).value();
}

const drift::FollowedOutput& output_of(const drift::SiteDrift& drift, const drift::Alarm& alarm) {
  return drift.outputs[static_cast<std::size_t>(alarm.output)];
}

std::string label_of(const drift::FollowedOutput& output) {
  return display::capitalised(display::output_words(output.name));
}

std::string consequence_of(const drift::SiteDrift& drift, const drift::ExplainedAlarm& alarm) {
  const std::string since = month_text(month_of(drift, alarm.alarm.since));
  switch (alarm.consequence) {
    case drift::Consequence::began_anew:
      return fmt::format("The model has been learned again from the months since {}.", since);
    case drift::Consequence::meter_set_aside:
      return fmt::format(
          "The meter is excluded: the model does not learn from its figures since {}.", since);
    case drift::Consequence::none:
      break;
  }
  return "";
}

AlarmCard card_of(const drift::SiteDrift& drift, const drift::ExplainedAlarm& explained) {
  const drift::Alarm& alarm = explained.alarm;
  AlarmCard card{
      .title = fmt::format("{} is {} than forecast since {}", label_of(output_of(drift, alarm)),
                           alarm.direction > 0 ? "more" : "less",
                           month_text(month_of(drift, alarm.since))),
      .sentence = alarm_sentence(drift, alarm),
      .cost = alarm_cost_words(drift, explained),
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

ForecastSeries series_of(const drift::SiteDrift& drift, std::size_t k) {
  const drift::FollowedOutput& output = drift.outputs[k];
  const display::Unit unit = display::unit_of(drift.units, output.unit, output.utility);
  ForecastSeries series{.label = label_of(output),
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
    ForecastMonth& shown = series.months[static_cast<std::size_t>(month.month)];
    shown.q05 = unit.shown(record->q05);
    shown.q50 = unit.shown(record->q50);
    shown.q95 = unit.shown(record->q95);
  }
  for (const drift::ExplainedAlarm& explained : drift.alarms) {
    if (explained.alarm.output != static_cast<int>(k)) continue;
    series.alarms.push_back(
        {month_of(drift, explained.alarm.since_earliest), month_of(drift, explained.alarm.month)});
  }
  return series;
}

BelievedParameter believed_of(const drift::SiteDrift& drift, std::size_t j) {
  const drift::ParameterPath& all = drift.windows.front().paths[j];
  const auto last_year =
      std::ranges::find(drift.windows, drift::kLastYearWindow, &drift::FollowedWindow::name);
  const display::Unit unit = display::unit_of(drift.units, drift.parameters[j].unit);
  BelievedParameter shown{
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

std::vector<HistoryRow> history_of(const drift::SiteDrift& drift, const RunFacts& facts) {
  std::vector<HistoryRow> rows{
      {month_of(drift, 0),
       fmt::format("Model {}, learned from its first {} months and updated every month since",
                   facts.model_version, drift.learning_months)}};
  for (const drift::ExplainedAlarm& explained : drift.alarms) {
    const std::string what = consequence_of(drift, explained);
    if (what.empty()) continue;
    rows.push_back({month_of(drift, explained.alarm.since), what});
  }
  std::ranges::stable_sort(rows, {}, &HistoryRow::since);
  return rows;
}

std::string headline_of(const drift::SiteDrift& drift) {
  const std::size_t count = drift.alarms.size();
  const std::string months = fmt::format("{} months forecast", drift.record.size());
  if (count == 0) return months + ", none of them surprising enough for an alarm.";
  return fmt::format("{}, {} alarm{}.", months, count, count == 1 ? "" : "s");
}

}  // namespace

DriftData drift_report_of(const SiteLine& site, const drift::SiteDrift& drift,
                          const RunFacts& facts, std::string generated_at) {
  DriftData data{.title = "What has changed at " + site.name,
                 .site = site,
                 .generated_at = std::move(generated_at),
                 .headline = headline_of(drift),
                 .alarms = {},
                 .meter_changes = {},
                 .notices = {},
                 .outputs = {},
                 .parameters = {},
                 .windows = {},
                 .history = history_of(drift, facts),
                 .provenance = provenance_of(facts)};
  data.provenance.seed = facts.seed;
  for (const drift::ExplainedAlarm& alarm : drift.alarms)
    data.alarms.push_back(card_of(drift, alarm));
  for (const drift::MeterChange& change : drift.meter_changes) {
    data.meter_changes.push_back(meter_change_words(change));
  }
  for (const display::Warning& warning : drift.warnings) {
    data.notices.push_back(notice_of(Severity::info, warning));
  }
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    data.outputs.push_back(series_of(drift, k));
  }
  for (std::size_t j = 0; j < drift.parameters.size(); ++j) {
    data.parameters.push_back(believed_of(drift, j));
  }
  for (const drift::FollowedWindow& window : drift.windows) {
    const auto anew = std::ranges::count_if(window.taken, &drift::MonthTaken::anew);
    data.windows.push_back({window.name, window.log_score, static_cast<int>(anew)});
  }
  return data;
}

Result<void> write_drift(const SiteLine& site, const drift::SiteDrift& drift, const RunFacts& facts,
                         std::string generated_at, const std::string& json,
                         const std::filesystem::path& folder) {
  if (auto made = system::make_folder(folder); !made) return made;
  if (auto written = system::write_file(folder / "drift.json", json); !written) return written;
  return system::write_file(
      folder / "drift.html",
      render_drift(drift_report_of(site, drift, facts, std::move(generated_at))));
}

}  // namespace recald::views
