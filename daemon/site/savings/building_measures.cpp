#include "daemon/site/savings/building_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "core/design/model_runs.hpp"
#include "core/display/id_words.hpp"
#include "core/model/parameter_library.hpp"
#include "daemon/site/model/site_model.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using savings::Change;
using savings::Measure;

// Of the width of its prior: how far beyond it a parameter may mean something else in the model.
constexpr double kBeyondPrior = 0.5;
// The least that lights are, over what the profile has.
constexpr double kLeastLights = 0.8;
// Plugs that are left when the lights turn out to be most of the meter.
constexpr double kLeastPlugs = 0.2;

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
                         const model::ElectricityProfile& profile) {
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

/// The building with these measures.
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
    limit.least = std::max(limit.least, result.parameters[j].definition->least);
    limit.most = std::min(limit.most, result.parameters[j].definition->most);
  }
  return limits;
}

/// "Outdoor airflow rate" and what is known of it.
std::string unknown_of(const SiteCalibration& result, const Columns& columns,
                       const Change& change) {
  const Index j = *columns.find(change.parameter);
  const std::string label = display::capitalised(display::parameter_words(change.parameter));
  if (j < columns.calibrated) {
    return assessment::is_identified(result, static_cast<std::size_t>(j)) ? ""
                                                                          : prior_stands(label);
  }
  if (change.parameter == kElectric) return "";
  const bool is_shared = change.parameter == kLights || change.parameter == kPlugs;
  const Index drawn = is_shared ? *columns.find(kLights) : j;
  const Prior& prior = columns.parameters[static_cast<std::size_t>(drawn)].prior;
  if (!is_shared) return drawn_from(label, prior);
  return fmt::format(
      "The meter does not tell lights from plugs: by the installed power the lights "
      "take {:.1f} to {:.1f} times what the profile gives them.",
      prior.min(), prior.max());
}

constexpr auto kBuildingsRun = calibration::Progress::Stage::predicting;

class BuildingMeasures final : public MeasuredModel {
 public:
  BuildingMeasures(const FinishedCalibration& finished, const std::vector<Measure>& measures,
                   const calibration::RunContext& context)
      : result_{finished.calibration},
        measures_{measures},
        context_{context},
        columns_{columns_of(finished.modelled.site.config, result_, measures)},
        lights_{lights_known(*finished.modelled.site.config.building, result_.profile)} {
    const auto lights = columns_.find(kLights);
    if (!lights || *lights < columns_.calibrated) return;
    columns_.parameters[static_cast<std::size_t>(*lights)].prior = lights_prior(lights_);
  }

  /// Call it once, before anything else.
  Result<void> make_model(const ModelledSite& modelled) {
    const SiteConfig& site = modelled.site.config;
    SiteModelParts parts = result_.with->parts;
    parts.definitions = columns_.definitions;
    const auto months = std::ssize(result_.with->problem.month_names);
    const auto make = TRY(model_of(
        site, parts, {result_.months.begin(), result_.months.begin() + months},
        {modelled.site.calendar, site.holidays, *site.location, modelled.weather.filled.series}));
    model_ = make(*site.building);
    return {};
  }

  [[nodiscard]] Eigen::MatrixXd buildings(const Eigen::MatrixXd& theta, Rng& rng) const override {
    return without_measures(lights_, columns_, theta, rng);
  }
  [[nodiscard]] Index calibrated() const override { return columns_.calibrated; }
  [[nodiscard]] std::vector<savings::Limits> limits() const override {
    return limits_of(result_, columns_.calibrated);
  }
  [[nodiscard]] Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& buildings) const override {
    return design::run_model(*model_, columns_.parameters, buildings, context_.executor,
                             calibration::of_runs(context_, kBuildingsRun));
  }
  [[nodiscard]] Result<Eigen::MatrixXd> run_with(const Eigen::MatrixXd& buildings,
                                                 const Eigen::MatrixXd& /*before*/,
                                                 const AchievedDraws& achieved,
                                                 std::optional<std::size_t> measure,
                                                 Rng& /*rng*/) const override {
    const std::size_t first = measure.value_or(0);
    const std::size_t count = measure ? 1 : measures_.size();
    return run(with_measures(buildings, columns_, std::span{measures_}.subspan(first, count),
                             std::span{achieved}.subspan(first, count)));
  }
  [[nodiscard]] std::vector<std::string> unknowns(const Measure& measure) const override {
    std::set<std::string> sentences;
    for (const Change& change : measure.changes) {
      sentences.insert(unknown_of(result_, columns_, change));
    }
    sentences.erase("");
    return {sentences.begin(), sentences.end()};
  }

 private:
  const SiteCalibration& result_;
  const std::vector<Measure>& measures_;
  const calibration::RunContext& context_;
  Columns columns_;
  LightsKnown lights_;
  std::unique_ptr<MonthlyModel> model_;
};

}  // namespace

Result<std::unique_ptr<MeasuredModel>> make_building_measures(
    const FinishedCalibration& finished, const std::vector<Measure>& measures,
    const calibration::RunContext& context) {
  auto model = std::make_unique<BuildingMeasures>(finished, measures, context);
  TRY(model->make_model(finished.modelled));
  return model;
}

}  // namespace recald::daemon
