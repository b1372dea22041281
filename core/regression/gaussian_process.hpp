/// A smooth function of many parameters from few of its values.
#pragma once

#include <Eigen/Core>

namespace recald::regression {

/// How alike a function's values at two points x and x' are, relative to the first part:
///
///     k(x, x') = exp(-1/2 sum_j relevance_j (x_j - x'_j)^2)
///                + linear (1 + c . c') + quadratic (1 + c . c')^2 + noise [same point]
///
/// with c = x - 1/2, x on [0, 1]. The first part bends as the values ask for and forgets them
/// beyond the points; the polynomials carry on.
struct Kernel {
  Eigen::VectorXd relevance;  ///< (q) 1 / length^2: 0, the function does not depend on x_j.
  double linear = 1.0;
  double quadratic = 0.01;
  double noise = 1e-3;
};

struct GaussianProcess {
  Kernel kernel;
  /// (n) K^-1 y: the function at x is the sum over points of weight k(x, x_i), without the noise.
  Eigen::VectorXd weights;
  /// (n) What y_i is predicted wrong by without row i, the kernel being the same.
  Eigen::VectorXd left_out;
};

/// The kernel by the most likely values of log relevance, log linear, log quadratic and log noise
/// under wide normal priors, found by BFGS; its overall variance is that of the highest likelihood.
/// With more than `kRowsForKernel` rows the first ones choose the kernel, and all are predicted by.
///
/// @param points    (n x q) on [0, 1], in an order of no meaning.
/// @param response  (n) of about unit spread about 0, not constant.
/// @param begin     Where the search begins: that of a related response, or `usual_kernel`.
/// @note   An evaluation of the likelihood costs 1.3 n^3 + 4 n^2 q flops; there are 20 to 60.
/// @see    Rasmussen, Williams (2006), Gaussian Processes for Machine Learning, eqs. (2.25), (5.8),
///         (5.9), (5.12).
[[nodiscard]] GaussianProcess fit_gaussian_process(const Eigen::MatrixXd& points,
                                                   const Eigen::VectorXd& response,
                                                   const Kernel& begin);

inline constexpr Eigen::Index kRowsForKernel = 250;

/// Lengths of 2.7 ranges, which bend little. @param parameters  q
[[nodiscard]] Kernel usual_kernel(Eigen::Index parameters);

/// (rows of a x rows of b), without the noise.
[[nodiscard]] Eigen::MatrixXd kernel_values(const Kernel& kernel, const Eigen::MatrixXd& a,
                                            const Eigen::MatrixXd& b);

}  // namespace recald::regression
