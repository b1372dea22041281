/// Least squares through a bend at zero: loads that stop where nothing is needed.
#pragma once

#include <Eigen/Core>

namespace recald::regression {

/// y = E[max(0, z + width e)], z = intercept + x' coefficients (statistics/rectified_mean.hpp).
/// A month's load is a mean of hours, some of which need nothing: a polynomial of the parameters
/// describes what the hours would take, and the bend what they do.
struct RectifiedFit {
  double width = 0.0;  ///< In y's unit; 0: no bend, y = z.
  double intercept = 0.0;
  Eigen::VectorXd coefficients;   ///< (k)
  double left_out_squares = 0.0;  ///< Of each row predicted without it, to first order.

  /// @param columns  (rows x k) @return (rows)
  [[nodiscard]] Eigen::VectorXd predict(const Eigen::MatrixXd& columns) const;
};

/// By Gauss and Newton from the inverted response; a straight line where `width` is 0.
/// @param columns   (rows x k), rows > k + 1.
/// @param response  (rows) never negative where width > 0.
[[nodiscard]] RectifiedFit fit_rectified(const Eigen::MatrixXd& columns,
                                         const Eigen::VectorXd& response, double width);

/// The width, or none, that predicts left-out rows best. A bend has to leave a fifth less of the
/// squares, of rows left out one at a time and by fifths.
[[nodiscard]] RectifiedFit choose_rectified(const Eigen::MatrixXd& columns,
                                            const Eigen::VectorXd& response);

}  // namespace recald::regression
