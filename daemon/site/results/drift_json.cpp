#include "daemon/site/results/drift_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/results/job_result_json.hpp"
#include "core/display/warning.hpp"
#include "daemon/site/results/drift_summary.hpp"
#include "daemon/site/results/provenance_json.hpp"

namespace recald::daemon {
namespace {

// Keys in the order they are written: files are read by people too.
using Json = nlohmann::ordered_json;

Json record_json(const drift::ForecastRecord& record, const std::string& month) {
  return {{"month", month},
          {"measured", results::number(record.measured)},
          {"mean", results::number(record.mean)},
          {"sd", results::number(record.sd)},
          {"q05", results::number(record.q05)},
          {"q50", results::number(record.q50)},
          {"q95", results::number(record.q95)},
          {"pit", results::number(record.surprise.pit)},
          {"standardised", results::number(record.surprise.standardised)},
          {"log_score", results::number(record.surprise.log_score)},
          {"crps", results::number(record.surprise.crps)}};
}

Json state_json(const drift::WatchState& state) {
  Json json = {{"log_evidence", results::number(state.log_evidence)},
               {"log_threshold", results::number(state.log_threshold)},
               {"cusum_upper", results::number(state.cusum_upper)},
               {"cusum_lower", results::number(state.cusum_lower)},
               {"change_within_year", results::number(state.change_within_year)},
               {"calibration", nullptr}};
  if (const auto& check = state.calibration) {
    json["calibration"] = {{"mean", results::number(check->mean)},
                           {"sd", results::number(check->sd)},
                           {"lag_one", results::number(check->lag_one)},
                           {"pvalue", results::number(check->pvalue)}};
  }
  return json;
}

Json daily_json(const std::optional<DailyState>& daily) {
  if (!daily) return nullptr;
  return {{"log_evidence", results::number(daily->log_evidence)},
          {"log_threshold", results::number(daily->log_threshold)},
          {"lag_one", results::number(daily->lag_one)},
          {"month_factor", results::number(daily->month_factor)}};
}

Json outputs_json(const SiteDrift& drift) {
  Json list = Json::array();
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    const FollowedOutput& output = drift.outputs[k];
    Json months = Json::array();
    for (const drift::PrequentialMonth& month : drift.record) {
      if (!month.outputs[k]) continue;
      months.push_back(record_json(*month.outputs[k], drift.month_name(month.month)));
    }
    list.push_back({{"name", output.name},
                    {"meter", output.meter},
                    {"unit", output.unit},
                    {"forecast_by", output.by_level ? "level" : "model"},
                    {"state", state_json(output.state)},
                    {"daily", daily_json(output.daily)},
                    {"months", months}});
  }
  return list;
}

Json windows_json(const SiteDrift& drift) {
  Json list = Json::array();
  const auto first = static_cast<std::size_t>(drift.learning_months - 1);
  for (const FollowedWindow& window : drift.windows) {
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

Json shifts_json(const SiteDrift& drift) {
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

std::string drift_json(const SiteDrift& drift, const RunFacts& facts) {
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

}  // namespace recald::daemon
