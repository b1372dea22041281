#include "daemon/site/savings/site_savings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/assessment/model_errors.hpp"
#include "core/calibration/posterior/draws.hpp"
#include "core/random/rng.hpp"
#include "core/random/streams.hpp"
#include "core/savings/drawn_errors.hpp"
#include "core/savings/year_weights.hpp"
#include "daemon/site/model/meter_rates.hpp"
#include "daemon/site/savings/building_measures.hpp"
#include "daemon/site/savings/runs_measures.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using savings::Change;
using savings::Measure;

constexpr int kDraws = 400;
constexpr double kMonthsAYear = 12.0;

AchievedDraws draw_achieved(const std::vector<Measure>& measures, Index draws, Rng& rng) {
  AchievedDraws achieved;
  for (const Measure& measure : measures) {
    auto& changes = achieved.emplace_back();
    for (const Change& change : measure.changes) {
      Eigen::VectorXd by(draws);
      for (double& one : by) one = change.by.quantile(rng.uniform());
      changes.push_back(std::move(by));
    }
  }
  return achieved;
}

/// What all measures of a site have in common.
struct Asked {
  const FinishedCalibration& finished;
  savings::YearWeights year;
  Eigen::MatrixXd factors;  ///< (draws x outputs) levels times responses.
  Eigen::MatrixXd missed;   ///< (draws x outputs) Share of a meter's use that the model misses.
  Eigen::MatrixXd before;   ///< (draws x outputs * months)
};

/// Per kWh, or per kW of the mean monthly peak over all of the months.
struct YearRates {
  std::optional<double> money;
  std::optional<double> emissions_kg;
};

YearRates year_rates(const Asked& asked, const assessment::OutputCalibration& output) {
  const ModelledSite& modelled = asked.finished.modelled;
  const tariff::Rates rates =
      rates_of(modelled.site.config, modelled.recording.meters[output.meter]);
  if (output.unit != "kW") return {rates.per_kWh, rates.emissions_kg_per_kWh};
  const double months =
      asked.year.is_year ? kMonthsAYear : static_cast<double>(asked.year.days.size());
  if (!rates.per_kW_month || *rates.per_kW_month == 0.0) return {};
  return {*rates.per_kW_month * months, {}};
}

/// What a month's daily average stands for: days of a year, or a share of the mean peak.
Eigen::VectorXd month_weights(const Asked& asked, bool is_peak) {
  return is_peak ? asked.year.days / asked.year.days.sum() : asked.year.days;
}

double baseline_of(const Asked& asked, std::size_t k) {
  const assessment::OutputCalibration& output = asked.finished.calibration.outputs[k];
  const Index months = asked.year.days.size();
  const Eigen::VectorXd weights = month_weights(asked, output.unit == "kW");
  const auto at = static_cast<Index>(k);
  double sum = 0.0;
  for (Index i = 0; i < months; ++i) {
    const double measured = output.measured[static_cast<std::size_t>(i)];
    sum +=
        weights(i) * (std::isnan(measured) ? asked.before.col(at * months + i).mean() : measured);
  }
  return sum;
}

MeasureSaving saving_of(const Asked& asked, std::string name, const Eigen::MatrixXd& after) {
  const SiteCalibration& result = asked.finished.calibration;
  const Index months = asked.year.days.size();
  MeasureSaving saving{.name = std::move(name), .cost = {}, .meters = {}, .notes = {}};
  std::optional<Eigen::VectorXd> money;
  std::optional<Eigen::VectorXd> emissions_kg;
  const auto add = [](std::optional<Eigen::VectorXd>& sum, const Eigen::VectorXd& part) {
    sum = sum ? Eigen::VectorXd{*sum + part} : part;
  };
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    const assessment::OutputCalibration& output = result.outputs[k];
    const bool is_peak = output.unit == "kW";
    const Index first = static_cast<Index>(k) * months;
    Eigen::VectorXd saved = asked.factors.col(static_cast<Index>(k))
                                .cwiseProduct((asked.before.middleCols(first, months) -
                                               after.middleCols(first, months)) *
                                              month_weights(asked, is_peak));
    MeterSaving meter{.output = output.name,
                      .meter = output.meter_id,
                      .utility = output.utility,
                      .is_peak = is_peak,
                      .baseline = baseline_of(asked, k),
                      .saved = {}};
    // What nothing in the model moves stays as it is.
    if (!saved.isZero(0.0)) saved += meter.baseline * asked.missed.col(static_cast<Index>(k));
    meter.saved = savings::estimate_of(saved);
    const YearRates rates = year_rates(asked, output);
    if (rates.money) {
      meter.money = savings::scaled(meter.saved, *rates.money);
      add(money, *rates.money * saved);
    }
    if (rates.emissions_kg) {
      meter.emissions_kg = savings::scaled(meter.saved, *rates.emissions_kg);
      add(emissions_kg, *rates.emissions_kg * saved);
    }
    saving.meters.push_back(std::move(meter));
  }
  if (money) saving.money = savings::estimate_of(*money);
  if (emissions_kg) saving.emissions_kg = savings::estimate_of(*emissions_kg);
  if ((asked.before - after).cwiseAbs().maxCoeff() == 0.0) {
    saving.notes.push_back(
        "It changes nothing in this model: the building does not have what it is about.");
  }
  return saving;
}

void take_cost(std::optional<double> cost, bool is_year, MeasureSaving& saving) {
  saving.cost = cost;
  if (cost && saving.money && is_year) {
    saving.payback = savings::simple_payback(*cost, *saving.money);
  }
}

/// All of them have one.
std::optional<double> cost_of_all(std::span<const Measure> measures) {
  double sum = 0.0;
  for (const Measure& measure : measures) {
    if (!measure.cost) return std::nullopt;
    sum += *measure.cost;
  }
  return sum;
}

std::vector<std::string> notes_of_all(const SiteCalibration& result, bool is_year) {
  const savings::ResponseErrors& response = savings::response_errors(result.model);
  std::vector<std::string> notes{fmt::format(
      "How strongly a model answers to a change is not tested by months without the change: its "
      "savings are counted as wrong by {:.0f} % (electricity), {:.0f} % (cooling) and {:.0f} % "
      "(heating), and by {:.1f} % of a meter's use, one standard deviation.",
      100.0 * response.electricity, 100.0 * response.cooling, 100.0 * response.heating,
      100.0 * savings::kMissedShare)};
  notes.emplace_back(
      "Weather, people and use are those of the calibration months. What else will change is not "
      "counted.");
  if (!is_year) {
    notes.emplace_back(
        "The calibration months are no year: savings are of these months alone, and no payback is "
        "given.");
  }
  if (result.effects) {
    notes.emplace_back(
        "Effects that the model has keep acting on its meters with the measure too.");
  }
  return notes;
}

/// Each measure by itself and, where there are several, all of them.
Result<void> add_savings(const MeasuredModel& model, const Asked& asked,
                         const Eigen::MatrixXd& buildings, const std::vector<Measure>& measures,
                         const AchievedDraws& achieved, Rng& rng, SiteSavings& savings) {
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const auto after = TRY(model.run_with(buildings, asked.before, achieved, m, rng));
    MeasureSaving saving = saving_of(asked, measures[m].name, after);
    take_cost(measures[m].cost, savings.is_year, saving);
    for (std::string& sentence : model.unknowns(measures[m])) {
      saving.notes.push_back(std::move(sentence));
    }
    savings.measures.push_back(std::move(saving));
  }
  if (measures.size() < 2) return {};
  const auto after = TRY(model.run_with(buildings, asked.before, achieved, {}, rng));
  savings.measures.push_back(saving_of(asked, kAllTogether, after));
  take_cost(cost_of_all(measures), savings.is_year, savings.measures.back());
  return {};
}

}  // namespace

Result<SiteSavings> savings_of(const FinishedCalibration& finished,
                               const std::vector<Measure>& measures,
                               const calibration::RunContext& context) {
  const SiteCalibration& result = finished.calibration;
  if (!result.with) return failure(ErrorCode::not_enough_data, result.not_calibrated_because);
  const auto model = TRY(result.design ? make_runs_measures(finished, measures, context)
                                       : make_building_measures(finished, measures, context));
  const std::vector<std::string>& months = result.with->problem.month_names;
  const std::vector<metering::Month> calibrated{result.months.begin(),
                                                result.months.begin() + std::ssize(months)};
  Asked asked{.finished = finished,
              .year = savings::year_weights(calibrated),
              .factors = {},
              .missed = {},
              .before = {}};

  const calibration::ThinnedDraws draws = calibration::thin(result.calibration.chains, kDraws);
  Rng rng_of_errors{context.seed, streams::kSavings[0]};
  Rng rng_of_measures{context.seed, streams::kSavings[1]};
  Rng rng_of_responses{context.seed, streams::kSavings[2]};
  // The measured months tell what the draws are off by, each at itself.
  Eigen::MatrixXd buildings = model->buildings(draws.theta, rng_of_measures);
  const auto simulated = TRY(model->run(buildings));
  const auto errors =
      TRY(savings::draw_errors(result.with->problem, result.with->errors, result.calibration, draws,
                               simulated, model->limits(), rng_of_errors));
  const Index q = model->calibrated();
  buildings.leftCols(q) = errors.theta.leftCols(q);

  std::vector<assessment::Service> services;
  for (const auto& output : result.outputs)
    services.push_back(assessment::service_of(output.utility));
  asked.factors = errors.level.cwiseProduct(savings::draw_responses(
      buildings.rows(), services, savings::response_errors(result.model), rng_of_responses));
  asked.missed = savings::draw_missed(buildings.rows(), std::ssize(services), rng_of_responses);
  asked.before = TRY(model->run(buildings));

  SiteSavings savings{.is_year = asked.year.is_year,
                      .months = months,
                      .draws = static_cast<int>(buildings.rows()),
                      .measures = {},
                      .notes = notes_of_all(result, asked.year.is_year)};
  const AchievedDraws achieved = draw_achieved(measures, buildings.rows(), rng_of_measures);
  TRY(add_savings(*model, asked, buildings, measures, achieved, rng_of_measures, savings));
  return savings;
}

}  // namespace recald::daemon
