#include "core/statistics/minimise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace recald {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNothing = 1e-3;       // less than this is no gain
constexpr double kLongestStep = 2.0;    // of one variable; the first directions are guesses
constexpr double kShareOfSlope = 1e-4;  // Armijo's
constexpr int kMostHalvings = 30;

/// Broyden's, Fletcher's, Goldfarb's and Shanno's update of an inverse Hessian.
void update(MatrixXd& inverse_hessian, const VectorXd& step, const VectorXd& change) {
  const double curvature = step.dot(change);
  if (curvature <= 1e-12 * step.norm() * change.norm()) return;
  const VectorXd bent = inverse_hessian * change;
  inverse_hessian += ((1.0 + change.dot(bent) / curvature) / curvature) * step * step.transpose() -
                     (bent * step.transpose() + step * bent.transpose()) / curvature;
}

}  // namespace

VectorXd minimise(const SmoothFunction& function, VectorXd x) {
  const Eigen::Index n = x.size();
  VectorXd gradient(n);
  double value = function(x, gradient);
  if (!std::isfinite(value)) return x;
  MatrixXd inverse_hessian = MatrixXd::Identity(n, n) / std::max(1.0, gradient.norm());
  VectorXd next_gradient(n);
  for (int i = 0; i < kMostSteps; ++i) {
    VectorXd step = -inverse_hessian * gradient;
    if (step.dot(gradient) >= 0.0) step = -gradient;  // rounding has spoilt the Hessian
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    if (-step.dot(gradient) < kNothing) break;
    double gain = 0.0;
    for (int halving = 0; halving < kMostHalvings; ++halving, step *= 0.5) {
      const VectorXd next = x + step;
      const double next_value = function(next, next_gradient);
      if (!(next_value <= value + kShareOfSlope * step.dot(gradient))) continue;
      gain = value - next_value;
      update(inverse_hessian, step, next_gradient - gradient);
      x = next;
      value = next_value;
      std::swap(gradient, next_gradient);
      break;
    }
    if (gain < kNothing) break;
  }
  return x;
}

}  // namespace recald
