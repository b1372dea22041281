#include "core/screening/screen.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/regression/folds.hpp"
#include "core/regression/least_squares.hpp"

namespace recald::screening {
namespace {

using regression::DesignData;

// Share of an output's variance that may be lost when its months are replaced by fewer directions.
constexpr double kVarianceLost = 1e-6;
// Share of its squares below which what an output does over the runs is rounding.
constexpr double kNoSpread = 1e-20;

/// Standardised columns: parameters first, then the squares of their standardised values, freed of
/// the straight part. A parameter of only two values has no square: its column stays zero.
Eigen::MatrixXd candidate_columns(const Eigen::MatrixXd& theta) {
  const Eigen::Index q = theta.cols();
  const auto n = static_cast<double>(theta.rows());
  Eigen::MatrixXd columns(theta.rows(), 2 * q);
  const auto standardise = [n](Eigen::VectorXd column) -> Eigen::VectorXd {
    column.array() -= column.mean();
    const double sd = column.norm() / std::sqrt(n);
    return sd > 1e-9 ? Eigen::VectorXd(column / sd) : Eigen::VectorXd::Zero(column.size());
  };
  for (Eigen::Index j = 0; j < q; ++j) {
    const Eigen::VectorXd straight = standardise(theta.col(j));
    Eigen::VectorXd square = straight.cwiseAbs2();
    square.array() -= square.mean();
    square -= square.dot(straight) / n * straight;
    columns.col(j) = straight;
    columns.col(q + j) = standardise(std::move(square));
  }
  return columns;
}

/// Months turned to their principal directions, fewer of them. Turning changes neither squared
/// errors nor the length of a row of coefficients, so the lasso cannot tell.
Eigen::MatrixXd principal_directions(const Eigen::MatrixXd& months) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(months.transpose() * months);
  const Eigen::VectorXd& variance = eigen.eigenvalues();  // ascending
  Eigen::Index lost = 0;
  double sum = 0.0;
  while (lost + 1 < variance.size() && sum + variance(lost) <= kVarianceLost * variance.sum()) {
    sum += variance(lost++);
  }
  return months * eigen.eigenvectors().rightCols(variance.size() - lost);
}

/// One output's lasso with what it found of each parameter.
struct OutputScreening {
  ScreenedOutput output;
  std::vector<ParameterEffect> effects;  ///< (parameters)
};

class OutputScreen {
 public:
  OutputScreen(const Eigen::MatrixXd& columns, const ScreenOptions& options)
      : columns_(columns), parameters_(columns.cols() / 2), options_(options) {}

  /// @param months  (runs x months) normalised.
  /// @param unit    Range of the output: 1 on the normalised scale.
  Result<OutputScreening> run(const std::string& name, const Eigen::MatrixXd& months, double unit,
                              const regression::RunFolds& folds, Rng& rng) const {
    const Eigen::MatrixXd centred = months.rowwise() - months.colwise().mean();
    if (centred.squaredNorm() <= kNoSpread * months.squaredNorm()) return unmoved(name);
    const Eigen::MatrixXd response = principal_directions(centred);
    std::vector<int> runs(static_cast<std::size_t>(months.rows()));
    std::iota(runs.begin(), runs.end(), 0);
    const auto products = fold_products(columns_, response, runs, folds);
    const auto validation = cross_validate_lasso(products, options_.lasso);
    if (!validation) return about(name, validation.error());
    const double penalty = validation->path.penalties(validation->chosen);
    const auto halves =
        select_on_halves(columns_, response, penalty, rng, options_.stability, options_.lasso);
    if (!halves) return about(name, halves.error());

    const LassoFit& chosen = validation->path.fits[static_cast<std::size_t>(validation->chosen)];
    auto effects = measure_effects(chosen, centred, unit);
    if (!effects) return about(name, effects.error());
    OutputScreening result{{name, penalty, validation->path.penalties(validation->best), 0,
                            1.0 - validation->error(validation->chosen) *
                                      static_cast<double>(centred.rows()) / centred.squaredNorm()},
                           std::move(*effects)};
    for (Eigen::Index j = 0; j < parameters_; ++j) {
      ParameterEffect& effect = result.effects[static_cast<std::size_t>(j)];
      effect.selected = chosen.selects(j) || chosen.selects(parameters_ + j);
      effect.frequency = halves->col(j).cwiseMax(halves->col(parameters_ + j)).mean();
      result.output.selected += effect.selected ? 1 : 0;
    }
    return result;
  }

 private:
  /// Of an output that only the weather moves.
  [[nodiscard]] OutputScreening unmoved(const std::string& name) const {
    return {
        {name, 0.0, 0.0, 0, 0.0},
        {static_cast<std::size_t>(parameters_), ParameterEffect{false, 0.0, 0.0, 0.0, 0.0, 0.0}}};
  }

  static tl::unexpected<Error> about(const std::string& name, const Error& error) {
    return failure(error.code, "output '" + name + "': " + error.message);
  }

  /// Least squares on the selected columns; the others against what these leave.
  Result<std::vector<ParameterEffect>> measure_effects(const LassoFit& chosen,
                                                       const Eigen::MatrixXd& centred,
                                                       double unit) const {
    std::vector<int> selected;
    for (Eigen::Index j = 0; j < columns_.cols(); ++j) {
      if (chosen.selects(j)) selected.push_back(static_cast<int>(j));
    }
    const auto fit = TRY(regression::fit_least_squares(
        regression::centre(regression::cross_products(columns_, centred)), selected));
    const auto runs = static_cast<double>(columns_.rows());
    const Eigen::MatrixXd left = centred - columns_(Eigen::all, selected) * fit.coefficients;
    Eigen::MatrixXd slopes = columns_.transpose() * left / runs;
    slopes(selected, Eigen::all) = fit.coefficients;

    const double variance = centred.squaredNorm() / runs;
    std::vector<ParameterEffect> effects;
    for (Eigen::Index j = 0; j < parameters_; ++j) {
      const auto straight = slopes.row(j);
      const double squares = straight.squaredNorm() + slopes.row(parameters_ + j).squaredNorm();
      effects.push_back({false, 0.0, squares / variance, unit * straight.mean(),
                         unit * straight.minCoeff(), unit * straight.maxCoeff()});
    }
    return effects;
  }

  const Eigen::MatrixXd& columns_;
  Eigen::Index parameters_;
  const ScreenOptions& options_;
};

/// The union over outputs.
void evaluate(ScreenedParameter& parameter, const ScreenOptions& options) {
  parameter.verdict = Verdict::not_detected;
  for (std::size_t k = 0; k < parameter.effects.size(); ++k) {
    const ParameterEffect& effect = parameter.effects[k];
    if (effect.share > parameter.share) {
      parameter.share = effect.share;
      parameter.strongest_output = static_cast<int>(k);
    }
    const bool frequent = effect.frequency >= options.frequency_min;
    if ((effect.selected || frequent) && parameter.verdict == Verdict::not_detected) {
      parameter.verdict = Verdict::minor;
    }
    if (frequent && effect.share >= options.share_min) parameter.verdict = Verdict::influential;
  }
  for (const ParameterEffect& effect : parameter.effects) {
    const bool counts =
        parameter.verdict != Verdict::influential || effect.share >= options.share_min;
    if (counts) parameter.frequency = std::max(parameter.frequency, effect.frequency);
  }
}

}  // namespace

std::vector<std::string> Screening::influential() const {
  std::vector<const ScreenedParameter*> found;
  for (const ScreenedParameter& parameter : parameters) {
    if (parameter.verdict == Verdict::influential) found.push_back(&parameter);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto* a, const auto* b) { return a->share > b->share; });
  std::vector<std::string> names;
  for (const ScreenedParameter* parameter : found) names.push_back(parameter->name);
  return names;
}

Result<Screening> screen(const DesignData& design, const ScreenOptions& options, Rng& rng) {
  TRY(regression::check_design(design));
  const Eigen::MatrixXd columns = candidate_columns(design.theta);
  const OutputScreen output_screen(columns, options);
  const std::vector<regression::ColumnScale> scales = regression::output_scales(design);
  const regression::RunFolds folds(static_cast<int>(design.runs()), options.folds, rng);

  Screening screening;
  for (const std::string& name : design.parameters) {
    screening.parameters.push_back({name, Verdict::not_detected, 0.0, 0.0, 0, {}});
  }
  for (std::size_t k = 0; k < design.outputs.size(); ++k) {
    const auto output = design.output(static_cast<Eigen::Index>(k));
    const Eigen::MatrixXd normalised = (output.array() - scales[k].min) / scales[k].range();
    auto result =
        TRY(output_screen.run(design.outputs[k], normalised, scales[k].range(), folds, rng));
    screening.outputs.push_back(std::move(result.output));
    for (std::size_t j = 0; j < result.effects.size(); ++j) {
      screening.parameters[j].effects.push_back(result.effects[j]);
    }
  }
  for (ScreenedParameter& parameter : screening.parameters) evaluate(parameter, options);
  return screening;
}

}  // namespace recald::screening
