#include "daemon/site/savings/site_savings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "core/assessment/model_errors.hpp"
#include "core/calibration/draws.hpp"
#include "core/design/model_runs.hpp"
#include "core/display/id_words.hpp"
#include "core/model/parameter_library.hpp"
#include "core/random/rng.hpp"
#include "core/random/streams.hpp"
#include "core/savings/drawn_errors.hpp"
#include "core/savings/year_weights.hpp"
#include "daemon/site/model/meter_rates.hpp"
#include "daemon/site/model/site_model.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using savings::Change;
using savings::Measure;

constexpr int kDraws = 400;
// Of the width of its prior: how far beyond it a parameter may mean something else in the model.
constexpr double kBeyondPrior = 0.5;
// The least that lights are, over what the profile has.
constexpr double kLeastLights = 0.8;
// Plugs that are left when the lights turn out to be most of the meter.
constexpr double kLeastPlugs = 0.2;
constexpr double kMonthsAYear = 12.0;

constexpr std::string_view kLights = "lighting_use";
constexpr std::string_view kPlugs = "plug_use";
constexpr std::string_view kElectric = "electric_use";

/// The columns of the model that is asked: θ of the site, what measures change beside it, η.
struct Columns {
  std::vector<const model::ParameterDefinition*> definitions;  ///< θ, then the others.
  std::vector<Parameter> parameters;                           ///< All, for messages.
  Index calibrated = 0;                                        ///< θ
  Index beside = 0;
  Index effects = 0;  ///< η

  [[nodiscard]] std::optional<Index> find(std::string_view name) const {
    const auto found = std::ranges::find(definitions, name, &model::ParameterDefinition::name);
    if (found == definitions.end()) return std::nullopt;
    return found - definitions.begin();
  }
  [[nodiscard]] Index count() const { return calibrated + beside + effects; }
};

/// A quantity that is not calibrated and has no range keeps its design value.
Parameter beside_parameter(const model::ParameterDefinition& definition,
                           const model::Building& building) {
  auto made = model::make_parameter(definition, building);
  if (made) return std::move(*made);
  const double design = definition.get(building);
  return {std::string{definition.name}, std::string{definition.unit},
          Prior{UniformPrior{design, std::nextafter(design, design + 1.0)}}};
}

Columns columns_of(const SiteConfig& site, const SiteCalibration& result,
                   const std::vector<Measure>& measures) {
  Columns columns{.definitions = result.with->parts.definitions, .parameters = {}};
  columns.calibrated = std::ssize(columns.definitions);
  const auto add = [&](std::string_view name) {
    if (!columns.find(name)) columns.definitions.push_back(*model::find_parameter(name));
  };
  for (const Measure& measure : measures) {
    for (const Change& change : measure.changes) {
      add(change.parameter);
      // The meter knows the sum of both: what one is less, the other is more.
      if (change.parameter == kLights) add(kPlugs);
      if (change.parameter == kPlugs) add(kLights);
    }
  }
  const auto q = static_cast<std::size_t>(columns.calibrated);
  const auto eta = result.parameters.begin() + columns.calibrated;
  columns.parameters.assign(result.parameters.begin(), eta);
  for (std::size_t j = q; j < columns.definitions.size(); ++j) {
    columns.parameters.push_back(beside_parameter(*columns.definitions[j], *site.building));
  }
  columns.beside = std::ssize(columns.definitions) - columns.calibrated;
  columns.parameters.insert(columns.parameters.end(), eta, result.parameters.end());
  columns.effects = result.parameters.end() - eta;
  return columns;
}

/// What a usual week's lights may be, which the meter does not tell from the plugs.
struct LightsKnown {
  double over_plugs;  ///< kWh of the profile's lights over those of its plugs.
  double most;        ///< The most that they can be, over what the profile has; >= 1.
};

/// The profile gives all of the standing load to the plugs, and the lights their share of the
/// installed power of the rest. At most they are on as far as that rest goes, and part of the
/// standing load is theirs (corridors, signs).
LightsKnown lights_known(const model::Building& building,
                         const profile::ElectricityProfile& profile) {
  constexpr std::array<double, model::kDayTypes> kDays{5.0, 1.0, 1.0};
  const double lights_kW = 1e-3 * building.use.lighting_W_m2 * building.floor_area_m2;
  const double plugs_kW = 1e-3 * building.use.plugs_W_m2 * building.floor_area_m2;
  const double share = lights_kW > 0.0 ? lights_kW / (lights_kW + plugs_kW) : 0.0;
  double lights = 0.0;
  double plugs = 0.0;
  double most = 0.0;
  for (std::size_t type = 0; type < model::kDayTypes; ++type) {
    for (int hour = 0; hour < 24; ++hour) {
      const auto day = static_cast<model::DayType>(type);
      const double both =
          profile.loads.lights_kW.at(day, hour) + profile.loads.plugs_kW.at(day, hour);
      const double standing = std::min(profile.standby_kW, both);
      lights += kDays[type] * profile.loads.lights_kW.at(day, hour);
      plugs += kDays[type] * profile.loads.plugs_kW.at(day, hour);
      most += kDays[type] * (std::min(both - standing, lights_kW) + share * standing);
    }
  }
  if (!(lights > 0.0) || !(plugs > 0.0)) return {0.0, 1.0};
  return {lights / plugs, std::max(most / lights, 1.0)};
}

/// Of the lights, over what the profile has.
Prior lights_prior(const LightsKnown& known) {
  return {kLeastLights, 0.5 * (1.0 + known.most), std::max(known.most, 1.0 / kLeastLights)};
}

/// What the building is without any measure. (draws x columns)
Eigen::MatrixXd without_measures(const LightsKnown& known, const Columns& columns,
                                 const Eigen::MatrixXd& theta, Rng& rng) {
  const Index draws = theta.rows();
  Eigen::MatrixXd before(draws, columns.count());
  before.leftCols(columns.calibrated) = theta.leftCols(columns.calibrated);
  before.rightCols(columns.effects) = theta.rightCols(columns.effects);
  const auto lights = columns.find(kLights);
  const auto plugs = columns.find(kPlugs);
  for (Index d = 0; d < draws; ++d) {
    for (Index j = columns.calibrated; j < columns.calibrated + columns.beside; ++j) {
      const double probability = rng.uniform();
      const auto at = static_cast<std::size_t>(j);
      // The meter has the sum of lights and plugs; nothing of it is to be drawn.
      before(d, j) = columns.definitions[at]->name == kElectric
                         ? 1.0
                         : columns.parameters[at].prior.quantile(probability);
    }
    if (lights && plugs && *plugs >= columns.calibrated) {
      before(d, *plugs) =
          std::max(1.0 + known.over_plugs * (1.0 - before(d, *lights)), kLeastPlugs);
    }
  }
  return before;
}

/// The building with these measures. @param shares  (measures x draws) of what each change
/// achieves.
Eigen::MatrixXd with_measures(Eigen::MatrixXd theta, const Columns& columns,
                              std::span<const Measure> measures,
                              std::span<const std::vector<Eigen::VectorXd>> achieved) {
  for (std::size_t m = 0; m < measures.size(); ++m) {
    for (std::size_t c = 0; c < measures[m].changes.size(); ++c) {
      const Change& change = measures[m].changes[c];
      const Index j = *columns.find(change.parameter);
      const auto& definition = *columns.definitions[static_cast<std::size_t>(j)];
      for (Index d = 0; d < theta.rows(); ++d) {
        theta(d, j) = std::clamp(model::changed(change.kind, theta(d, j), achieved[m][c](d)),
                                 definition.least, definition.most);
      }
    }
  }
  return theta;
}

/// (measures) (changes) (draws)
std::vector<std::vector<Eigen::VectorXd>> draw_achieved(const std::vector<Measure>& measures,
                                                        Index draws, Rng& rng) {
  std::vector<std::vector<Eigen::VectorXd>> achieved;
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

std::vector<savings::Limits> limits_of(const SiteCalibration& result, Index calibrated) {
  std::vector<savings::Limits> limits;
  for (std::size_t j = 0; j < result.parameters.size(); ++j) {
    const Prior& prior = result.parameters[j].prior;
    const double beyond = kBeyondPrior * (prior.max() - prior.min());
    savings::Limits& limit = limits.emplace_back(prior.min() - beyond, prior.max() + beyond);
    if (static_cast<Index>(j) >= calibrated) {
      limit = {prior.min(), prior.max()};  // of an effect, which is no error of the model
      continue;
    }
    limit.least = std::max(limit.least, result.definitions[j]->least);
    limit.most = std::min(limit.most, result.definitions[j]->most);
  }
  return limits;
}

/// What all measures of a site have in common.
struct Asked {
  const FinishedCalibration& finished;
  Columns columns;
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

/// "Outdoor airflow rate" and what is known of it.
void add_knowledge(const Asked& asked, const Measure& measure, std::vector<std::string>& notes) {
  const SiteCalibration& result = asked.finished.calibration;
  for (const Change& change : measure.changes) {
    const Index j = *asked.columns.find(change.parameter);
    const std::string label = display::capitalised(display::parameter_words(change.parameter));
    if (j < asked.columns.calibrated) {
      if (assessment::is_identified(result, static_cast<std::size_t>(j))) continue;
      notes.push_back(fmt::format(
          "{}: the meters do not settle what it is today, so its prior stands.", label));
    } else if (change.parameter == kLights || change.parameter == kPlugs) {
      const Prior& lights =
          asked.columns.parameters[static_cast<std::size_t>(*asked.columns.find(kLights))].prior;
      notes.push_back(
          fmt::format("The meter does not tell lights from plugs: by the installed power the "
                      "lights take {:.1f} "
                      "to {:.1f} times what the profile gives them.",
                      lights.min(), lights.max()));
    } else if (change.parameter != kElectric) {
      const Prior& prior = asked.columns.parameters[static_cast<std::size_t>(j)].prior;
      notes.push_back(
          fmt::format("{} is not calibrated: what it is today is drawn from {:.3g} to {:.3g}.",
                      label, prior.min(), prior.max()));
    }
  }
  std::ranges::sort(notes);
  const auto repeated = std::ranges::unique(notes);
  notes.erase(repeated.begin(), repeated.end());
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

using RunModel = std::function<Result<Eigen::MatrixXd>(const Eigen::MatrixXd& theta)>;

/// Each measure by itself and, where there are several, all of them.
/// @param plain     (draws x columns) without any.
/// @param achieved  As `draw_achieved`.
Result<void> add_savings(const RunModel& run, const Asked& asked, const Eigen::MatrixXd& plain,
                         std::span<const Measure> measures,
                         std::span<const std::vector<Eigen::VectorXd>> achieved,
                         SiteSavings& savings) {
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const auto after =
        run(with_measures(plain, asked.columns, measures.subspan(m, 1), achieved.subspan(m, 1)));
    if (!after) return tl::unexpected(after.error());
    MeasureSaving saving = saving_of(asked, measures[m].name, *after);
    take_cost(measures[m].cost, savings.is_year, saving);
    add_knowledge(asked, measures[m], saving.notes);
    savings.measures.push_back(std::move(saving));
  }
  if (measures.size() < 2) return {};
  const auto after = run(with_measures(plain, asked.columns, measures, achieved));
  if (!after) return tl::unexpected(after.error());
  savings.measures.push_back(saving_of(asked, kAllTogether, *after));
  take_cost(cost_of_all(measures), savings.is_year, savings.measures.back());
  return {};
}

}  // namespace

Result<SiteSavings> savings_of(const FinishedCalibration& finished,
                               const std::vector<Measure>& measures,
                               const calibration::RunContext& context) {
  const SiteCalibration& result = finished.calibration;
  const ModelledSite& modelled = finished.modelled;
  const SiteConfig& site = modelled.site.config;
  if (!result.with) return failure(ErrorCode::not_enough_data, result.not_calibrated_because);
  const std::vector<std::string>& months = result.with->problem.month_names;
  const std::vector<metering::Month> calibrated{result.months.begin(),
                                                result.months.begin() + std::ssize(months)};

  Asked asked{.finished = finished,
              .columns = columns_of(site, result, measures),
              .year = savings::year_weights(calibrated),
              .factors = {},
              .missed = {},
              .before = {}};
  SiteModelParts parts = result.with->parts;
  parts.definitions = asked.columns.definitions;
  const LightsKnown known = lights_known(*site.building, result.profile);
  if (const auto lights = asked.columns.find(kLights);
      lights && *lights >= asked.columns.calibrated) {
    asked.columns.parameters[static_cast<std::size_t>(*lights)].prior = lights_prior(known);
  }
  const auto make = model_of(
      site, parts, calibrated,
      {modelled.site.calendar, site.holidays, *site.location, modelled.weather.filled.series});
  if (!make) return tl::unexpected(make.error());
  const std::unique_ptr<MonthlyModel> model = (*make)(*site.building);
  const auto run = [&](const Eigen::MatrixXd& theta) {
    return design::run_model(*model, asked.columns.parameters, theta, context.executor);
  };

  const calibration::ThinnedDraws draws = calibration::thin(result.calibration.chains, kDraws);
  Rng rng_of_errors{context.seed, streams::kSavings[0]};
  Rng rng_of_measures{context.seed, streams::kSavings[1]};
  Rng rng_of_responses{context.seed, streams::kSavings[2]};
  // The measured months tell what the draws are off by, each at itself.
  Eigen::MatrixXd plain = without_measures(known, asked.columns, draws.theta, rng_of_measures);
  const auto simulated = run(plain);
  if (!simulated) return tl::unexpected(simulated.error());
  const auto errors =
      savings::draw_errors(result.with->problem, result.with->errors, result.calibration, draws,
                           *simulated, limits_of(result, asked.columns.calibrated), rng_of_errors);
  if (!errors) return tl::unexpected(errors.error());
  plain.leftCols(asked.columns.calibrated) = errors->theta.leftCols(asked.columns.calibrated);

  std::vector<assessment::Service> services;
  for (const auto& output : result.outputs)
    services.push_back(assessment::service_of(output.utility));
  asked.factors = errors->level.cwiseProduct(savings::draw_responses(
      plain.rows(), services, savings::response_errors(result.model), rng_of_responses));
  asked.missed = savings::draw_missed(plain.rows(), std::ssize(services), rng_of_responses);
  auto before = run(plain);
  if (!before) return tl::unexpected(before.error());
  asked.before = std::move(*before);

  SiteSavings savings{.is_year = asked.year.is_year,
                      .months = months,
                      .draws = static_cast<int>(plain.rows()),
                      .measures = {},
                      .notes = notes_of_all(result, asked.year.is_year)};
  const auto achieved = draw_achieved(measures, plain.rows(), rng_of_measures);
  if (auto added = add_savings(run, asked, plain, measures, achieved, savings); !added) {
    return tl::unexpected(added.error());
  }
  return savings;
}

}  // namespace recald::daemon
