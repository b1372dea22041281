#include "core/calibration/covariance/conditional.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

namespace recald::calibration {

ConditionalNormal condition(const Eigen::MatrixXd& precision, const Eigen::VectorXd& residual,
                            const Eigen::VectorXd& weighted_residual,
                            const std::vector<Eigen::Index>& asked) {
  const auto count = static_cast<Eigen::Index>(asked.size());
  const Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd{precision(asked, asked)});
  return {residual(asked) - factor.solve(Eigen::VectorXd{weighted_residual(asked)}),
          factor.solve(Eigen::MatrixXd::Identity(count, count))};
}

double log_density_given_others(const Eigen::MatrixXd& precision,
                                const Eigen::VectorXd& weighted_residual,
                                const std::vector<Eigen::Index>& asked) {
  const Eigen::VectorXd alpha = weighted_residual(asked);
  const Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd{precision(asked, asked)});
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  const auto size = static_cast<double>(asked.size());
  return 0.5 * (log_determinant - alpha.dot(factor.solve(alpha)) -
                size * std::log(2.0 * std::numbers::pi));
}

}  // namespace recald::calibration
