#include "core/regression/gaussian_process.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/statistics/minimise.hpp"

namespace recald::regression {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A normal prior on a logarithm. They keep the search where the likelihood is flat, as it is for
/// parameters that do not matter.
struct LogPrior {
  double mean;
  double sd;
};
constexpr LogPrior kRelevance{-2.0, 2.0};
constexpr LogPrior kPolynomial{0.0, 4.0};
constexpr LogPrior kNoise{-9.0, 4.0};
/// Of the other parts, which keeps K well conditioned.
constexpr double kLeastNoise = 1e-9;

double least_noise(const Kernel& kernel) {
  return kLeastNoise * (1.0 + kernel.linear + kernel.quadratic);
}

/// (rows of a x rows of b) squared distances. @param relevance  (q)
MatrixXd squared_distances(const VectorXd& relevance, const MatrixXd& a, const MatrixXd& b) {
  const VectorXd root = relevance.cwiseSqrt();
  const MatrixXd p = a * root.asDiagonal();
  const MatrixXd q = b * root.asDiagonal();
  MatrixXd squares = -2.0 * p * q.transpose();
  squares.colwise() += p.rowwise().squaredNorm();
  squares.rowwise() += q.rowwise().squaredNorm().transpose();
  return squares.cwiseMax(0.0);
}

MatrixXd smooth_part(const Kernel& kernel, const MatrixXd& a, const MatrixXd& b) {
  return (-0.5 * squared_distances(kernel.relevance, a, b)).array().exp();
}

/// 1 + c . c'
MatrixXd linear_part(const MatrixXd& a, const MatrixXd& b) {
  return ((a.array() - 0.5).matrix() * (b.array() - 0.5).matrix().transpose()).array() + 1.0;
}

/// Minus the logarithm of likelihood and priors, of the logarithms (relevance, linear, quadratic,
/// noise).
class Unlikelihood {
 public:
  Unlikelihood(const MatrixXd& points, const VectorXd& response)
      : points_{points}, response_{response}, linear_{linear_part(points, points)} {}

  /// @param gradient  Set. @return infinite where K is singular.
  double operator()(const VectorXd& logs, VectorXd& gradient) const {
    const Index n = points_.rows();
    const Index q = points_.cols();
    const Kernel kernel = kernel_of(logs);
    const MatrixXd smooth = smooth_part(kernel, points_, points_);
    MatrixXd k = smooth + kernel.linear * linear_ + kernel.quadratic * linear_.cwiseAbs2();
    k.diagonal().array() += kernel.noise;
    const Eigen::LLT<MatrixXd> factor{k};
    if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    const MatrixXd inverse = factor.solve(MatrixXd::Identity(n, n));
    const VectorXd weights = inverse * response_;
    const auto count = static_cast<double>(n);
    const double variance = response_.dot(weights) / count;
    if (!(variance > 0.0)) return std::numeric_limits<double>::infinity();
    double value = 0.5 * count * std::log(variance) +
                   MatrixXd(factor.matrixL()).diagonal().array().log().sum();

    // d value / d K
    const MatrixXd slope = 0.5 * inverse - (0.5 / variance) * weights * weights.transpose();
    const MatrixXd of_smooth = slope.cwiseProduct(smooth);
    const VectorXd row_sums = of_smooth.rowwise().sum();
    gradient.resize(logs.size());
    const VectorXd crossed = points_.cwiseProduct(of_smooth * points_).colwise().sum();
    const VectorXd squares = points_.cwiseAbs2().transpose() * row_sums;
    gradient.head(q) = -kernel.relevance.cwiseProduct(squares - crossed);
    const double trace = slope.trace();
    gradient(q) = kernel.linear * (slope.cwiseProduct(linear_).sum() + kLeastNoise * trace);
    gradient(q + 1) =
        kernel.quadratic * (slope.cwiseProduct(linear_.cwiseAbs2()).sum() + kLeastNoise * trace);
    gradient(q + 2) = (kernel.noise - least_noise(kernel)) * trace;
    for (Index i = 0; i < logs.size(); ++i) {
      const LogPrior prior = i < q ? kRelevance : i < q + 2 ? kPolynomial : kNoise;
      const double score = (logs(i) - prior.mean) / prior.sd;
      value += 0.5 * score * score;
      gradient(i) += score / prior.sd;
    }
    return value;
  }

  [[nodiscard]] static Kernel kernel_of(const VectorXd& logs) {
    const Index q = logs.size() - 3;
    Kernel kernel{.relevance = logs.head(q).array().exp(),
                  .linear = std::exp(logs(q)),
                  .quadratic = std::exp(logs(q + 1))};
    kernel.noise = std::exp(logs(q + 2)) + least_noise(kernel);
    return kernel;
  }

  [[nodiscard]] static VectorXd logs_of(const Kernel& kernel) {
    const double noise = std::max(kernel.noise - least_noise(kernel), 1e-9);
    VectorXd logs(kernel.relevance.size() + 3);
    logs << kernel.relevance, kernel.linear, kernel.quadratic, noise;
    return logs.array().log();
  }

 private:
  const MatrixXd& points_;
  const VectorXd& response_;
  MatrixXd linear_;
};

}  // namespace

Kernel usual_kernel(Index parameters) {
  return {.relevance = VectorXd::Constant(parameters, std::exp(kRelevance.mean))};
}

MatrixXd kernel_values(const Kernel& kernel, const MatrixXd& a, const MatrixXd& b) {
  const MatrixXd linear = linear_part(a, b);
  return smooth_part(kernel, a, b) + kernel.linear * linear + kernel.quadratic * linear.cwiseAbs2();
}

GaussianProcess fit_gaussian_process(const MatrixXd& points, const VectorXd& response,
                                     const Kernel& begin) {
  assert(points.rows() == response.size() && begin.relevance.size() == points.cols());
  const Index some = std::min(kRowsForKernel, points.rows());
  const MatrixXd first_points = points.topRows(some);
  const VectorXd first_response = response.head(some);
  const Unlikelihood unlikelihood{first_points, first_response};
  GaussianProcess process{
      .kernel = Unlikelihood::kernel_of(minimise(unlikelihood, Unlikelihood::logs_of(begin))),
      .weights = {},
      .left_out = {}};
  const MatrixXd smooth = kernel_values(process.kernel, points, points);
  Eigen::LLT<MatrixXd> factor;
  // Rows that the kernel was not chosen by may be too near each other for so little noise.
  for (bool is_first = true; is_first || factor.info() != Eigen::Success; is_first = false) {
    if (!is_first) process.kernel.noise *= 10.0;
    MatrixXd k = smooth;
    k.diagonal().array() += process.kernel.noise;
    factor.compute(k);
  }
  const MatrixXd inverse = factor.solve(MatrixXd::Identity(points.rows(), points.rows()));
  process.weights = inverse * response;
  process.left_out = process.weights.cwiseQuotient(inverse.diagonal());
  return process;
}

}  // namespace recald::regression
