/// A posterior of four coordinates that quadrature can integrate: the answer that samplers are held
/// against without any other sampler.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "core/calibration/posterior/posterior.hpp"

namespace recald::calibration {

/// One output, one parameter: f_i = theta (0.5 + 0.5 x_i).
class RampModel final : public MonthlyModel {
 public:
  explicit RampModel(int months) : months_(months) {}
  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<RampModel>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 1; }
  [[nodiscard]] int output_count() const override { return 1; }
  [[nodiscard]] int month_count() const override { return months_; }
  [[nodiscard]] bool has_jacobian() const override { return true; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    for (std::size_t i = 0; i < outputs.size(); ++i) outputs[i] = theta[0] * slope(i);
  }
  void evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                              std::span<double> jacobian) override {
    evaluate(theta, outputs);
    for (std::size_t i = 0; i < outputs.size(); ++i) jacobian[i] = slope(i);
  }
  [[nodiscard]] double slope(std::size_t i) const {
    return 0.5 + 0.5 * static_cast<double>(i) / (months_ - 1);
  }

 private:
  int months_;
};

/// The ramp at theta = 0.5, a wave of three periods over the input's range, and noise of 0.01.
///
/// A wave of 0.03 is a discrepancy like any other. One of 0.065 can be explained in two ways that
/// have next to nothing between them: noise six times as large and a smooth discrepancy, or a
/// discrepancy that wiggles and the noise as it is.
inline Posterior small_posterior(double wave) {
  constexpr int n = 24;
  const RampModel model(n);
  Rng rng(4);
  PosteriorData data;
  data.month_inputs.resize(n, 1);
  data.values.resize(n);
  for (int i = 0; i < n; ++i) {
    const double x = i / (n - 1.0);
    data.month_inputs(i, 0) = x;
    data.points.push_back({0, i});
    data.values(i) = 0.5 * model.slope(static_cast<std::size_t>(i)) +
                     wave * std::sin(2.0 * std::numbers::pi * 3.0 * x) + 0.01 * rng.normal();
  }
  data.extra_variances.setZero(n);
  data.common_errors.resize(n, 0);
  data.scales = {{0.0, 1.0}};
  data.weights = {1.0};
  return Posterior::make(model, {{"level", "-", {0.0, 0.5, 1.0}}}, data,
                         {"test", {10.0, 0.1}, {2.0, 0.0032}, {1.0, 0.3}})
      .value();
}

/// Moments in the posterior's own coordinates.
struct Quadrature {
  Eigen::Vector4d mean;
  Eigen::Vector4d sd;
  double log_evidence;
  double below;  ///< Probability that the score of rho lies below -2: the wiggly explanation.
};

/// By the trapezoid rule, which for a smooth density that vanishes at the ends converges faster
/// than any power of the step.
/// @param nodes  Of each coordinate: theta's score, log lambda_delta, log lambda_eps, rho's score.
inline Quadrature integrate(Posterior posterior, std::array<int, 4> nodes) {
  const std::array<double, 4> low{-2.5, std::log(100.0) - 2.2, std::log(625.0) - 4.5, -8.0};
  const std::array<double, 4> high{2.5, std::log(100.0) + 2.2, std::log(625.0) + 5.0, 4.0};
  Eigen::Vector4d step;
  for (std::size_t c = 0; c < 4; ++c) {
    step(static_cast<Eigen::Index>(c)) = (high[c] - low[c]) / (nodes[c] - 1);
  }
  const double shift =
      posterior.log_density(Eigen::Vector4d(0.0, std::log(100.0), std::log(625.0), 0.0)).value();
  double mass = 0.0;
  double below = 0.0;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Eigen::Vector4d squares = Eigen::Vector4d::Zero();
  Eigen::VectorXd point(4);
  // theta innermost: a change of theta alone costs no factorisation.
  for (int b = 0; b < nodes[1]; ++b) {
    for (int c = 0; c < nodes[2]; ++c) {
      for (int d = 0; d < nodes[3]; ++d) {
        for (int a = 0; a < nodes[0]; ++a) {
          point << low[0] + a * step(0), low[1] + b * step(1), low[2] + c * step(2),
              low[3] + d * step(3);
          const double weight = std::exp(posterior.log_density(point).value() - shift);
          mass += weight;
          sum += weight * point;
          squares += weight * point.cwiseAbs2();
          below += point(3) < -2.0 ? weight : 0.0;
        }
      }
    }
  }
  Quadrature result;
  result.mean = sum / mass;
  result.sd = (squares / mass - result.mean.cwiseAbs2()).cwiseSqrt();
  result.log_evidence = shift + std::log(mass * step.prod());
  result.below = below / mass;
  return result;
}

}  // namespace recald::calibration
