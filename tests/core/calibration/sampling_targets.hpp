/// Densities whose moments, quantiles or integrals are known, for tests of samplers.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/calibration/samplers/log_sum.hpp"
#include "core/calibration/samplers/sampler.hpp"

namespace recald::calibration {

/// A target whose prior is normal around zero; every coordinate has the same sd.
class NormalPriorTarget : public Target {
 public:
  NormalPriorTarget(Eigen::Index dimension, double prior_sd)
      : dimension_(dimension), prior_sd_(prior_sd) {}

  [[nodiscard]] Eigen::Index dimension() const override { return dimension_; }
  [[nodiscard]] double log_prior(const Eigen::VectorXd& point) const override {
    const auto d = static_cast<double>(dimension_);
    return -0.5 * point.squaredNorm() / (prior_sd_ * prior_sd_) -
           d * std::log(prior_sd_ * std::sqrt(2.0 * std::numbers::pi));
  }
  [[nodiscard]] Eigen::VectorXd draw_start(Rng& rng) const override {
    Eigen::VectorXd start(dimension_);
    for (double& x : start) x = prior_sd_ * rng.normal();
    return start;
  }

 protected:
  Eigen::Index dimension_;
  double prior_sd_;
};

/// Any function of a point; its gradient, where asked for, by central differences.
class FunctionTarget : public NormalPriorTarget {
 public:
  using Function = std::function<Result<double>(const Eigen::VectorXd&)>;

  FunctionTarget(Eigen::Index dimension, double prior_sd, Function function,
                 bool has_gradient = false)
      : NormalPriorTarget(dimension, prior_sd),
        function_(std::move(function)),
        has_gradient_(has_gradient) {}

  [[nodiscard]] bool has_gradient() const override { return has_gradient_; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& point) override {
    ++evaluations;
    return function_(point);
  }
  [[nodiscard]] Result<double> log_density_and_gradient(const Eigen::VectorXd& point,
                                                        Eigen::VectorXd& gradient) override {
    constexpr double h = 1e-5;
    Eigen::VectorXd moved = point;
    for (Eigen::Index j = 0; j < dimension_; ++j) {
      moved(j) = point(j) + h;
      const auto above = function_(moved);
      if (!above) return above;
      moved(j) = point(j) - h;
      const auto below = function_(moved);
      if (!below) return below;
      gradient(j) = (*above - *below) / (2.0 * h);
      moved(j) = point(j);
    }
    return log_density(point);
  }

  int evaluations = 0;

 private:
  Function function_;
  bool has_gradient_;
};

/// A normal density whose axes differ ninefold and are correlated; not normalised.
class SkewNormal final : public NormalPriorTarget {
 public:
  explicit SkewNormal(Eigen::Index d)
      : NormalPriorTarget(d, 10.0), covariance(d, d), mean(d), centred_(d) {
    for (Eigen::Index i = 0; i < d; ++i) {
      mean(i) = static_cast<double>(i);
      for (Eigen::Index j = 0; j < d; ++j) {
        covariance(i, j) = std::pow(3.0, static_cast<double>((i % 3) + (j % 3)) - 2.0) *
                           std::pow(0.7, std::abs(static_cast<double>(i - j)));
      }
    }
    precision_ = covariance.llt().solve(Eigen::MatrixXd::Identity(d, d));
  }

  [[nodiscard]] bool has_gradient() const override { return true; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& point) override {
    Eigen::VectorXd gradient(dimension_);
    return log_density_and_gradient(point, gradient);
  }
  [[nodiscard]] Result<double> log_density_and_gradient(const Eigen::VectorXd& point,
                                                        Eigen::VectorXd& gradient) override {
    centred_ = mean - point;
    gradient.noalias() = precision_ * centred_;
    return -0.5 * centred_.dot(gradient);
  }

  Eigen::MatrixXd covariance;
  Eigen::VectorXd mean;

 private:
  Eigen::MatrixXd precision_;
  Eigen::VectorXd centred_;
};

/// Haario's banana: x_1 ~ N(0, s^2), x_2 = e + b (x_1^2 - s^2), all else standard normal.
/// Means 0; variances s^2, 1 + 2 b^2 s^4, 1, …; volume as of a normal density.
class Banana final : public NormalPriorTarget {
 public:
  explicit Banana(Eigen::Index d, double bend = 0.5, double sd = 1.5)
      : NormalPriorTarget(d, 3.0), bend_(bend), sd_(sd) {}

  [[nodiscard]] bool has_gradient() const override { return true; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& x) override {
    return -0.5 * x.squaredNorm() - 0.5 * (square(x(0) / sd_) - square(x(0))) -
           0.5 * (square(bent(x)) - square(x(1)));
  }
  [[nodiscard]] Result<double> log_density_and_gradient(const Eigen::VectorXd& x,
                                                        Eigen::VectorXd& gradient) override {
    gradient = -x;
    gradient(0) = -x(0) / (sd_ * sd_) + bent(x) * 2.0 * bend_ * x(0);
    gradient(1) = -bent(x);
    return log_density(x);
  }
  [[nodiscard]] double variance(Eigen::Index j) const {
    if (j == 0) return sd_ * sd_;
    return j == 1 ? 1.0 + 2.0 * square(bend_ * sd_ * sd_) : 1.0;
  }

 private:
  static double square(double x) { return x * x; }
  [[nodiscard]] double bent(const Eigen::VectorXd& x) const {
    return x(1) - bend_ * (x(0) * x(0) - sd_ * sd_);
  }
  double bend_;
  double sd_;
};

/// Standard logistic in every coordinate: tails exp(-|x|), all quantiles known.
class Logistic final : public NormalPriorTarget {
 public:
  explicit Logistic(Eigen::Index d) : NormalPriorTarget(d, 3.0) {}

  [[nodiscard]] bool has_gradient() const override { return true; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& x) override {
    return (-x.array() - 2.0 * (-x.array()).exp().log1p()).sum();
  }
  [[nodiscard]] Result<double> log_density_and_gradient(const Eigen::VectorXd& x,
                                                        Eigen::VectorXd& gradient) override {
    gradient = -(0.5 * x.array()).tanh();
    return log_density(x);
  }
  [[nodiscard]] static double quantile(double p) { return std::log(p / (1.0 - p)); }
};

/// Two normal densities of the given sd whose means differ by `apart` sds in the first coordinate,
/// with weights `weight` (left, negative) and the rest. Integrates to one.
class TwoModes final : public NormalPriorTarget {
 public:
  TwoModes(Eigen::Index d, double weight, double apart, double sd = 0.5)
      : NormalPriorTarget(d, 2.0),
        log_weight_{std::log(weight), std::log1p(-weight)},
        centre_(0.5 * apart * sd),
        sd_(sd) {}

  [[nodiscard]] bool has_gradient() const override { return true; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& x) override {
    return log_sum(log_mode(x, 0), log_mode(x, 1));
  }
  [[nodiscard]] Result<double> log_density_and_gradient(const Eigen::VectorXd& x,
                                                        Eigen::VectorXd& gradient) override {
    const double value = log_sum(log_mode(x, 0), log_mode(x, 1));
    const double left = std::exp(log_mode(x, 0) - value);
    gradient = -x / (sd_ * sd_);
    gradient(0) += centre_ * (1.0 - 2.0 * left) / (sd_ * sd_);
    return value;
  }

 private:
  [[nodiscard]] double log_mode(const Eigen::VectorXd& x, int mode) const {
    const double centre = mode == 0 ? -centre_ : centre_;
    const double squares = x.squaredNorm() - 2.0 * x(0) * centre + centre * centre;
    return log_weight_[mode] - 0.5 * squares / (sd_ * sd_) -
           static_cast<double>(dimension_) * std::log(sd_ * std::sqrt(2.0 * std::numbers::pi));
  }
  double log_weight_[2];
  double centre_;
  double sd_;
};

/// y = X b + e with b ~ N(0, I) and e ~ N(0, noise_sd^2): y is normal with covariance
/// X X' + noise_sd^2 I, so the evidence is known, and b given y is normal.
class ConjugateLinear final : public NormalPriorTarget {
 public:
  ConjugateLinear(Eigen::Index rows, Eigen::Index d, double noise_sd)
      : NormalPriorTarget(d, 1.0), design_(rows, d), response_(rows), noise_sd_(noise_sd) {
    Rng rng(2026, 11);
    for (double& x : design_.reshaped()) x = rng.normal();
    const Eigen::VectorXd truth = draw_start(rng);
    response_ = design_ * truth;
    for (double& y : response_) y += noise_sd_ * rng.normal();
  }

  [[nodiscard]] bool has_gradient() const override { return true; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& b) override {
    residual_ = response_ - design_ * b;
    return log_prior(b) - 0.5 * residual_.squaredNorm() / (noise_sd_ * noise_sd_) -
           log_sqrt_two_pi(response_.size()) -
           static_cast<double>(response_.size()) * std::log(noise_sd_);
  }
  [[nodiscard]] Result<double> log_density_and_gradient(const Eigen::VectorXd& b,
                                                        Eigen::VectorXd& gradient) override {
    const auto value = log_density(b);
    gradient = design_.transpose() * residual_ / (noise_sd_ * noise_sd_) - b;
    return value;
  }

  [[nodiscard]] double log_evidence() const {
    const Eigen::Index n = response_.size();
    const Eigen::MatrixXd covariance =
        design_ * design_.transpose() + noise_sd_ * noise_sd_ * Eigen::MatrixXd::Identity(n, n);
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    const Eigen::VectorXd diagonal = Eigen::MatrixXd(factor.matrixL()).diagonal();
    return -0.5 * response_.dot(factor.solve(response_)) - diagonal.array().log().sum() -
           log_sqrt_two_pi(n);
  }
  [[nodiscard]] Eigen::MatrixXd posterior_covariance() const {
    const Eigen::MatrixXd precision = design_.transpose() * design_ / (noise_sd_ * noise_sd_) +
                                      Eigen::MatrixXd::Identity(dimension_, dimension_);
    return precision.inverse();
  }
  [[nodiscard]] Eigen::VectorXd posterior_mean() const {
    return posterior_covariance() * design_.transpose() * response_ / (noise_sd_ * noise_sd_);
  }

 private:
  static double log_sqrt_two_pi(Eigen::Index n) {
    return 0.5 * static_cast<double>(n) * std::log(2.0 * std::numbers::pi);
  }
  Eigen::MatrixXd design_;
  Eigen::VectorXd response_;
  Eigen::VectorXd residual_;
  double noise_sd_;
};

}  // namespace recald::calibration
