#include "daemon/site/calibrate/effects_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/absent.hpp"
#include "core/calibration/cut_sampling.hpp"
#include "core/calibration/samplers.hpp"
#include "core/model/model_adaptors.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {
namespace {

using calibration::Calibration;
using calibration::CalibrationProblem;
using calibration::CutDraws;
using calibration::CutOptions;

constexpr int kEtaValues = 50;
/// Draws kept at each η: a walk's neighbours are too alike to be counted one by one.
constexpr int kKeptEach = 20;

std::string effects_text(const ModelEffects& effects) {
  std::vector<std::string> titles;
  for (const diagnosis::AddedEffect& effect : effects.added) {
    titles.push_back(effect.meter.empty() ? fmt::format("'{}'", effect.title)
                                          : fmt::format("'{}' ({})", effect.title, effect.meter));
  }
  return fmt::format("The model has the effect{} {}, which a diagnosis added. ",
                     titles.size() == 1 ? "" : "s", fmt::join(titles, " and "));
}

/// (calibration months) whether each may teach all effects.
std::vector<bool> teaching_months(const SiteCalibration& site, std::size_t months) {
  std::vector<bool> teaches(months);
  for (std::size_t i = 0; i < months; ++i) {
    teaches[i] = std::ranges::all_of(
        site.effects->added, [&](const auto& effect) { return may_teach(effect, site.months[i]); });
  }
  return teaches;
}

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

/// `count` of the rows, equally spaced.
Eigen::MatrixXd some_rows(const Eigen::MatrixXd& rows, int count) {
  return rows(calibration::equally_spaced(static_cast<int>(rows.rows()), count), Eigen::all);
}

/// η as the later months alone move it.
/// @return draws of η; or what a calibration on so few months finds.
Result<Eigen::MatrixXd> taught_by_later_months(const PreparedSite& prepared, Eigen::Index r,
                                               const std::vector<bool>& teaches,
                                               const CalibrateOptions& options,
                                               const calibration::RunContext& context) {
  CalibrationProblem later = prepared.problem;
  for (calibration::OutputMeasurements& output : later.outputs) {
    for (std::size_t i = 0; i < teaches.size(); ++i) {
      if (!teaches[i]) output.values[i] = kAbsent;
    }
  }
  const auto learnt = calibration::calibrate(*prepared.model, later, options.calibration, context);
  if (!learnt) return tl::unexpected(learnt.error());
  // Whoever gives a number of draws gets what they find.
  if (!learnt->converged && !options.calibration.sampling.iterations) {
    return failure(ErrorCode::not_enough_data, "the chains on them alone do not agree");
  }
  return Eigen::MatrixXd{some_rows(learnt->thinned.theta, kEtaValues).rightCols(r)};
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
void summarise(std::size_t q, const CalibrateOptions& options,
               const calibration::RunContext& context, SiteCalibration& result) {
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
       calibration::gate_findings(judged, options.calibration.sampling.gate)) {
    c.converged = false;
    result.warnings.push_back(finding.sentence);
  }
  c.posterior_mean.resize(static_cast<Eigen::Index>(c.parameters.size()));
  for (std::size_t j = 0; j < c.parameters.size(); ++j) {
    c.posterior_mean[static_cast<Eigen::Index>(j)] = c.parameters[j].mean;
  }
  c.thinned = calibration::thin(c.chains, options.calibration.thinned_draws);
}

/// What speaks of θ alone gets its place for η: the cut asks nothing of η and no belief moves it.
void make_room_for_eta(std::size_t q, SiteCalibration& result) {
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
void take_over(CutDraws cut, const CutOptions& how, const CalibrateOptions& options,
               const calibration::RunContext& context, SiteCalibration& result) {
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

Result<void> calibrate_given(const Eigen::MatrixXd& eta, PreparedSite& prepared,
                             const CalibrateOptions& options,
                             const calibration::RunContext& context, SiteCalibration& result) {
  const std::size_t q = result.parameters.size() - result.effects->parameters.size();
  const Eigen::RowVectorXd mean = eta.colwise().mean();
  const FixedParametersModel at_mean = with_eta(*prepared.model, q, {mean.begin(), mean.end()});
  CalibrationProblem problem = theta_alone(prepared.problem, q);
  auto design = calibration::run_design(at_mean, problem, options.calibration.design_runs, context);
  if (!design) return tl::unexpected(design.error());
  assessment::set_aside_unresponsive(*design, result, problem);
  if (auto done = assessment::calibrate_into(at_mean, problem, options.calibration,
                                             options.prior_sensitivity, std::move(*design), context,
                                             result);
      !done) {
    return done;
  }
  const CutOptions how = cut_options(options.calibration.sampling, eta.rows());
  auto cut = calibration::sample_given_eta(*prepared.model, result.calibration, problem, eta, how,
                                           context);
  if (!cut) return tl::unexpected(cut.error());
  take_over(std::move(*cut), how, options, context, result);
  return {};
}

}  // namespace

Result<void> calibrate_with_effects(PreparedSite& prepared, const CalibrateOptions& options,
                                    const calibration::RunContext& context,
                                    SiteCalibration& result) {
  const std::vector<bool> teaches = teaching_months(result, prepared.problem.month_names.size());
  const std::string has = effects_text(*result.effects);
  if (std::ranges::all_of(teaches, std::identity{})) {
    result.warnings.push_back(has +
                              "All months here are later than those that it was learnt from, so "
                              "what was learnt is the prior of its parameters, and these months "
                              "teach them further.");
    return calibrate_all(prepared, options, context, result);
  }
  Eigen::MatrixXd eta = some_rows(result.effects->draws, kEtaValues);
  std::string how = "It was learnt from the months here";
  if (std::ranges::any_of(teaches, std::identity{})) {
    auto taught = taught_by_later_months(prepared, eta.cols(), teaches, options, context);
    if (taught) {
      eta = std::move(*taught);
      how =
          "It was learnt from some of the months here; the later ones alone were let teach it "
          "further";
    } else if (taught.error().code == ErrorCode::cancelled) {
      return tl::unexpected(taught.error());
    } else {
      how =
          "It was learnt from some of the months here, and the later ones cannot teach it further "
          "(" +
          taught.error().message + ")";
    }
  }
  result.warnings.push_back(
      fmt::format("{}{}, so its parameters are not calibrated on them again: the others are drawn "
                  "given each of {} draws of them.",
                  has, how, eta.rows()));
  return calibrate_given(eta, prepared, options, context, result);
}

}  // namespace recald::daemon
