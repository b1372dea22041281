#include "core/screening/lasso.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "core/text/number_text.hpp"

namespace recald::screening {
namespace {

// Share of a column's sum of squares about zero below which its variance is rounding.
constexpr double kConstantColumn = 1e-14;

/// Coordinate descent whose state survives from one penalty to the next.
class Descent {
 public:
  Descent(const StandardisedProducts& products, const LassoOptions& options)
      : products_(products),
        options_(options),
        coefficients_(
            Eigen::MatrixXd::Zero(products.covariance.rows(), products.covariance.cols())),
        residual_(products.covariance),
        step_(products.covariance.cols()),
        tolerance_(options.tolerance * std::sqrt(products.variance)) {}

  Result<LassoFit> run(double penalty) {
    sweeps_ = 0;
    settle_selected(penalty);
    while (sweeps_ < options_.sweeps_max) {
      double largest = 0.0;
      selected_.clear();
      for (Eigen::Index j = 0; j < coefficients_.rows(); ++j) {
        largest = std::max(largest, update(j, penalty));
        if (!coefficients_.row(j).isZero(0.0)) selected_.push_back(static_cast<int>(j));
      }
      ++sweeps_;
      // A sweep over all columns that moves none is a proof of optimality for all.
      if (largest <= tolerance_) return LassoFit{coefficients_, sweeps_};
      settle_selected(penalty);
    }
    return failure(ErrorCode::invalid_value,
                   "the lasso did not converge within " + std::to_string(options_.sweeps_max) +
                       " passes at penalty " + number_text(penalty) +
                       "; strongly correlated columns are the usual cause, so remove one of them");
  }

 private:
  /// Minimises over the selected columns.
  void settle_selected(double penalty) {
    if (coefficients_.cols() == 1 && solve_selected(penalty)) return;
    while (sweeps_ < options_.sweeps_max) {
      double largest = 0.0;
      for (const int j : selected_) largest = std::max(largest, update(j, penalty));
      ++sweeps_;
      if (largest <= tolerance_) return;
    }
  }

  /// Minimum over row j with all others fixed: soft thresholding of the row's length.
  /// @return how far it moved.
  double update(Eigen::Index j, double penalty) {
    step_ = residual_.row(j) + coefficients_.row(j);
    const double length = step_.norm();
    step_ *= length > penalty ? 1.0 - penalty / length : 0.0;
    step_ -= coefficients_.row(j);
    const double moved = step_.norm();
    if (moved == 0.0) return 0.0;
    coefficients_.row(j) += step_;
    for (Eigen::Index k = 0; k < step_.size(); ++k) {
      residual_.col(k).noalias() -= step_(k) * products_.correlation.col(j);
    }
    return moved;
  }

  /// One response: with signs s of the selected columns A the optimum is
  ///   C_AA b_A = c_A - lambda s.
  /// Where it has other signs, the way there is followed until the first coefficient is zero; that
  /// column is dropped and the rest solved again. Each piece of the way lowers the objective.
  /// @return false where the columns determine each other; sweeps will do.
  /// @see Lee, Battle, Raina, Ng (2007), NIPS 19, algorithm 1, step 3.
  bool solve_selected(double penalty) {
    while (!selected_.empty()) {
      const Eigen::VectorXd from = coefficients_(selected_, 0);
      factor_.compute(products_.correlation(selected_, selected_));
      if (factor_.info() != Eigen::Success) return false;
      const Eigen::VectorXd to =
          factor_.solve(products_.covariance(selected_, 0) - penalty * from.cwiseSign());
      const auto [share, dropped] = way_to_first_zero(from, to);
      coefficients_(selected_, 0) = from + share * (to - from);
      if (dropped < 0) break;
      coefficients_(selected_[static_cast<std::size_t>(dropped)], 0) = 0.0;
      selected_.erase(selected_.begin() + dropped);
    }
    residual_ = products_.covariance;
    for (const int j : selected_) {
      residual_.col(0).noalias() -= coefficients_(j, 0) * products_.correlation.col(j);
    }
    return true;
  }

  /// Share of the way at which a coefficient first changes its sign, and which; {1, -1} if none.
  static std::pair<double, Eigen::Index> way_to_first_zero(const Eigen::VectorXd& from,
                                                           const Eigen::VectorXd& to) {
    std::pair<double, Eigen::Index> first{1.0, -1};
    for (Eigen::Index i = 0; i < from.size(); ++i) {
      if (from(i) * to(i) > 0.0) continue;
      const double share = from(i) / (from(i) - to(i));
      if (share < first.first || first.second < 0) first = {share, i};
    }
    return first;
  }

  const StandardisedProducts& products_;
  const LassoOptions& options_;
  Eigen::MatrixXd coefficients_;
  Eigen::MatrixXd residual_;  ///< (p x m) X'(Y - X B) / n
  Eigen::RowVectorXd step_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  std::vector<int> selected_;
  double tolerance_;
  int sweeps_ = 0;
};

}  // namespace

StandardisedProducts::StandardisedProducts(const regression::CentredProducts& products)
    : x_mean(products.x_mean),
      x_sd((products.xx.diagonal() / products.rows).cwiseSqrt()),
      y_mean(products.y_mean),
      variance(products.yy.sum() / products.rows) {
  Eigen::VectorXd scale(x_sd.size());
  for (Eigen::Index j = 0; j < scale.size(); ++j) {
    const bool spread = x_sd(j) * x_sd(j) > kConstantColumn * x_mean(j) * x_mean(j);
    scale(j) = spread ? 1.0 / x_sd(j) : 0.0;
  }
  correlation = scale.asDiagonal() * products.xx * scale.asDiagonal() / products.rows;
  correlation.diagonal().setOnes();
  covariance = scale.asDiagonal() * products.xy / products.rows;
}

double StandardisedProducts::largest_penalty() const {
  return covariance.rows() == 0 ? 0.0 : covariance.rowwise().norm().maxCoeff();
}

Result<LassoFit> fit_lasso(const StandardisedProducts& products, double penalty,
                           const LassoOptions& options) {
  assert(penalty > 0.0);
  return Descent(products, options).run(penalty);
}

Result<LassoPath> lasso_path(const StandardisedProducts& products, const Eigen::VectorXd& penalties,
                             const LassoOptions& options) {
  Descent descent(products, options);
  LassoPath path{penalties, {}};
  path.fits.reserve(static_cast<std::size_t>(penalties.size()));
  for (const double penalty : penalties) {
    auto fit = TRY(descent.run(penalty));
    path.fits.push_back(std::move(fit));
  }
  return path;
}

Eigen::VectorXd penalty_grid(const StandardisedProducts& products, const LassoOptions& options) {
  assert(options.penalties >= 2 && options.smallest_ratio > 0.0 && options.smallest_ratio < 1.0);
  const double first = products.largest_penalty();
  Eigen::VectorXd grid(options.penalties);
  for (Eigen::Index i = 0; i < grid.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(grid.size() - 1);
    grid(i) = first * std::pow(options.smallest_ratio, share);
  }
  return grid;
}

}  // namespace recald::screening
