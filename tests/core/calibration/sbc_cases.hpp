/// The two ways of calibrating, made small or as large as the seed's, for simulation-based
/// calibration.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/assessment/model_errors.hpp"
#include "core/calibration/posterior/emulator.hpp"
#include "core/design/latin_hypercube.hpp"
#include "core/design/model_runs.hpp"
#include "core/model/epc/epc_model.hpp"
#include "core/model/metamodel/quadratic_model.hpp"
#include "core/model/parameter_library.hpp"
#include "tests/core/calibration/simulation_based_calibration.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::calibration {

/// A case with the model it refers to.
struct OwnedSbcCase {
  std::unique_ptr<MonthlyModel> model;
  SbcCase sbc;
  std::unique_ptr<MonthlyModel> stand_in{};
};

/// Weather-like inputs scaled to [0, 1]: a season, its echo, and two that wander.
inline Eigen::MatrixXd sbc_inputs(int months, int inputs) {
  Rng rng(11);
  Eigen::MatrixXd values(months, inputs);
  for (int i = 0; i < months; ++i) {
    const double season = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / 12.0);
    for (int s = 0; s < inputs; ++s) {
      const double share = s == 0 ? 0.9 : s == 1 ? 0.5 : 0.0;
      values(i, s) = share * season + (1.0 - share) * rng.uniform();
    }
  }
  const Eigen::RowVectorXd low = values.colwise().minCoeff();
  const Eigen::RowVectorXd range = values.colwise().maxCoeff() - low;
  return (values.rowwise() - low).array().rowwise() / range.array();
}

inline PosteriorData sbc_data(int outputs, int months, int inputs) {
  PosteriorData data;
  for (int k = 0; k < outputs; ++k) {
    for (int i = 0; i < months; ++i) data.points.push_back({k, i});
  }
  const auto m = static_cast<Eigen::Index>(data.points.size());
  data.month_inputs = sbc_inputs(months, inputs);
  data.extra_variances = Eigen::VectorXd::Zero(m);
  data.common_errors.resize(m, 0);
  data.scales.assign(static_cast<std::size_t>(outputs), {0.0, 1.0});
  data.weights.assign(static_cast<std::size_t>(outputs), 1.0);
  return data;
}

inline std::vector<std::string> sbc_input_names(int inputs) {
  const std::vector<std::string> names{"drybulb", "rh", "winddir", "windspeed"};
  return {names.begin(), names.begin() + inputs};
}

/// The meta-model path: a made-up quadratic in the parameters for two outputs.
/// @param gaps  Some months missing and some with the known error of filled gaps: the general
///              covariance. Without, the outputs decouple.
inline OwnedSbcCase metamodel_case(int parameters, int months, int inputs, bool gaps) {
  std::vector<regression::ColumnScale> scales(static_cast<std::size_t>(parameters), {10.0, 20.0});
  model::metamodel::QuadraticCoefficients coefficients(scales, 2, months);
  Rng rng(12);
  const Eigen::MatrixXd season = sbc_inputs(months, 1);
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < months; ++i) {
      coefficients.add_constant(k, i, 0.2 + 0.4 * season(i, 0));
      for (int j = 0; j < parameters; ++j) {
        const double strength = 0.3 * std::pow(0.6, j);
        const double of_season = (j % 2 == 0 ? season(i, 0) : 1.0 - season(i, 0));
        coefficients.add(k, i, {j, -1}, strength * (0.3 + of_season) * (k == 0 ? 1.0 : 0.7));
        if (j > 0) coefficients.add(k, i, {j - 1, j}, 0.05 * rng.normal());
      }
    }
  }
  PosteriorData data = sbc_data(2, months, inputs);
  if (gaps) {
    data.points.erase(data.points.begin() + months + 3);
    data.points.erase(data.points.begin() + 1);
    const auto m = static_cast<Eigen::Index>(data.points.size());
    data.extra_variances = Eigen::VectorXd::Zero(m);
    for (Eigen::Index i = 0; i < m; i += 5) data.extra_variances(i) = 4e-4;
    data.common_errors.resize(m, 1);
    for (Eigen::Index i = 0; i < m; ++i) {
      data.common_errors(i, 0) = data.points[static_cast<std::size_t>(i)].output == 0 ? 0.04 : 0.0;
    }
  }
  auto model = std::make_unique<model::metamodel::QuadraticModel>(coefficients);
  std::vector<Parameter> priors;
  for (int j = 0; j < parameters; ++j) {
    priors.push_back(
        {"p" + std::to_string(j + 1), "-", {10.0, 10.0 + 10.0 * ((j + 1) % 4) / 3.0, 20.0}});
  }
  const MonthlyModel& reference = *model;
  return {std::move(model),
          {reference,
           priors,
           data,
           make_hyper_prior(HyperPriorProfile::scaled, 0.028),
           sbc_input_names(inputs),
           {}}};
}

/// The EPC path: the sample building's chilled water and steam, three parameters, no gradient.
inline OwnedSbcCase epc_case(int months, int inputs) {
  const model::Building building = testing::sample_building();
  const std::vector<const model::ParameterDefinition*> definitions{
      *model::find_parameter("occupancy_density"), *model::find_parameter("outdoor_airflow"),
      *model::find_parameter("cooling_setpoint")};
  const auto climate =
      std::make_shared<const model::epc::ClimateClasses>(model::epc::make_climate_classes(
          testing::sample_drivers(building, months), model::epc::kClassesPerState));
  auto model = std::make_unique<model::epc::EpcModel>(
      building, definitions,
      std::vector<model::MeterMap>{*model::default_meter_map(metering::Utility::chilled_water),
                                   *model::default_meter_map(metering::Utility::steam)},
      climate);
  std::vector<Parameter> priors;
  for (const auto* definition : definitions) {
    priors.push_back(model::make_parameter(*definition, building).value());
  }
  Rng rng(13);
  const Eigen::MatrixXd theta = design::latin_hypercube(priors, 60, rng);
  const Eigen::MatrixXd runs =
      design::run_model(*model, priors, theta, for_each_index_serially, {}).value();
  PosteriorData data = sbc_data(2, months, inputs);
  for (int k = 0; k < 2; ++k) {
    const auto block = runs.middleCols(Eigen::Index{k} * months, months);
    data.scales[static_cast<std::size_t>(k)] = {block.minCoeff(), block.maxCoeff()};
  }
  // The model's own errors, as a calibration of a site has them by default.
  const std::array services{assessment::Service::cooling, assessment::Service::heating};
  const assessment::ModelErrorSizes& sizes = assessment::model_error_sizes(ModelKind::epc);
  const auto errors = assessment::model_errors(
      *model, priors, assessment::spreads_of(priors, sizes), services, sizes);
  const auto m = static_cast<Eigen::Index>(data.points.size());
  data.common_errors.resize(m, static_cast<Eigen::Index>(errors.size()));
  for (Eigen::Index i = 0; i < m; ++i) {
    const PointIndex& point = data.points[static_cast<std::size_t>(i)];
    const double range = data.scales[static_cast<std::size_t>(point.output)].range();
    for (std::size_t g = 0; g < errors.size(); ++g) {
      data.common_errors(i, static_cast<Eigen::Index>(g)) =
          errors[g](point.output * months + point.month) / range;
    }
  }
  const MonthlyModel& reference = *model;
  return {std::move(model),
          {reference,
           priors,
           data,
           make_hyper_prior(HyperPriorProfile::scaled, 0.05),
           sbc_input_names(inputs),
           {}}};
}

/// The EPC path as a site's calibration goes by default: a polynomial in the chains, its error
/// among the points' variances, and the sampler that recald picks.
/// @param data_from_model  The data come from the model itself, which the polynomial only follows.
///                         Without, from the polynomial and its error, as the posterior assumes.
inline OwnedSbcCase emulated_epc_case(int months, int inputs, bool data_from_model) {
  OwnedSbcCase c = epc_case(months, inputs);
  Rng rng(14);
  const Eigen::MatrixXd theta = design::latin_hypercube(c.sbc.parameters, 200, rng);
  const Eigen::MatrixXd runs =
      design::run_model(*c.model, c.sbc.parameters, theta, for_each_index_serially, {}).value();
  Emulator emulator = emulate(theta, runs, c.model->output_count(), c.model->month_count()).value();
  PosteriorData with_error = c.sbc.data;
  add_emulator_error(emulator.error_sd, months, with_error);
  c.stand_in = std::make_unique<model::metamodel::QuadraticModel>(std::move(emulator.model));
  if (data_from_model) {
    c.sbc.stand_in_variances = with_error.extra_variances - c.sbc.data.extra_variances;
    c.sbc.stand_in = c.stand_in.get();
    return c;
  }
  const MonthlyModel& polynomial = *c.stand_in;
  return {std::move(c.stand_in),
          {polynomial, c.sbc.parameters, with_error, c.sbc.prior, c.sbc.input_names, {}}};
}

}  // namespace recald::calibration
