#include "core/regression/least_squares.hpp"

#include <Eigen/Cholesky>
#include <vector>

namespace recald::regression {

Result<LeastSquaresFit> fit_least_squares(const CentredProducts& products,
                                          std::span<const int> columns) {
  const std::vector<int> chosen(columns.begin(), columns.end());
  const Eigen::MatrixXd xy = products.xy(chosen, Eigen::all);
  // Columns of unit length: a pivot then is the share that the columns before it leave free.
  const Eigen::VectorXd length = products.xx.diagonal()(chosen).cwiseSqrt();
  if (length.size() > 0 && !(length.minCoeff() > 0.0)) {
    return failure(ErrorCode::not_positive_definite,
                   "a column of the regression has no spread; leave it out");
  }
  const Eigen::VectorXd scale = length.cwiseInverse();
  const Eigen::MatrixXd correlation =
      scale.asDiagonal() * products.xx(chosen, chosen) * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(correlation);
  if (factor.info() != Eigen::Success) {
    return failure(ErrorCode::not_positive_definite,
                   "the columns of the regression determine each other; leave one of them out");
  }

  LeastSquaresFit fit;
  fit.coefficients = scale.asDiagonal() * factor.solve(scale.asDiagonal() * xy);
  fit.intercepts =
      products.y_mean - fit.coefficients.transpose() * products.x_mean(chosen, Eigen::all);
  fit.residual_squares =
      (products.yy - (fit.coefficients.array() * xy.array()).colwise().sum().transpose().matrix())
          .cwiseMax(0.0);
  return fit;
}

}  // namespace recald::regression
