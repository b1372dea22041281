/// The minimum of a smooth function of few variables.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace recald {

/// @param gradient  To be set, except where the function is infinite, which is where it does not
///                  exist.
using SmoothFunction = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)>;

/// BFGS with steps halved until they pay (Armijo). Ends when a step takes less than 1e-3 off, or
/// after `kMostSteps`: enough for logarithms of likelihoods, of which 0.1 means nothing.
/// @param x  (n) Where to begin.
/// @return the lowest point found; `x` where the function does not exist there.
/// @note   O(n^2) a step beside the function's own cost, which is called a little more than once.
/// @see    Nocedal, Wright (2006), Numerical Optimization, algorithm 6.1.
[[nodiscard]] Eigen::VectorXd minimise(const SmoothFunction& function, Eigen::VectorXd x);

inline constexpr int kMostSteps = 100;

}  // namespace recald
