#include "core/regression/long_form.hpp"

#include <cassert>
#include <numeric>

namespace recald::regression {
namespace {

/// Distinct products of columns, the constant first.
class FactorTable {
 public:
  explicit FactorTable(const Eigen::MatrixXd& columns) : columns_(columns) {
    factors_.push_back({-1, -1});
  }

  /// Column of the product of variables a and b; -1 leaves a factor out.
  Eigen::Index find_or_add(int a, int b) {
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      if (factors_[i] == Term{a, b}) return static_cast<Eigen::Index>(i);
    }
    factors_.push_back({a, b});
    return static_cast<Eigen::Index>(factors_.size()) - 1;
  }

  [[nodiscard]] Eigen::MatrixXd table() const {
    Eigen::MatrixXd table(columns_.rows(), static_cast<Eigen::Index>(factors_.size()));
    table.setOnes();
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      auto column = table.col(static_cast<Eigen::Index>(i));
      for (const int variable : {factors_[i].first, factors_[i].second}) {
        if (variable >= 0) column.array() *= columns_.col(variable).array();
      }
    }
    return table;
  }

 private:
  const Eigen::MatrixXd& columns_;
  std::vector<Term> factors_;
};

}  // namespace

LongForm::LongForm(const Eigen::MatrixXd& cells, const Eigen::MatrixXd& runs,
                   std::span<const Term> terms, Eigen::MatrixXd responses)
    : responses_(std::move(responses)) {
  assert(responses_.rows() == runs.rows() && responses_.cols() == cells.rows());
  const int cell_variables = static_cast<int>(cells.cols());
  FactorTable cell_table(cells);
  FactorTable run_table(runs);
  for (const Term& term : terms) {
    std::vector<int> of_cell;
    std::vector<int> of_run;
    for (const int variable : {term.first, term.second}) {
      if (variable < 0) continue;
      if (variable < cell_variables) {
        of_cell.push_back(variable);
      } else {
        of_run.push_back(variable - cell_variables);
      }
    }
    of_cell.resize(2, -1);
    of_run.resize(2, -1);
    terms_.push_back({cell_table.find_or_add(of_cell[0], of_cell[1]),
                      run_table.find_or_add(of_run[0], of_run[1])});
  }
  cell_factors_ = cell_table.table();
  run_factors_ = run_table.table();
  cell_products_ = cell_factors_.transpose() * cell_factors_;
}

CrossProducts LongForm::products() const {
  std::vector<int> all(static_cast<std::size_t>(responses_.rows()));
  std::iota(all.begin(), all.end(), 0);
  return products(all);
}

CrossProducts LongForm::products(std::span<const int> runs) const {
  const std::vector<int> chosen(runs.begin(), runs.end());
  const Eigen::MatrixXd v = run_factors_(chosen, Eigen::all);
  const Eigen::MatrixXd y = responses_(chosen, Eigen::all);
  Eigen::MatrixXd run_products = Eigen::MatrixXd::Zero(v.cols(), v.cols());
  run_products.selfadjointView<Eigen::Lower>().rankUpdate(v.transpose());
  run_products.triangularView<Eigen::StrictlyUpper>() = run_products.transpose();
  const Eigen::MatrixXd with_response = v.transpose() * (y * cell_factors_);

  const auto p = static_cast<Eigen::Index>(terms_.size());
  CrossProducts products;
  products.rows = static_cast<double>(y.size());
  products.x_sum.resize(p);
  products.xx.resize(p, p);
  products.xy.resize(p, 1);
  for (Eigen::Index j = 0; j < p; ++j) {
    const Factors& column = terms_[static_cast<std::size_t>(j)];
    // Factor 0 is the constant, so sums are products with it.
    products.x_sum(j) = cell_products_(0, column.cell) * run_products(0, column.run);
    products.xy(j, 0) = with_response(column.run, column.cell);
    for (Eigen::Index i = 0; i < p; ++i) {
      const Factors& row = terms_[static_cast<std::size_t>(i)];
      products.xx(i, j) = cell_products_(row.cell, column.cell) * run_products(row.run, column.run);
    }
  }
  products.y_sum = Eigen::VectorXd::Constant(1, y.sum());
  products.yy = Eigen::VectorXd::Constant(1, y.squaredNorm());
  return products;
}

Eigen::MatrixXd LongForm::predict(const StepwiseFit& fit, std::span<const int> runs) const {
  const std::vector<int> chosen(runs.begin(), runs.end());
  Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(run_factors_.cols(), cell_factors_.cols());
  coefficients(0, 0) = fit.intercepts(0);
  for (std::size_t i = 0; i < fit.columns.size(); ++i) {
    const Factors& term = terms_[static_cast<std::size_t>(fit.columns[i])];
    coefficients(term.run, term.cell) += fit.coefficients(static_cast<Eigen::Index>(i), 0);
  }
  return run_factors_(chosen, Eigen::all) * (coefficients * cell_factors_.transpose());
}

}  // namespace recald::regression
