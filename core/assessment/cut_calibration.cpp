#include "core/assessment/cut_calibration.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/absent.hpp"
#include "core/calibration/cut_sampling.hpp"
#include "core/calibration/posterior/emulator.hpp"
#include "core/calibration/samplers/samplers.hpp"
#include "core/model/model_adaptors.hpp"

namespace recald::assessment {
namespace {

using calibration::Calibration;
using calibration::CalibrationOptions;
using calibration::CalibrationProblem;
using calibration::CutDraws;
using calibration::CutOptions;
using calibration::RunContext;

constexpr int kEtaValues = 50;
/// Draws kept at each η: a walk's neighbours are too alike to be counted one by one.
constexpr int kKeptEach = 20;

/// θ alone, η held at `eta`.
FixedParametersModel with_eta(const MonthlyModel& model, std::size_t theta_count,
                              const std::vector<double>& eta) {
  std::vector<int> free(theta_count);
  std::iota(free.begin(), free.end(), 0);
  std::vector<double> all(theta_count);
  all.insert(all.end(), eta.begin(), eta.end());
  return {model.clone(), std::move(all), std::move(free)};
}

CalibrationProblem theta_alone(CalibrationProblem problem, std::size_t theta_count) {
  problem.parameters.erase(problem.parameters.begin() + static_cast<std::ptrdiff_t>(theta_count),
                           problem.parameters.end());
  return problem;
}

CutOptions cut_options(const calibration::SamplingOptions& sampling, Eigen::Index eta_values) {
  const calibration::SamplerOptions defaults = (*calibration::find_sampler("dram"))->defaults;
  const int burn_in = sampling.burn_in.value_or(defaults.burn_in);
  const int kept = sampling.iterations.value_or(defaults.iterations) - burn_in;
  const int stride = std::max(kept / static_cast<int>(eta_values) / kKeptEach, 1);
  return {.burn_in = std::max(burn_in, 1),
          .settle_each = kKeptEach * stride / 2,
          .kept_each = kKeptEach,
          .stride = stride,
          .chains = sampling.chains};
}

/// What is read off the pooled draws. @param q  Parameters that are judged: θ, which moves.
void summarise(std::size_t q, const CalibrationOptions& options, const RunContext& context,
               AssessedCalibration& result) {
  Calibration& c = result.calibration;
  c.parameters = calibration::summarise_parameters(result.parameters, c.chains, context.executor);
  std::vector<std::string> names;
  for (const calibration::Summary& s : c.hyperparameters) names.push_back(s.name);
  c.hyperparameters =
      calibration::summarise_hyperparameters(c.hyper_prior, names, c.chains, context.executor);
  auto judged = c.hyperparameters;
  judged.insert(judged.end(), c.parameters.begin(),
                c.parameters.begin() + static_cast<std::ptrdiff_t>(q));
  for (const calibration::Finding& finding :
       calibration::gate_findings(judged, options.sampling.gate)) {
    c.converged = false;
    result.warnings.push_back(warning_of(finding));
  }
  c.posterior_mean.resize(static_cast<Eigen::Index>(c.parameters.size()));
  for (std::size_t j = 0; j < c.parameters.size(); ++j) {
    c.posterior_mean[static_cast<Eigen::Index>(j)] = c.parameters[j].mean;
  }
  c.thinned = calibration::thin(c.chains, options.thinned_draws);
}

/// What speaks of θ alone gets its place for η: the cut asks nothing of η and no belief moves it.
void make_room_for_eta(std::size_t q, AssessedCalibration& result) {
  Calibration& c = result.calibration;
  const auto r = static_cast<Eigen::Index>(c.parameters.size() - q);
  for (calibration::WeakDirection& direction : c.weak_directions) {
    direction.loadings.conservativeResize(direction.loadings.size() + r);
    direction.loadings.tail(r).setZero();
  }
  if (!result.sensitivity) return;
  for (std::size_t j = q; j < c.parameters.size(); ++j) {
    const double mean = c.parameters[j].mean;
    result.sensitivity->parameters.push_back({mean, mean, 0.0, false});
  }
}

/// Puts the pooled draws in the place of those at one η, and η among the parameters.
void take_over(CutDraws cut, const CutOptions& how, const CalibrationOptions& options,
               const RunContext& context, AssessedCalibration& result) {
  Calibration& c = result.calibration;
  const std::size_t q = c.parameters.size();
  c.chains = std::move(cut.chains);
  summarise(q, options, context, result);
  make_room_for_eta(q, result);
  c.sampling.sampler = "dram";
  c.sampling.burn_in = how.burn_in;
  c.sampling.kept = static_cast<int>(c.chains.front().log_density.size());
  for (const auto& chain : cut.statistics) {
    c.sampling.density_evaluations += chain.density_evaluations;
  }
  c.sampling.chains = std::move(cut.statistics);
}

/// What is drawn from and predicted with: the model, or a polynomial in θ and η in its place.
struct CutModel {
  std::optional<calibration::Emulator> emulator = {};
  Eigen::VectorXd error_sd = {};  ///< Of the polynomial.

  [[nodiscard]] const MonthlyModel& in_place_of(const MonthlyModel& model) const {
    return emulator ? static_cast<const MonthlyModel&>(emulator->model) : model;
  }
};

CutModel cut_model(const MonthlyModel& model, const calibration::DesignRuns& design,
                   const CalibrationOptions& options) {
  CutModel cut;
  if (!options.emulate || model.has_jacobian()) return cut;
  auto emulator =
      calibration::emulate(design.theta, design.outputs, model.output_count(), model.month_count());
  if (!emulator) return cut;  // too few runs for this many parameters
  cut.error_sd = emulator->error_sd;
  cut.emulator = std::move(*emulator);
  return cut;
}

/// @param problem  Of θ alone, without the outputs that were set aside; `all` has η too.
Result<void> predict_with_eta(const MonthlyModel& model, const CutModel& cut,
                              const CalibrationProblem& all, const CalibrationProblem& problem,
                              const RunContext& context, AssessedCalibration& result) {
  Calibration& c = result.calibration;
  auto data = calibration::normalise_problem(problem, c.normalisation);
  if (cut.emulator) calibration::add_emulator_error(cut.error_sd, model.month_count(), data);
  const auto posterior = TRY(calibration::Posterior::make(cut.in_place_of(model), all.parameters,
                                                          std::move(data), c.hyper_prior));
  c.predictions = TRY(calibration::predict_points(posterior, c.chains, context));
  return {};
}

}  // namespace

Eigen::MatrixXd spread_eta(const Eigen::MatrixXd& draws) {
  return draws(calibration::equally_spaced(static_cast<int>(draws.rows()), kEtaValues), Eigen::all);
}

Result<Eigen::MatrixXd> taught_by_months(const MonthlyModel& model,
                                         const CalibrationProblem& problem, Eigen::Index r,
                                         const std::vector<bool>& teaches,
                                         const CalibrationOptions& options,
                                         const RunContext& context) {
  CalibrationProblem later = problem;
  for (calibration::OutputMeasurements& output : later.outputs) {
    for (std::size_t i = 0; i < teaches.size(); ++i) {
      if (!teaches[i]) output.values[i] = kAbsent;
    }
  }
  CalibrationOptions how = options;
  how.predictive = false;  // whoever asks means the months that teach θ
  const auto learnt = TRY(calibration::calibrate(model, later, how, context));
  // Whoever gives a number of draws gets what they find.
  if (!learnt.converged && !options.sampling.iterations) {
    return failure(ErrorCode::not_enough_data, "the chains for them alone disagree");
  }
  return Eigen::MatrixXd{spread_eta(learnt.thinned.theta).rightCols(r)};
}

Result<void> calibrate_given_eta(const MonthlyModel& model, const CalibrationProblem& all,
                                 const calibration::DesignRuns& joint_design,
                                 const Eigen::MatrixXd& eta, const CalibrationOptions& options,
                                 bool prior_sensitivity, const RunContext& context,
                                 AssessedCalibration& result) {
  const std::size_t q = result.parameters.size() - static_cast<std::size_t>(eta.cols());
  const Eigen::RowVectorXd mean = eta.colwise().mean();
  const FixedParametersModel at_mean = with_eta(model, q, {mean.begin(), mean.end()});
  CalibrationProblem problem = theta_alone(all, q);
  auto design = TRY(calibration::run_design(at_mean, problem, options.design_runs, context));
  set_aside_unresponsive(design, result, problem);
  CalibrationOptions at_mean_options = options;
  at_mean_options.predictive = false;
  if (auto done = calibrate_into(at_mean, problem, at_mean_options, prior_sensitivity,
                                 std::move(design), context, result);
      !done) {
    return done;
  }
  const CutOptions how = cut_options(options.sampling, eta.rows());
  const CutModel cut = cut_model(model, joint_design, options);
  auto draws = TRY(calibration::sample_given_eta(cut.in_place_of(model), cut.error_sd,
                                                 result.calibration, problem, eta, how, context));
  take_over(std::move(draws), how, options, context, result);
  if (cut.emulator) result.calibration.emulator_error_sd = cut.error_sd;
  if (!options.predictive) return {};
  return predict_with_eta(model, cut, all, problem, context, result);
}

}  // namespace recald::assessment
