#include "core/regression/monthly_form.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "core/regression/cross_products.hpp"
#include "core/regression/folds.hpp"
#include "core/regression/rectified_fit.hpp"
#include "core/statistics/rectified_mean.hpp"

namespace recald::regression {
namespace {

/// (runs x terms)
Eigen::MatrixXd term_columns(const Eigen::MatrixXd& theta, std::span<const Term> terms) {
  Eigen::MatrixXd columns(theta.rows(), static_cast<Eigen::Index>(terms.size()));
  for (std::size_t j = 0; j < terms.size(); ++j) {
    auto column = columns.col(static_cast<Eigen::Index>(j));
    column = theta.col(terms[j].first);
    if (!terms[j].is_main_effect()) column.array() *= theta.col(terms[j].second).array();
  }
  return columns;
}

/// What one output's months are regressed with: the candidates, and how to choose among them.
struct Candidates {
  std::vector<Term> terms;
  std::vector<Parents> parents;
  StepwiseOptions options;

  /// @param products  All months of all outputs as responses.
  [[nodiscard]] Result<StepwiseFit> choose(const CentredProducts& products, Eigen::Index first,
                                           Eigen::Index months) const {
    return stepwise(some_responses(products, first, months), parents, options);
  }
};

Candidates make_candidates(int parameters, Criterion criterion) {
  Candidates candidates{all_terms(parameters, true), {}, {}};
  candidates.parents = parents_of(candidates.terms);
  candidates.options.criterion = criterion;
  candidates.options.start = StepwiseOptions::Start::empty;
  return candidates;
}

/// One output's months on its chosen terms, with a bend where it helps.
/// @param y       (rows x months) On the normalised scale.
/// @param zero    What nothing is on that scale.
/// @param widths  (months) Of the bends; null: to be chosen.
MonthlyFormOutput output_fit(const StepwiseFit& straight, const std::vector<Term>& candidates,
                             const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, double zero,
                             const Eigen::VectorXd* widths) {
  MonthlyFormOutput output{.terms = {},
                           .intercepts = straight.intercepts,
                           .widths = Eigen::VectorXd::Zero(y.cols()),
                           .coefficients = straight.coefficients};
  for (const int column : straight.columns) {
    output.terms.push_back(candidates[static_cast<std::size_t>(column)]);
  }
  const Eigen::MatrixXd used = x(Eigen::all, straight.columns);
  for (Eigen::Index month = 0; month < y.cols(); ++month) {
    if (widths != nullptr && (*widths)(month) == 0.0) continue;
    const Eigen::VectorXd load = y.col(month).array() - zero;
    const RectifiedFit bent = widths == nullptr ? choose_rectified(used, load)
                                                : fit_rectified(used, load, (*widths)(month));
    if (bent.width == 0.0) continue;
    output.widths(month) = bent.width;
    output.intercepts(month) = bent.intercept + zero;
    output.coefficients.col(month) = bent.coefficients;
  }
  return output;
}

/// (rows of x x months)
Eigen::MatrixXd predict(const Eigen::MatrixXd& x, const std::vector<int>& columns,
                        const MonthlyFormOutput& fit, double zero) {
  Eigen::MatrixXd y =
      (x(Eigen::all, columns) * fit.coefficients).rowwise() + fit.intercepts.transpose();
  for (Eigen::Index month = 0; month < y.cols(); ++month) {
    const double width = fit.widths(month);
    if (width == 0.0) continue;
    for (double& value : y.col(month)) value = zero + rectified_mean(value - zero, width);
  }
  return y;
}

/// @param out  Ascending.
std::vector<int> rows_without(const std::vector<int>& out, Eigen::Index count) {
  std::vector<int> rows;
  for (int row = 0; row < count; ++row) {
    if (!std::ranges::binary_search(out, row)) rows.push_back(row);
  }
  return rows;
}

/// Predictions of all outputs for the runs of each fold by fits that have not seen them.
/// @param fits   Of all runs: which months have a bend, and how wide.
/// @param zeros  (outputs) What nothing is on the normalised scales.
Result<Eigen::MatrixXd> predict_left_out(const Candidates& candidates, const Eigen::MatrixXd& x,
                                         const Eigen::MatrixXd& y, const CrossProducts& total,
                                         const std::vector<MonthlyFormOutput>& fits,
                                         const std::vector<double>& zeros, const RunFolds& folds) {
  const Eigen::Index months = y.cols() / std::ssize(fits);
  Eigen::MatrixXd left_out(y.rows(), y.cols());
  for (int f = 0; f < folds.count(); ++f) {
    const std::vector<int> out(folds.left_out(f).begin(), folds.left_out(f).end());
    const std::vector<int> kept_rows = rows_without(out, y.rows());
    const Eigen::MatrixXd x_out = x(out, Eigen::all);
    CrossProducts kept = total;
    kept -= cross_products(x_out, y(out, Eigen::all));
    const CentredProducts centred = centre(kept);
    for (Eigen::Index first = 0; first < y.cols(); first += months) {
      const auto k = static_cast<std::size_t>(first / months);
      const auto straight = candidates.choose(centred, first, months);
      if (!straight) return tl::unexpected(straight.error());
      const auto of_output = Eigen::seqN(first, months);
      const MonthlyFormOutput fit =
          output_fit(*straight, candidates.terms, x(kept_rows, Eigen::all), y(kept_rows, of_output),
                     zeros[k], &fits[k].widths);
      left_out(out, of_output) = predict(x_out, straight->columns, fit, zeros[k]);
    }
  }
  return left_out;
}

}  // namespace

Result<MonthlyForm> fit_monthly_form(const DesignData& design, const MonthlyFormOptions& options,
                                     Rng& rng) {
  if (auto good = check_design(design); !good) return tl::unexpected(std::move(good.error()));
  MonthlyForm form;
  form.parameters = design.parameters;
  form.caps = design.caps;
  const Eigen::MatrixXd theta = capped(design.theta, design.caps);
  form.parameter_scales = column_scales(theta);
  form.months = design.months;
  form.outputs = design.outputs;
  form.output_scales = output_scales(design);

  const Candidates candidates =
      make_candidates(static_cast<int>(design.parameters.size()), options.criterion);
  form.candidates = static_cast<int>(candidates.terms.size());
  const Eigen::MatrixXd x =
      term_columns(scale_columns(theta, form.parameter_scales), candidates.terms);
  const Eigen::MatrixXd y = normalise_outputs(design, form.output_scales);
  const Eigen::Index months = design.month_count();
  const CrossProducts total = cross_products(x, y);
  const CentredProducts centred = centre(total);

  std::vector<double> zeros;
  for (const ColumnScale& scale : form.output_scales) zeros.push_back(scale.scale(0.0));
  Eigen::MatrixXd fitted(y.rows(), y.cols());
  for (std::size_t k = 0; k < zeros.size(); ++k) {
    const Eigen::Index first = static_cast<Eigen::Index>(k) * months;
    const auto straight = candidates.choose(centred, first, months);
    if (!straight) return tl::unexpected(straight.error());
    form.fits.push_back(
        output_fit(*straight, candidates.terms, x, y.middleCols(first, months), zeros[k], nullptr));
    fitted.middleCols(first, months) = predict(x, straight->columns, form.fits.back(), zeros[k]);
  }
  const RunFolds folds(static_cast<int>(design.runs()), options.folds, rng);
  const auto left_out = predict_left_out(candidates, x, y, total, form.fits, zeros, folds);
  if (!left_out) return tl::unexpected(left_out.error());
  form.quality = assess_fit(design, form.output_scales, fitted, *left_out);
  return form;
}

}  // namespace recald::regression
