#include "core/regression/monthly_form.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "core/regression/cross_products.hpp"
#include "core/regression/folds.hpp"

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

/// (rows of x x months)
Eigen::MatrixXd predict(const Eigen::MatrixXd& x, const StepwiseFit& fit) {
  return (x(Eigen::all, fit.columns) * fit.coefficients).rowwise() + fit.intercepts.transpose();
}

MonthlyFormOutput output_fit(const StepwiseFit& fit, const std::vector<Term>& candidates) {
  MonthlyFormOutput output{{}, fit.intercepts, fit.coefficients};
  for (const int column : fit.columns) {
    output.terms.push_back(candidates[static_cast<std::size_t>(column)]);
  }
  return output;
}

/// Predictions of all outputs for the runs of each fold by fits that have not seen them.
Result<Eigen::MatrixXd> predict_left_out(const Candidates& candidates, const Eigen::MatrixXd& x,
                                         const Eigen::MatrixXd& y, const CrossProducts& total,
                                         Eigen::Index months, const RunFolds& folds) {
  Eigen::MatrixXd left_out(y.rows(), y.cols());
  for (int f = 0; f < folds.count(); ++f) {
    const std::vector<int> out(folds.left_out(f).begin(), folds.left_out(f).end());
    const Eigen::MatrixXd x_out = x(out, Eigen::all);
    CrossProducts kept = total;
    kept -= cross_products(x_out, y(out, Eigen::all));
    const CentredProducts centred = centre(kept);
    for (Eigen::Index first = 0; first < y.cols(); first += months) {
      const auto fit = candidates.choose(centred, first, months);
      if (!fit) return tl::unexpected(fit.error());
      left_out(out, Eigen::seqN(first, months)) = predict(x_out, *fit);
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
  form.parameter_scales = column_scales(design.theta);
  form.months = design.months;
  form.outputs = design.outputs;
  form.output_scales = output_scales(design);

  const Candidates candidates =
      make_candidates(static_cast<int>(design.parameters.size()), options.criterion);
  form.candidates = static_cast<int>(candidates.terms.size());
  const Eigen::MatrixXd x =
      term_columns(scale_columns(design.theta, form.parameter_scales), candidates.terms);
  const Eigen::MatrixXd y = normalise_outputs(design, form.output_scales);
  const Eigen::Index months = design.month_count();
  const CrossProducts total = cross_products(x, y);
  const CentredProducts centred = centre(total);

  Eigen::MatrixXd fitted(y.rows(), y.cols());
  for (Eigen::Index first = 0; first < y.cols(); first += months) {
    const auto fit = candidates.choose(centred, first, months);
    if (!fit) return tl::unexpected(fit.error());
    fitted.middleCols(first, months) = predict(x, *fit);
    form.fits.push_back(output_fit(*fit, candidates.terms));
  }
  const RunFolds folds(static_cast<int>(design.runs()), options.folds, rng);
  const auto left_out = predict_left_out(candidates, x, y, total, months, folds);
  if (!left_out) return tl::unexpected(left_out.error());
  form.quality = assess_fit(design, form.output_scales, fitted, *left_out);
  return form;
}

}  // namespace recald::regression
