#include "adapters/views/drift/drift_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/results/job_result_json.hpp"
#include "adapters/shapes/shape_json.hpp"
#include "adapters/views/drift/drift_summary.hpp"
#include "adapters/views/frame/provenance.hpp"
#include "core/display/warning.hpp"

SHAPE(recald::drift::ForecastRecord, measured, mean, sd, q05, q50, q95);
SHAPE(recald::drift::Surprise, pit, standardised, log_score, crps);
SHAPE(recald::drift::CalibrationCheck, mean, sd, lag_one, pvalue);
SHAPE(recald::drift::WatchState, log_evidence, log_threshold, cusum_upper, cusum_lower,
      change_within_year, calibration);
SHAPE(recald::drift::DailyState, log_evidence, log_threshold, lag_one, month_factor);

namespace recald::views {
namespace {

// Keys in the order they are written: files are read by people too.
using Json = nlohmann::ordered_json;

Json record_json(const drift::ForecastRecord& record, const std::string& month) {
  Json json = {{"month", month}};
  json.update(shapes::json_of(record));
  json.update(shapes::json_of(record.surprise));
  return json;
}

Json outputs_json(const drift::SiteDrift& drift) {
  Json list = Json::array();
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    const drift::FollowedOutput& output = drift.outputs[k];
    Json months = Json::array();
    for (const drift::PrequentialMonth& month : drift.record) {
      if (!month.outputs[k]) continue;
      months.push_back(record_json(*month.outputs[k], drift.month_name(month.month)));
    }
    list.push_back({{"name", output.name},
                    {"meter", output.meter},
                    {"unit", output.unit},
                    {"forecast_by", output.by_level ? "level" : "model"},
                    {"state", shapes::json_of(output.state)},
                    {"daily", shapes::json_of(output.daily)},
                    {"months", months}});
  }
  return list;
}

Json windows_json(const drift::SiteDrift& drift) {
  Json list = Json::array();
  const auto first = static_cast<std::size_t>(drift.learning_months - 1);
  for (const drift::FollowedWindow& window : drift.windows) {
    Json parameters = Json::array();
    for (std::size_t j = 0; j < window.paths.size(); ++j) {
      Json months = Json::array();
      for (std::size_t i = 0; i < window.paths[j].mean.size(); ++i) {
        months.push_back({{"month", drift.months[first + i]},
                          {"mean", results::number(window.paths[j].mean[i])},
                          {"q05", results::number(window.paths[j].q05[i])},
                          {"q95", results::number(window.paths[j].q95[i])}});
      }
      parameters.push_back({{"name", drift.parameters[j].name},
                            {"unit", drift.parameters[j].unit},
                            {"months", months}});
    }
    int anew = 0;
    for (const drift::MonthTaken& taken : window.taken) anew += taken.anew ? 1 : 0;
    list.push_back({{"name", window.name},
                    {"log_score", results::number(window.log_score)},
                    {"sampled_anew", anew},
                    {"parameters", parameters}});
  }
  return list;
}

Json shifts_json(const drift::SiteDrift& drift) {
  Json list = Json::array();
  for (std::size_t j = 0; j < drift.last_year.size(); ++j) {
    const drift::Shift& shift = drift.last_year[j];
    list.push_back({{"name", drift.parameters[j].name},
                    {"standardised", results::number(shift.standardised)},
                    {"hellinger", results::number(shift.hellinger)},
                    {"wasserstein", results::number(shift.wasserstein)},
                    {"probability_of_increase", results::number(shift.increased)},
                    {"pvalue", results::number(shift.pvalue)}});
  }
  return list;
}

}  // namespace

std::string drift_json(const drift::SiteDrift& drift, const RunFacts& facts) {
  const DriftSummary summary = summary_of(drift);
  Json json = {{"model", name_of(drift.model)},
               {"months", drift.months},
               {"learning_months", drift.learning_months},
               {"alarms", results::alarms_json(summary)},
               {"meter_changes", results::changed_meters_json(summary)},
               {"outputs", outputs_json(drift)},
               {"windows", windows_json(drift)},
               {"last_year", shifts_json(drift)},
               {"warnings", display::texts_of(drift.warnings)},
               {"seed", facts.seed}};
  add_provenance(facts, json);
  return json.dump(2) + "\n";
}

}  // namespace recald::views
