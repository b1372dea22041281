#include "core/screening/cross_validation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace recald::screening {
namespace {

using regression::CrossProducts;

/// Sum of squared errors of a fit on the rows behind `products`, all responses.
class LeftOutError {
 public:
  LeftOutError(const CrossProducts& products, const StandardisedProducts& training)
      : training_(training) {
    // About the training means, where the fit's intercept is zero.
    const Eigen::VectorXd& x = training.x_mean;
    const Eigen::VectorXd& y = training.y_mean;
    xx_ = products.xx;
    xx_.noalias() -= x * products.x_sum.transpose();
    xx_.noalias() -= products.x_sum * x.transpose();
    xx_.noalias() += products.rows * x * x.transpose();
    xy_ = products.xy;
    xy_.noalias() -= x * products.y_sum.transpose();
    xy_.noalias() -= products.x_sum * y.transpose();
    xy_.noalias() += products.rows * x * y.transpose();
    yy_ = products.yy.sum() - 2.0 * y.dot(products.y_sum) + products.rows * y.squaredNorm();
  }

  [[nodiscard]] double operator()(const LassoFit& fit) const {
    std::vector<Eigen::Index> selected;
    for (Eigen::Index j = 0; j < fit.coefficients.rows(); ++j) {
      if (fit.selects(j)) selected.push_back(j);
    }
    const Eigen::MatrixXd b = training_.x_sd(selected).cwiseInverse().asDiagonal() *
                              fit.coefficients(selected, Eigen::all);
    const Eigen::MatrixXd explained = xx_(selected, selected) * b;
    return yy_ + (b.array() * (explained - 2.0 * xy_(selected, Eigen::all)).array()).sum();
  }

 private:
  const StandardisedProducts& training_;
  Eigen::MatrixXd xx_;
  Eigen::MatrixXd xy_;
  double yy_;
};

/// Weighted mean and its standard error over the folds, and the one-standard-error choice.
void summarise(const Eigen::MatrixXd& error, const Eigen::VectorXd& weight,
               LassoCrossValidation& result) {
  const Eigen::VectorXd share = weight / weight.sum();
  result.error = error * share;
  const Eigen::MatrixXd deviation = error.colwise() - result.error;
  const double folds = static_cast<double>(error.cols());
  result.standard_error = ((deviation.cwiseAbs2() * share).array() / (folds - 1.0)).sqrt().matrix();
  Eigen::Index best = 0;
  result.error.minCoeff(&best);
  const double limit = result.error(best) + result.standard_error(best);
  Eigen::Index chosen = 0;
  while (result.error(chosen) > limit) ++chosen;
  result.best = static_cast<int>(best);
  result.chosen = static_cast<int>(chosen);
}

}  // namespace

Result<LassoCrossValidation> cross_validate_lasso(std::span<const CrossProducts> folds,
                                                  const LassoOptions& options) {
  assert(folds.size() >= 2);
  CrossProducts total = folds[0];
  for (const CrossProducts& fold : folds.subspan(1)) total += fold;
  if (!total.xx.allFinite() || !total.xy.allFinite() || !total.yy.allFinite()) {
    return failure(ErrorCode::not_finite,
                   "a value of the regression is missing or infinite; check the design's inputs "
                   "and outputs");
  }
  const StandardisedProducts all(regression::centre(total));
  if (!(all.largest_penalty() > 0.0)) {
    return failure(ErrorCode::invalid_value,
                   "the outputs do not change with any parameter; there is nothing to select");
  }
  const Eigen::VectorXd penalties = penalty_grid(all, options);
  auto path = TRY(lasso_path(all, penalties, options));

  const auto count = static_cast<Eigen::Index>(folds.size());
  Eigen::MatrixXd error(penalties.size(), count);
  Eigen::VectorXd weight(count);
  for (Eigen::Index f = 0; f < count; ++f) {
    const CrossProducts& fold = folds[static_cast<std::size_t>(f)];
    CrossProducts kept = total;
    kept -= fold;
    const StandardisedProducts training(regression::centre(kept));
    const auto fold_path = TRY(lasso_path(training, penalties, options));
    const LeftOutError left_out(fold, training);
    for (Eigen::Index i = 0; i < penalties.size(); ++i) {
      error(i, f) = left_out(fold_path.fits[static_cast<std::size_t>(i)]) / fold.rows;
    }
    weight(f) = fold.rows;
  }
  LassoCrossValidation result{std::move(path), {}, {}, 0, 0};
  summarise(error, weight, result);
  return result;
}

std::vector<CrossProducts> fold_products(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
                                         std::span<const int> run_of_row,
                                         const regression::RunFolds& folds) {
  assert(x.rows() == y.rows() && x.rows() == static_cast<Eigen::Index>(run_of_row.size()));
  std::vector<int> fold_of_run;
  for (int f = 0; f < folds.count(); ++f) {
    for (const int run : folds.left_out(f)) {
      fold_of_run.resize(std::max(fold_of_run.size(), static_cast<std::size_t>(run) + 1), -1);
      fold_of_run[static_cast<std::size_t>(run)] = f;
    }
  }
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(folds.count()));
  for (std::size_t i = 0; i < run_of_row.size(); ++i) {
    const int fold = fold_of_run[static_cast<std::size_t>(run_of_row[i])];
    rows[static_cast<std::size_t>(fold)].push_back(static_cast<int>(i));
  }
  const Eigen::RowVectorXd x_mean = x.colwise().mean();
  const Eigen::RowVectorXd y_mean = y.colwise().mean();
  std::vector<CrossProducts> products;
  for (const std::vector<int>& of_fold : rows) {
    products.push_back(regression::cross_products(x(of_fold, Eigen::all).rowwise() - x_mean,
                                                  y(of_fold, Eigen::all).rowwise() - y_mean));
  }
  return products;
}

}  // namespace recald::screening
