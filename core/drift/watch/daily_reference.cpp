#include "core/drift/watch/daily_reference.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::drift {
namespace {

constexpr int kOfADay = 7;
constexpr int kCoefficients = 2 * kOfADay;  // of workdays, then of others
constexpr double kVaguePrecision = 0.05;
constexpr double kFirstScatter = 0.1;  // before there are days, of the mean
constexpr double kPooledDays = 20.0;   // that the scatter of all days is worth at each level
constexpr double kLevelWidth = 0.25;   // of what is near, in means
constexpr double kOutlier = 3.0;       // sd that a day's square counts at most
constexpr double kFarDay = 5.0;        // how much less is known of days unlike all others
constexpr double kDryRatio = 0.009;    // kg/kg below which coils take out hardly any water

/// All of the order of one.
Eigen::VectorXd features(const WatchedDay& day, double scale) {
  const double t = day.dry_bulb_C;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(kCoefficients);
  values.segment<kOfADay>(day.is_workday ? 0 : kOfADay) << 1.0, day.modelled_kW / scale,
      std::max(0.0, 16.0 - t) / 10.0, std::max(0.0, 5.0 - t) / 10.0, std::max(0.0, t - 12.0) / 10.0,
      std::max(0.0, t - 20.0) / 10.0, std::max(0.0, day.humidity_ratio - kDryRatio) / 0.005;
  return values;
}

}  // namespace

Coefficients DailyReference::vague() {
  return {Eigen::VectorXd::Zero(kCoefficients),
          kVaguePrecision * Eigen::MatrixXd::Identity(kCoefficients, kCoefficients)};
}

DailyReference::DailyReference(const std::vector<WatchedDay>& days, double scale,
                               const Coefficients& before)
    : scale_(scale), coefficients_(before), scatter_(kFirstScatter) {
  assert(scale > 0.0);
  const auto count = static_cast<Eigen::Index>(days.size());
  Eigen::MatrixXd x(count, kCoefficients);
  Eigen::VectorXd y(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const WatchedDay& day = days[static_cast<std::size_t>(i)];
    x.row(i) = features(day, scale).transpose();
    y(i) = day.measured_kW / scale;
  }
  coefficients_.precision += x.transpose() * x;
  const Eigen::LLT<Eigen::MatrixXd> factor{coefficients_.precision};
  covariance_ = factor.solve(Eigen::MatrixXd::Identity(kCoefficients, kCoefficients));
  const Eigen::VectorXd known_before = before.precision * before.mean;

  // Twice: what is odd is judged by a first fit, and counts in the second as far as days may be
  // off.
  Eigen::ArrayXd off;
  for (int pass = 0; pass < 2; ++pass) {
    coefficients_.mean = factor.solve(known_before + x.transpose() * y);
    off = (y - x * coefficients_.mean).array();
    if (count == 0) return;
    const double plain = std::sqrt(off.square().mean());
    const double largest = kOutlier * std::max(1e-6, plain);
    off = off.max(-largest).min(largest);
    scatter_ = std::max(1e-6, std::sqrt(off.square().mean()));
    y = (x * coefficients_.mean).array() + off.max(-kOutlier * scatter_).min(kOutlier * scatter_);
  }
  const Eigen::VectorXd levels = x * coefficients_.mean;
  for (Eigen::Index i = 0; i < count; ++i) {
    fitted_.push_back({levels(i), off(i) * off(i), days[static_cast<std::size_t>(i)].is_workday});
  }
}

Coefficients DailyReference::after_a_change(double share, double factor_sd) const {
  const Eigen::VectorXd& mean = coefficients_.mean;
  const double by_factor = factor_sd * factor_sd / (scatter_ * scatter_);
  const Eigen::MatrixXd covariance = covariance_ / share + by_factor * mean * mean.transpose();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(kCoefficients, kCoefficients);
  return {mean, covariance.llt().solve(identity)};
}

double DailyReference::scatter_at(double level, bool is_workday) const {
  const double largest = kOutlier * kOutlier * scatter_ * scatter_;
  double squares = kPooledDays * scatter_ * scatter_;
  double weights = kPooledDays;
  for (const Fitted& one : fitted_) {
    if (one.is_workday != is_workday) continue;
    const double off = (one.level - level) / kLevelWidth;
    const double weight = std::exp(-0.5 * off * off);
    squares += weight * std::min(one.square, largest);
    weights += weight;
  }
  return std::sqrt(squares / weights);
}

DailyReference::Expected DailyReference::expect(const WatchedDay& day) const {
  const Eigen::VectorXd x = features(day, scale_);
  const double level = x.dot(coefficients_.mean);
  const double unknown = kFarDay * x.dot(covariance_ * x);
  return {scale_ * level, scale_ * scatter_at(level, day.is_workday) * std::sqrt(1.0 + unknown)};
}

}  // namespace recald::drift
