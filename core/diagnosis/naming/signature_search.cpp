#include "core/diagnosis/naming/signature_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/diagnosis/evidence/candidate_shapes.hpp"
#include "core/diagnosis/evidence/joint_fit.hpp"

namespace recald::diagnosis {
namespace {

// Spreads; what is farther off says no more. The rows of the null were clipped there too.
constexpr double kFarthestOff = 15.0;
// F and nu: of the 500 to 800 signatures of a site, so many are about as good as independent.
// Chosen on development buildings, like the other constants of this search.
constexpr double kFree = 100.0;
constexpr double kNu = 10.0;

}  // namespace

bool EffectShape::has_amount() const { return with_amount(*candidate, values, 0.5) != values; }

std::vector<double> EffectShape::with_factor(double factor) const {
  return with_amount(*candidate, values, sign * factor);
}

SignatureSearch::SignatureSearch(const SiteProblem& site, const SignatureReader& reader,
                                 const SignatureNull& null, Predictor& predictor,
                                 Eigen::VectorXd measured, const Eigen::VectorXd& modelled)
    : facts_(site.facts()),
      reader_(reader),
      predictor_(&predictor),
      priors_(priors_of(site)),
      measured_(std::move(measured)),
      metric_(null, measured_ + modelled),
      centre_(std::ssize(priors_)),
      reach_(std::ssize(priors_)) {
  for (std::size_t j = 0; j < priors_.size(); ++j) {
    const std::string& name = site.parameters[j].name;
    centre_[static_cast<Eigen::Index>(j)] = null.centre_of(name);
    reach_[static_cast<Eigen::Index>(j)] = null.reach_of(name);
  }
}

SignatureSearch SignatureSearch::with(Predictor& predictor) const {
  SignatureSearch search = *this;
  search.predictor_ = &predictor;
  return search;
}

Eigen::VectorXd SignatureSearch::modelled_by(Predictor& predictor, const Eigen::VectorXd& at,
                                             const EffectShape* shape) const {
  const Eigen::VectorXd scores = centre_ + at.head(parameters()).cwiseProduct(reach_);
  const std::vector<double> theta = values_at(priors_, scores);
  if (shape == nullptr) {
    predictor.parts_kW(theta);
  } else {
    const bool has_amount = at.size() > parameters();
    const std::vector<double> values =
        has_amount ? shape->with_factor(std::exp(at[parameters()])) : shape->values;
    const auto alteration = alteration_of(*shape->candidate, facts_, values);
    predictor.parts_kW(theta, alteration.get());
  }
  const Eigen::MatrixXd read = reader_.read(predictor.hours_kW());
  return Eigen::Map<const Eigen::VectorXd>(read.data(), read.size());
}

Eigen::VectorXd SignatureSearch::scores_of(const SignaturePoint& point) const {
  return centre_ + point.at.head(parameters()).cwiseProduct(reach_);
}

double SignatureSearch::weight_of(const SignaturePoint& point) const {
  const auto count = static_cast<double>(metric_.count());
  return (kFree + kNu) * (kFree / count) / (kNu + kFree * point.misfit / count);
}

double SignatureSearch::log_ratio(double before, double after) const {
  const auto count = static_cast<double>(metric_.count());
  return 0.5 * (kFree + kNu) *
         (std::log(kNu + kFree * before / count) - std::log(kNu + kFree * after / count));
}

Eigen::VectorXd SignatureSearch::precision_of(const SignaturePoint& point) const {
  Eigen::VectorXd precision = Eigen::VectorXd::Ones(point.at.size());
  if (point.at.size() > parameters()) {
    precision[parameters()] = 1.0 / (kAmountSpread * kAmountSpread);
  }
  return precision;
}

void SignatureSearch::evaluate(SignaturePoint& point, const EffectShape* shape) {
  point.residual = metric_.whiten(measured_ - modelled(point.at, shape), kFarthestOff);
  point.misfit = point.residual.squaredNorm();
  point.cost = log_ratio(point.misfit, 0.0) + 0.5 * point.at.cwiseAbs2().dot(precision_of(point));
  if (!std::isfinite(point.cost)) point.cost = std::numeric_limits<double>::infinity();
}

SignaturePoint SignatureSearch::base_at(const Eigen::VectorXd& scores) {
  SignaturePoint point{.at = (scores - centre_).cwiseQuotient(reach_)};
  evaluate(point, nullptr);
  return point;
}

SignaturePoint SignatureSearch::with_effect(const SignaturePoint& base, const EffectShape& shape,
                                            double factor, const Eigen::VectorXd& change) {
  SignaturePoint point{.at = base.at, .slopes = base.slopes};
  if (shape.has_amount()) {
    point.at.conservativeResize(parameters() + 1);
    point.at[parameters()] = std::log(factor);
    point.slopes.conservativeResize(Eigen::NoChange, parameters() + 1);
    point.slopes.col(parameters()) = shape.sign * factor * change;
  }
  evaluate(point, &shape);
  return point;
}

void SignatureSearch::linearise(SignaturePoint& point, const EffectShape* shape) {
  constexpr double kStep = 0.15;  // Scores.
  const Eigen::VectorXd here = modelled(point.at, shape);
  Eigen::MatrixXd slopes(here.size(), parameters());
  predictor_->for_each(priors_.size(), [&](Predictor& predictor, std::size_t index) {
    const auto j = static_cast<Eigen::Index>(index);
    Eigen::VectorXd there = point.at;
    const double step = (there[j] > 0.0 ? -kStep : kStep) / reach_[j];
    there[j] += step;
    slopes.col(j) = (modelled_by(predictor, there, shape) - here) / step;
  });
  point.slopes.conservativeResize(metric_.count(), point.at.size());
  point.slopes.leftCols(parameters()) = metric_.whiten(slopes);
}

SignaturePoint SignatureSearch::improved(SignaturePoint point, const EffectShape* shape) {
  constexpr int kIterations = 10;
  constexpr int kTrials = 4;
  constexpr double kFarthest = 2.0;
  constexpr double kSmallGain = 0.1;
  const Eigen::VectorXd precision = precision_of(point);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double weight = weight_of(point);
    Eigen::MatrixXd normal = weight * point.slopes.transpose() * point.slopes;
    normal.diagonal() += precision;
    const Eigen::VectorXd downhill =
        weight * point.slopes.transpose() * point.residual - precision.cwiseProduct(point.at);
    Eigen::VectorXd step = normal.llt().solve(downhill).cwiseMin(kFarthest).cwiseMax(-kFarthest);
    double gained = 0.0;
    for (int trial = 0; trial < kTrials && gained <= 0.0; ++trial, step *= 0.4) {
      if (predictor_->is_stopped()) return point;
      SignaturePoint there{.at = point.at + step};
      evaluate(there, shape);
      const Eigen::VectorXd unforeseen =
          (point.residual - there.residual - point.slopes * step) / step.squaredNorm();
      if (unforeseen.allFinite()) point.slopes += unforeseen * step.transpose();
      if (!(there.cost < point.cost)) continue;
      gained = point.cost - there.cost;
      there.slopes = std::move(point.slopes);
      point = std::move(there);
    }
    if (gained < kSmallGain) break;
  }
  return point;
}

SignaturePoint SignatureSearch::settled(SignaturePoint point, const EffectShape* shape) {
  constexpr int kRounds = 4;
  constexpr double kSmallGain = 0.5;
  for (int round = 0; round < kRounds && !predictor_->is_stopped(); ++round) {
    linearise(point, shape);
    const double before = point.cost;
    point = improved(std::move(point), shape);
    if (before - point.cost < kSmallGain) break;
  }
  return point;
}

double SignatureSearch::log_narrowing(const SignaturePoint& point) const {
  const Eigen::Index k = point.at.size();
  if (k == parameters()) return 0.0;
  Eigen::MatrixXd normal = weight_of(point) * point.slopes.transpose() * point.slopes;
  normal.diagonal() += precision_of(point);
  const Eigen::MatrixXd covariance = normal.llt().solve(Eigen::MatrixXd::Identity(k, k));
  return 0.5 * std::log(covariance(k - 1, k - 1)) - std::log(kAmountSpread);
}

}  // namespace recald::diagnosis
