#include "daemon/site/drift/site_drift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/calibration/posterior/problem.hpp"
#include "core/display/id_words.hpp"
#include "core/display/warning.hpp"
#include "core/metering/months/lost_readings.hpp"
#include "daemon/site/drift/hours_since.hpp"
#include "daemon/site/drift/watched_days.hpp"
#include "daemon/site/model/meter_rates.hpp"

namespace recald::daemon {
namespace {

using metering::Month;
using metering::MonthRange;

std::string lost_words(const std::string& meter, const metering::LostReadings& lost) {
  return fmt::format(
      "{} has given usable readings for {:.0f} % of the time since {}, {:.0f} % before{}; detected "
      "after {}",
      meter, 100.0 * lost.share_since, metering::to_string(lost.since), 100.0 * lost.share_before,
      lost.stands_still ? ": it is frozen at one value" : "", metering::to_string(lost.seen));
}

/// @param first  Month that the record begins with.
std::vector<MeterChange> meter_changes_of(const Recording& recording, const std::string& first,
                                          int learning_months) {
  std::vector<MeterChange> changes;
  for (const MeterRecord& record : recording.meters) {
    const std::string& id = record.meter.id;
    for (const metering::LevelChange& change : record.level_changes) {
      if (change.kind != metering::LevelChangeKind::scale) continue;
      const std::string since = metering::to_string(change.since);
      changes.push_back({drift::MeterChangeKind::unit, id, since, metering::to_string(change.seen),
                         change.factor,
                         // The words begin with the meter's id.
                         display::meter_label(id) + change.words.substr(id.size())});
    }
    const auto begin = std::ranges::find(record.figures, first, [](const auto& figure) {
      return metering::to_string(figure.month);
    });
    const auto lost = metering::find_lost_readings({begin, record.figures.end()},
                                                   static_cast<std::size_t>(learning_months));
    if (!lost) continue;
    changes.push_back({drift::MeterChangeKind::readings, id, metering::to_string(lost->since),
                       metering::to_string(lost->seen), lost->share_since / lost->share_before,
                       lost_words(display::meter_label(id), *lost)});
  }
  return changes;
}

/// Meters whose days are watched; none and a warning where they cannot be.
std::vector<drift::DailyWatches::Output> days_of_meters(const ModelledSite& modelled,
                                                        int learning_months,
                                                        SiteCalibration& site) {
  if (!facts_of(site.model).is_of_building) {
    site.warnings.push_back(
        display::warning_of("The daily watch is off: it needs a model of a [building]."));
    return {};
  }
  std::vector<FollowedMeter> meters;
  std::vector<int> outputs;
  for (std::size_t k = 0; k < site.outputs.size(); ++k) {
    const assessment::OutputCalibration& output = site.outputs[k];
    if (output.name != output.meter_id + "_daily_kWh") continue;
    meters.push_back({output.meter_id, output.measured});
    outputs.push_back(static_cast<int>(k));
  }
  auto days = watched_days(modelled, meters, site.month_names, learning_months);
  if (!days) {
    site.warnings.push_back(
        display::warning_of("The daily watch is off: " + days.error().message + "."));
    return {};
  }
  std::vector<drift::DailyWatches::Output> watched;
  for (std::size_t k = 0; k < meters.size(); ++k) {
    watched.push_back({outputs[k], std::move((*days)[k])});
  }
  return watched;
}

}  // namespace

Result<PeriodConfig> followed_period(const OpenSite& site, const Recording& recording,
                                     metering::Instant now, int learning_months) {
  std::optional<MonthRange> common;
  const auto is_followed = [&](const metering::MonthlyFigure& figure) {
    const auto end = site.calendar.month_span(figure.month).end;
    return figure.usable && end + site.config.closing.watermark <= now;
  };
  for (const std::string& id : site.config.model->outputs) {
    const MeterRecord& record = recording.meters[*site.config.meter_index(id)];
    for (const metering::MonthlyFigure& figure : record.figures) {
      if (!is_followed(figure)) continue;
      if (!common) common = MonthRange{figure.month, figure.month};
      common->last = std::max(common->last, figure.month);
    }
    const auto first = std::ranges::find_if(record.figures, is_followed);
    if (first == record.figures.end()) {
      return failure(ErrorCode::not_enough_data,
                     fmt::format("meter '{}' has no usable month yet", id));
    }
    common->first = std::max(common->first, first->month);
  }
  const auto needed = learning_months + 1;
  if (!common || common->first + std::chrono::months{needed - 1} > common->last) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("to follow a site, recald needs {} months of all modelled meters: "
                               "{} to learn from and one to forecast",
                               needed, learning_months));
  }
  const Month last_learnt = common->first + std::chrono::months{learning_months - 1};
  return PeriodConfig{MonthRange{common->first, last_learnt},
                      MonthRange{last_learnt + std::chrono::months{1}, common->last}};
}

Result<SiteDrift> follow_site(const ModelledSite& modelled, const DriftOptions& options,
                              const std::vector<diagnosis::AddedEffect>& added,
                              const calibration::RunContext& context) {
  auto prepared = TRY(prepare_site(modelled.site.config, modelled.site.calendar, modelled.recording,
                                   modelled.weather, added));
  auto design =
      TRY(calibration::run_design(*prepared.model, prepared.problem, options.design_runs, context));
  assessment::set_aside_unresponsive(design, prepared.so_far, prepared.problem);
  // Outputs that no parameter moves are followed by their own level, even if all are such.
  const bool is_calibrated =
      std::ranges::any_of(prepared.so_far.outputs, &assessment::OutputCalibration::calibrated);
  if (auto ok = check_problem(prepared.problem, *prepared.model); is_calibrated && !ok) {
    return tl::unexpected(ok.error());
  }
  const int learning_months = prepared.model->month_count();
  SiteCalibration& so_far = prepared.so_far;
  drift::SeenBeside beside{.meter_changes = meter_changes_of(
                               modelled.recording, so_far.month_names.front(), learning_months),
                           .directions = {},
                           .days = days_of_meters(modelled, learning_months, so_far)};
  if (facts_of(so_far.model).is_of_building) {
    std::vector<std::string> meters;
    for (const assessment::OutputCalibration& output : so_far.outputs) {
      meters.push_back(output.meter_id);
    }
    beside.ask_hours = ask_hours_of(modelled, so_far.month_names, std::move(meters), added);
  }
  if (!prepared.electricity_use.empty()) {
    beside.directions.push_back({.name = "electricity use", .change = prepared.electricity_use});
  }
  auto drift = drift::follow({so_far,
                              *prepared.whole_model,
                              learning_months,
                              {prepared.inputs.names, prepared.inputs.values},
                              prepared.common_errors},
                             prepared.problem, design, std::move(beside), options, context);
  if (!drift) return drift;
  drift->currency = modelled.site.config.tariff.currency;
  for (drift::FollowedOutput& output : drift->outputs) {
    const auto meter = modelled.site.config.meter_index(output.meter);
    output.rates = rates_of(modelled.site.config, modelled.recording.meters[*meter]);
  }
  return drift;
}

}  // namespace recald::daemon
