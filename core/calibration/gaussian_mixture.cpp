#include "core/calibration/gaussian_mixture.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/calibration/covariance/cholesky.hpp"
#include "core/calibration/samplers/log_sum.hpp"

namespace recald::calibration {
namespace {

constexpr int kIterationsMax = 100;
constexpr double kTolerance = 1e-4;  // nats per point, between iterations
// Of the covariance of all points, added to each component so that none collapses.
constexpr double kRidge = 1e-3;
constexpr double kWidening = 1.2;
constexpr double kWideWeight = 0.1;

GaussianComponent make_component(double weight, Eigen::VectorXd mean,
                                 const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd factor = covariance.llt().matrixL();
  const double constant = std::log(weight) - 0.5 * log_determinant_of_factor(factor) -
                          0.5 * static_cast<double>(mean.size()) * std::log(2.0 * std::numbers::pi);
  return {weight, std::move(mean), std::move(factor), constant};
}

Eigen::MatrixXd weighted_covariance(const Eigen::MatrixXd& points, const Eigen::VectorXd& weights,
                                    const Eigen::VectorXd& mean) {
  const Eigen::MatrixXd centred = points.rowwise() - mean.transpose();
  return centred.transpose() * weights.asDiagonal() * centred / weights.sum();
}

/// Expectation-maximisation for a fixed number of components.
class Fit {
 public:
  Fit(const Eigen::MatrixXd& points, const Eigen::MatrixXd& covariance, int components, Rng& rng)
      : points_(points),
        ridge_(kRidge * covariance),
        responsibilities_(points.rows(), components),
        terms_(points.rows(), components) {
    begin(covariance.llt().matrixL(), rng);
    double before = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < kIterationsMax; ++i) {
      if (!maximise()) return;
      expect();
      const bool settled =
          log_likelihood_ - before < kTolerance * static_cast<double>(points.rows());
      before = log_likelihood_;
      if (settled) break;
    }
    usable_ = true;
  }

  /// Nothing if a component had too few points.
  [[nodiscard]] std::optional<double> bic() const {
    if (!usable_) return std::nullopt;
    const auto d = static_cast<double>(points_.cols());
    const double parameters =
        static_cast<double>(components_.size()) * (1.0 + d + 0.5 * d * (d + 1.0)) - 1.0;
    return parameters * std::log(static_cast<double>(points_.rows())) - 2.0 * log_likelihood_;
  }

  [[nodiscard]] std::vector<GaussianComponent> components() && { return std::move(components_); }

 private:
  /// Starts with distant centres (k-means++) and assigns each point to the nearest.
  void begin(const Eigen::MatrixXd& factor, Rng& rng) {
    const Eigen::MatrixXd white =
        factor.triangularView<Eigen::Lower>().solve(points_.transpose()).transpose();
    const Eigen::Index n = white.rows();
    Eigen::VectorXd distance =
        Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
    Eigen::VectorXi nearest = Eigen::VectorXi::Zero(n);
    auto centre = static_cast<Eigen::Index>(rng.below(static_cast<std::uint64_t>(n)));
    for (Eigen::Index k = 0; k < responsibilities_.cols(); ++k) {
      for (Eigen::Index i = 0; i < n; ++i) {
        const double to_centre = (white.row(i) - white.row(centre)).squaredNorm();
        if (to_centre >= distance(i)) continue;
        distance(i) = to_centre;
        nearest(i) = static_cast<int>(k);
      }
      double left = rng.uniform() * distance.sum();
      for (centre = 0; centre + 1 < n && left > distance(centre); ++centre) {
        left -= distance(centre);
      }
    }
    responsibilities_.setZero();
    for (Eigen::Index i = 0; i < n; ++i) responsibilities_(i, nearest(i)) = 1.0;
  }

  [[nodiscard]] bool maximise() {
    components_.clear();
    const auto n = static_cast<double>(points_.rows());
    for (Eigen::Index k = 0; k < responsibilities_.cols(); ++k) {
      const auto share = responsibilities_.col(k);
      const double count = share.sum();
      if (count < static_cast<double>(points_.cols()) + 2.0) return false;
      const Eigen::VectorXd mean = points_.transpose() * share / count;
      components_.push_back(
          make_component(count / n, mean, weighted_covariance(points_, share, mean) + ridge_));
    }
    return true;
  }

  void expect() {
    for (std::size_t k = 0; k < components_.size(); ++k) {
      const GaussianComponent& c = components_[k];
      Eigen::MatrixXd white = (points_.rowwise() - c.mean.transpose()).transpose();
      c.factor.triangularView<Eigen::Lower>().solveInPlace(white);
      terms_.col(static_cast<Eigen::Index>(k)) =
          (c.log_constant - 0.5 * white.colwise().squaredNorm().array()).transpose();
    }
    log_likelihood_ = 0.0;
    for (Eigen::Index i = 0; i < terms_.rows(); ++i) {
      const double total = log_sum(terms_.row(i));
      log_likelihood_ += total;
      responsibilities_.row(i) = (terms_.row(i).array() - total).exp();
    }
  }

  const Eigen::MatrixXd& points_;
  Eigen::MatrixXd ridge_;
  Eigen::MatrixXd responsibilities_;  ///< (n x components)
  Eigen::MatrixXd terms_;             ///< (n x components) log density of each
  std::vector<GaussianComponent> components_;
  double log_likelihood_ = 0.0;
  bool usable_ = false;
};

}  // namespace

GaussianMixture::GaussianMixture(std::vector<GaussianComponent> components)
    : components_(std::move(components)), scratch_(components_.front().mean.size()) {}

double GaussianMixture::log_density(const Eigen::VectorXd& point) {
  double total = -std::numeric_limits<double>::infinity();
  for (const GaussianComponent& c : components_) {
    scratch_ = point - c.mean;
    c.factor.triangularView<Eigen::Lower>().solveInPlace(scratch_);
    total = log_sum(total, c.log_constant - 0.5 * scratch_.squaredNorm());
  }
  return total;
}

void GaussianMixture::draw(Rng& rng, Eigen::VectorXd& point) {
  double left = rng.uniform();
  std::size_t k = 0;
  while (k + 1 < components_.size() && left > components_[k].weight)
    left -= components_[k++].weight;
  for (double& u : scratch_) u = rng.normal();
  point = components_[k].mean;
  point.noalias() += components_[k].factor.triangularView<Eigen::Lower>() * scratch_;
}

GaussianMixture fit_mixture(const Eigen::MatrixXd& points, int components_max, Rng& rng) {
  assert(components_max >= 1 && points.rows() > points.cols() + 1);
  const Eigen::VectorXd mean = points.colwise().mean();
  const Eigen::MatrixXd covariance =
      weighted_covariance(points, Eigen::VectorXd::Ones(points.rows()), mean);
  std::vector<GaussianComponent> best{make_component(1.0, mean, covariance)};
  double best_bic = std::numeric_limits<double>::infinity();
  for (int components = 1; components <= components_max; ++components) {
    Fit fit(points, covariance, components, rng);
    const auto bic = fit.bic();
    if (!bic || *bic >= best_bic) break;  // one more is not worth it; two more hardly ever are
    best_bic = *bic;
    best = std::move(fit).components();
  }
  return GaussianMixture(std::move(best));
}

GaussianMixture widen(const GaussianMixture& mixture) {
  const auto& from = mixture.components();
  const Eigen::Index d = from.front().mean.size();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(d);
  for (const GaussianComponent& c : from) mean += c.weight * c.mean;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(d, d);
  std::vector<GaussianComponent> wide;
  for (const GaussianComponent& c : from) {
    const Eigen::MatrixXd covariance = c.factor * c.factor.transpose();
    whole += c.weight * (covariance + (c.mean - mean) * (c.mean - mean).transpose());
    wide.push_back(make_component((1.0 - kWideWeight) * c.weight, c.mean, kWidening * covariance));
  }
  wide.push_back(make_component(kWideWeight, mean, 2.0 * whole));
  return GaussianMixture(std::move(wide));
}

}  // namespace recald::calibration
