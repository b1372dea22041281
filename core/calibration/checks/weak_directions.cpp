#include "core/calibration/checks/weak_directions.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/display/id_words.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::calibration {
namespace {

constexpr double kStep = 0.01;          // of a prior sd, for finite differences
constexpr double kWeak = 1.0;           // the prior's own information
constexpr std::size_t kNamedMax = 4;    // in a sentence, weakest first
constexpr double kLeastLoading = 0.35;  // worth mentioning: an eighth of the direction

template <class Column>
double median_of(const std::vector<ChainDraws>& chains, Column column) {
  std::vector<double> values;
  for (const ChainDraws& chain : chains) {
    const Eigen::VectorXd draws = column(chain);
    values.insert(values.end(), draws.begin(), draws.end());
  }
  return median(std::move(values));
}

Hyperparameters medians(const std::vector<ChainDraws>& chains) {
  Hyperparameters hyper{
      median_of(chains, [](const ChainDraws& c) { return c.discrepancy_precision; }),
      median_of(chains, [](const ChainDraws& c) { return c.error_precision; }),
      Eigen::VectorXd(chains.front().beta.cols())};
  for (Eigen::Index s = 0; s < hyper.beta.size(); ++s) {
    hyper.beta(s) =
        median_of(chains, [s](const ChainDraws& c) -> Eigen::VectorXd { return c.beta.col(s); });
  }
  return hyper;
}

/// Derivatives of the normalised outputs per prior sd of each parameter, (m x q).
Eigen::MatrixXd scaled_jacobian(Posterior& posterior, const Eigen::VectorXd& mean) {
  Eigen::MatrixXd jacobian(posterior.point_count(), mean.size());
  for (Eigen::Index j = 0; j < mean.size(); ++j) {
    const Prior& prior = posterior.parameters()[static_cast<std::size_t>(j)].prior;
    const double sd = std::sqrt(prior.variance());
    std::vector<double> theta(mean.begin(), mean.end());
    double& moved = theta[static_cast<std::size_t>(j)];
    const double high = std::min(mean(j) + kStep * sd, prior.max());
    const double low = std::max(mean(j) - kStep * sd, prior.min());
    moved = high;
    jacobian.col(j) = -posterior.residual_at(theta);
    moved = low;
    jacobian.col(j) += posterior.residual_at(theta);
    jacobian.col(j) *= sd / (high - low);
  }
  return jacobian;
}

/// "occupancy up with outdoor_air down": the parts of the direction worth mentioning.
std::string in_words(const WeakDirection& direction, const std::vector<Parameter>& parameters) {
  std::vector<Eigen::Index> order;
  for (Eigen::Index j = 0; j < direction.loadings.size(); ++j) {
    if (std::abs(direction.loadings(j)) >= kLeastLoading) order.push_back(j);
  }
  if (order.empty()) {  // spread over many: the largest represents them
    Eigen::Index largest = 0;
    direction.loadings.cwiseAbs().maxCoeff(&largest);
    order.push_back(largest);
  }
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(direction.loadings(a)) > std::abs(direction.loadings(b));
  });
  std::string words;
  for (const Eigen::Index j : order) {
    if (!words.empty()) words += " with ";
    words += display::parameter_words(parameters[static_cast<std::size_t>(j)].name);
    if (order.size() < 2) break;
    const bool same = direction.loadings(j) * direction.loadings(order.front()) > 0.0;
    words += same ? " up" : " down";
  }
  return words;
}

}  // namespace

std::vector<WeakDirection> find_weak_directions(Posterior& posterior,
                                                const std::vector<ChainDraws>& chains,
                                                const Eigen::VectorXd& mean) {
  if (!posterior.set_hyperparameters(medians(chains))) return {};
  const Eigen::Index m = posterior.point_count();
  Eigen::MatrixXd precision(m, m);
  posterior.precision(precision);
  const Eigen::MatrixXd jacobian = scaled_jacobian(posterior, mean);
  const Eigen::MatrixXd information = jacobian.transpose() * precision * jacobian;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  std::vector<WeakDirection> weak;
  for (Eigen::Index k = 0; k < mean.size() && eigen.eigenvalues()(k) < kWeak; ++k) {
    weak.push_back({eigen.eigenvectors().col(k), std::max(eigen.eigenvalues()(k), 0.0)});
  }
  return weak;
}

Findings weak_direction_findings(const std::vector<WeakDirection>& directions,
                                 const std::vector<Parameter>& parameters) {
  if (directions.empty()) return {};
  std::string list;
  for (std::size_t k = 0; k < std::min(directions.size(), kNamedMax); ++k) {
    if (!list.empty()) list += "; ";
    list += in_words(directions[k], parameters);
  }
  if (directions.size() > kNamedMax) {
    list += "; and " + std::to_string(directions.size() - kNamedMax) + " more";
  }
  return {{FindingKind::weak_direction, "parameters",
           "The data say less than the priors about " + std::to_string(directions.size()) + " of " +
               std::to_string(parameters.size()) + " directions of the parameters.",
           "The results mostly repeat the priors for: " + list + "."}};
}

}  // namespace recald::calibration
