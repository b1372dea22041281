/// Bayesian calibration of a building energy model against monthly figures, from priors to
/// convergence checks.
///
/// Method of Li, Gu, Augenbroe, Wu, Brown (2015), "A generic approach to calibrate building energy
/// models under uncertainty using Bayesian inference", Building Simulation ("the seed"): triangular
/// priors, a Latin hypercube of runs that fixes the normalisation, a Gaussian process for the model
/// discrepancy, Markov chains, and draws to run through the model again.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/calibration/checks/bridge.hpp"
#include "core/calibration/checks/leave_out.hpp"
#include "core/calibration/checks/weak_directions.hpp"
#include "core/calibration/covariance/hyper_prior.hpp"
#include "core/calibration/posterior/draws.hpp"
#include "core/calibration/posterior/findings.hpp"
#include "core/calibration/posterior/normalisation.hpp"
#include "core/calibration/posterior/problem.hpp"
#include "core/calibration/predictive.hpp"
#include "core/calibration/sampling.hpp"
#include "core/design/model_runs.hpp"
#include "core/model/monthly_model.hpp"
#include "core/result.hpp"

namespace recald::calibration {

struct CalibrationOptions {
  int design_runs = 200;  ///< >= 20
  std::variant<HyperPriorProfile, HyperPrior> hyper_prior = HyperPriorProfile::scaled;
  SamplingOptions sampling;
  int thinned_draws = 270;  ///< Equally spaced over the pooled chains.
  /// Samples a polynomial fitted to the design's runs instead of a model without a Jacobian, if
  /// there are enough runs; its error counts as known variance.
  bool emulate = false;
  bool predictive = false;  ///< Also fills `Calibration::predictions`.
};

/// The model at every point of a Latin hypercube through the priors.
struct DesignRuns {
  Eigen::MatrixXd theta;    ///< (runs x q) in the parameters' units.
  Eigen::MatrixXd outputs;  ///< (runs x outputs * months) in the outputs' units, output-major.
};

struct Calibration {
  DesignRuns design;
  Normalisation normalisation;
  RangeCheck range;
  HyperPrior hyper_prior;
  std::vector<ChainDraws> chains;
  std::vector<Summary> parameters;       ///< (q)
  std::vector<Summary> hyperparameters;  ///< lambda_delta, lambda_eps, beta_<input> …, beta_out
  SamplingReport sampling;
  /// (outputs * months) sd of the polynomial that replaced the model, in units; absent: the model
  /// itself was sampled.
  std::optional<Eigen::VectorXd> emulator_error_sd;
  Eigen::VectorXd posterior_mean;  ///< (q) theta, the point estimate.
  ThinnedDraws thinned;
  /// log p(y) by bridge sampling; absent if it was not found. Use it to compare models only if both
  /// calibrations converged; it also depends on the width of the priors.
  std::optional<BridgeEstimate> evidence;
  std::vector<LeaveOutScore> leave_out;  ///< Single months, then quarters of a year.
  /// Of all kept draws; absent where nobody asked.
  std::optional<PointPredictions> predictions;
  std::vector<WeakDirection> weak_directions;  ///< What the data leave as the priors had it.
  bool converged;     ///< The gate holds for every parameter and hyper-parameter.
  Findings findings;  ///< Everything to report in words; empty if there is nothing to remark.
  std::uint64_t seed;
};

/// For `design::run_model`: progress of a stage, and whether it goes on.
/// @param context  Outlives the observer.
[[nodiscard]] design::RunObserver of_runs(const RunContext& context,
                                          Progress::Stage stage = Progress::Stage::design);

/// Runs the model over a fresh Latin hypercube.
[[nodiscard]] Result<DesignRuns> run_design(const MonthlyModel& prototype,
                                            const CalibrationProblem& problem, int runs,
                                            const RunContext& context);

/// The whole calibration: design, normalisation, range check, chains, diagnostics.
///
/// @param prototype  Covers exactly the calibration months; cloned, never evaluated itself.
/// @return the calibration, converged or not, with any findings; or the errors of `check_problem`,
///         `normalise_design` (constant output) and `run_model`; invalid_value for options out of
///         range; cancelled.
/// @note   Pure: the same problem, options and seed give the same bytes with any executor.
[[nodiscard]] Result<Calibration> calibrate(const MonthlyModel& prototype,
                                            const CalibrationProblem& problem,
                                            const CalibrationOptions& options,
                                            const RunContext& context);

/// As above, on an existing design: the model is run only by the chains.
[[nodiscard]] Result<Calibration> calibrate_on_design(const MonthlyModel& prototype,
                                                      const CalibrationProblem& problem,
                                                      const CalibrationOptions& options,
                                                      DesignRuns design, const RunContext& context);

}  // namespace recald::calibration
