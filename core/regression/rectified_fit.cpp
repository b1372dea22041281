#include "core/regression/rectified_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "core/statistics/rectified_mean.hpp"

namespace recald::regression {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Widths that are tried, over the response's standard deviation.
constexpr double kWidths[] = {4.0, 2.0, 1.0, 0.5, 0.25};
/// Of the left-out squares: what a bend that was not asked for has to leave at most.
constexpr double kBetterBy = 0.8;
constexpr Index kFolds = 5;
constexpr int kStepsMax = 25;
constexpr double kConverged = 1e-8;  // of the squares
/// Of the largest diagonal entry: rows far below zero say nothing of some coefficients.
constexpr double kRidge = 1e-8;
/// Least slope with which a row pulls at the first step.
constexpr double kLeastSlope = 0.02;

/// With an intercept in front.
MatrixXd with_intercept(const MatrixXd& columns) {
  MatrixXd x(columns.rows(), columns.cols() + 1);
  x << VectorXd::Ones(columns.rows()), columns;
  return x;
}

/// A weighted least-squares step, and what each row's residual is multiplied by when it is left
/// out.
struct Step {
  VectorXd solution;
  VectorXd leverage;  ///< (rows) only where asked for.
};
Step weighted(const MatrixXd& x, const VectorXd& slopes, const VectorXd& residual,
              bool with_leverage) {
  const MatrixXd jacobian = slopes.asDiagonal() * x;
  MatrixXd normal = jacobian.transpose() * jacobian;
  normal.diagonal().array() += kRidge * normal.diagonal().maxCoeff();
  const Eigen::LLT<MatrixXd> factor(normal);
  Step step{factor.solve(jacobian.transpose() * residual), {}};
  if (with_leverage) {
    step.leverage =
        factor.matrixL().solve(jacobian.transpose()).colwise().squaredNorm().transpose();
  }
  return step;
}

VectorXd mean_of(const VectorXd& z, double width) {
  return width == 0.0 ? z : z.unaryExpr([=](double one) { return rectified_mean(one, width); });
}

VectorXd slope_of(const VectorXd& z, double width) {
  if (width == 0.0) return VectorXd::Ones(z.size());
  return z.unaryExpr([=](double one) { return rectified_slope(one, width); });
}

double left_out_squares(const MatrixXd& x, const VectorXd& z, const VectorXd& residual,
                        double width) {
  const Step step = weighted(x, slope_of(z, width), residual, true);
  return (residual.array() / (1.0 - step.leverage.array().min(0.99))).square().sum();
}

/// Squares of rows that the fit has not seen, a fifth of them at a time. To first order is not
/// enough here: what lies below zero is held by few rows, and without one of them may go anywhere.
double left_out_by_folds(const MatrixXd& columns, const VectorXd& response, double width) {
  double squares = 0.0;
  for (Index fold = 0; fold < kFolds; ++fold) {
    std::vector<Index> kept;
    std::vector<Index> out;
    for (Index row = 0; row < columns.rows(); ++row) {
      (row % kFolds == fold ? out : kept).push_back(row);
    }
    const RectifiedFit fit = fit_rectified(columns(kept, Eigen::all), response(kept), width);
    squares += (response(out) - fit.predict(columns(out, Eigen::all))).squaredNorm();
  }
  return squares;
}

}  // namespace

VectorXd RectifiedFit::predict(const MatrixXd& columns) const {
  return mean_of((columns * coefficients).array() + intercept, width);
}

RectifiedFit fit_rectified(const MatrixXd& columns, const VectorXd& response, double width) {
  assert(columns.rows() == response.size() && columns.rows() > columns.cols() + 1);
  const MatrixXd x = with_intercept(columns);
  VectorXd b;
  if (width == 0.0) {
    b = weighted(x, VectorXd::Ones(x.rows()), response, false).solution;
  } else {
    const VectorXd z = response.unaryExpr([=](double y) { return rectified_inverse(y, width); });
    const VectorXd slopes = slope_of(z, width).cwiseMax(kLeastSlope);
    b = weighted(x, slopes, slopes.cwiseProduct(z), false).solution;
  }
  double squares = (response - mean_of(x * b, width)).squaredNorm();
  for (int i = 0; width > 0.0 && i < kStepsMax; ++i) {
    const VectorXd z = x * b;
    const VectorXd step =
        weighted(x, slope_of(z, width), response - mean_of(z, width), false).solution;
    double part = 1.0;
    double next = (response - mean_of(x * (b + step), width)).squaredNorm();
    while (next > squares && part > 1e-3) {
      part *= 0.5;
      next = (response - mean_of(x * (b + part * step), width)).squaredNorm();
    }
    if (!(next < squares)) break;
    b += part * step;
    const bool is_done = squares - next < kConverged * squares;
    squares = next;
    if (is_done) break;
  }
  const VectorXd z = x * b;
  return {width, b(0), b.tail(b.size() - 1),
          left_out_squares(x, z, response - mean_of(z, width), width)};
}

RectifiedFit choose_rectified(const MatrixXd& columns, const VectorXd& response) {
  RectifiedFit best = fit_rectified(columns, response, 0.0);
  if (response.minCoeff() < 0.0) return best;
  const double sd = std::sqrt((response.array() - response.mean()).square().mean());
  if (!(sd > 0.0)) return best;
  const bool has_rows_to_spare = columns.rows() * (kFolds - 1) > kFolds * (columns.cols() + 2);
  if (!has_rows_to_spare) return best;
  const RectifiedFit straight = best;
  double to_beat = kBetterBy * best.left_out_squares;
  for (const double width : kWidths) {
    RectifiedFit fit = fit_rectified(columns, response, width * sd);
    if (!(fit.left_out_squares < to_beat)) continue;
    to_beat = fit.left_out_squares;
    best = std::move(fit);
  }
  if (best.width == 0.0) return straight;
  const bool holds = left_out_by_folds(columns, response, best.width) <
                     kBetterBy * left_out_by_folds(columns, response, 0.0);
  return holds ? best : straight;
}

}  // namespace recald::regression
