#include "core/savings/drawn_errors.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/calibration/posterior/posterior.hpp"

namespace recald::savings {
namespace {

using calibration::PosteriorData;
using Eigen::Index;

/// No meter reads next to nothing of what the building uses.
constexpr double kLeastLevel = 0.05;

/// A draw of N(mean, covariance), whose covariance may be singular.
Eigen::VectorXd draw_normal(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                            Rng& rng) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(covariance);
  Eigen::VectorXd scores(mean.size());
  for (double& score : scores) score = rng.normal();
  return mean +
         parts.eigenvectors() *
             (parts.eigenvalues().cwiseMax(0.0).cwiseSqrt().array() * scores.array()).matrix();
}

}  // namespace

Result<DrawnErrors> draw_errors(const calibration::CalibrationProblem& problem,
                                std::span<const assessment::CommonError> errors,
                                const calibration::Calibration& calibration,
                                const calibration::ThinnedDraws& draws,
                                const Eigen::MatrixXd& simulated, std::span<const Limits> limits,
                                Rng& rng) {
  assert(errors.size() == problem.common_errors.size());
  const auto outputs = std::ssize(problem.outputs);
  const auto months = std::ssize(problem.month_names);
  const PosteriorData data = normalise_problem(problem, calibration.normalisation);
  const auto covariance = calibration::make_covariance(data, calibration.hyper_prior);
  const Eigen::MatrixXd& directions = data.common_errors;
  Eigen::MatrixXd precision(data.values.size(), data.values.size());
  Eigen::VectorXd residual(data.values.size());
  DrawnErrors drawn{draws.theta, Eigen::MatrixXd::Ones(draws.theta.rows(), outputs)};
  for (Index d = 0; d < draws.theta.rows(); ++d) {
    const auto& chain =
        calibration.chains[static_cast<std::size_t>(draws.chain[static_cast<std::size_t>(d)])];
    const int row = draws.iteration[static_cast<std::size_t>(d)];
    bool jittered = false;
    if (!calibration::factorise(*covariance,
                                {chain.discrepancy_precision(row), chain.error_precision(row),
                                 chain.beta.row(row).transpose()},
                                jittered)) {
      return failure(ErrorCode::not_positive_definite,
                     "the covariance of the measured months has no Cholesky factor at a draw of "
                     "the posterior; the assumed measurement error is far too small");
    }
    for (Index p = 0; p < residual.size(); ++p) {
      const calibration::PointIndex& point = data.points[static_cast<std::size_t>(p)];
      residual(p) = data.values(p) - data.scales[static_cast<std::size_t>(point.output)].normalise(
                                         simulated(d, point.output * months + point.month));
    }
    covariance->precision(precision);
    const Eigen::MatrixXd weighted = directions.transpose() * precision;
    const Eigen::VectorXd mean = weighted * residual;
    if (!mean.allFinite()) {
      return failure(ErrorCode::not_finite,
                     "the model gives a value that is not finite at a draw of the posterior");
    }
    const Index count = directions.cols();
    const Eigen::VectorXd z =
        draw_normal(mean, Eigen::MatrixXd::Identity(count, count) - weighted * directions, rng);
    for (Index e = 0; e < count; ++e) {
      const assessment::CommonError& error = errors[static_cast<std::size_t>(e)];
      const auto of = static_cast<Index>(error.of);
      if (error.kind == assessment::CommonError::Kind::parameter) {
        drawn.theta(d, of) += error.sd * z(e);
      } else if (error.kind == assessment::CommonError::Kind::level) {
        drawn.level(d, of) *= std::max(1.0 + error.sd * z(e), kLeastLevel);
      }
    }
    for (Index j = 0; j < drawn.theta.cols(); ++j) {
      const Limits& limit = limits[static_cast<std::size_t>(j)];
      drawn.theta(d, j) = std::clamp(drawn.theta(d, j), limit.least, limit.most);
    }
  }
  return drawn;
}

double ResponseErrors::of(assessment::Service service) const {
  switch (service) {
    case assessment::Service::electricity:
      return electricity;
    case assessment::Service::cooling:
      return cooling;
    case assessment::Service::heating:
      break;
  }
  return heating;
}

const ResponseErrors& response_errors(ModelKind kind) {
  static const ResponseErrors of_epc{.electricity = 0.20, .cooling = 0.25, .heating = 0.50};
  static const ResponseErrors of_hourly{.electricity = 0.20, .cooling = 0.25, .heating = 0.50};
  // Assumed: half of a monthly balance's. What a detailed simulation of a real building is off by
  // where a measure was carried out has not been measured.
  static const ResponseErrors of_energyplus{.electricity = 0.10, .cooling = 0.12, .heating = 0.25};
  switch (kind) {
    case ModelKind::hourly:
      return of_hourly;
    case ModelKind::energyplus:
      return of_energyplus;
    default:
      return of_epc;
  }
}

Eigen::MatrixXd draw_responses(Eigen::Index draws, std::span<const assessment::Service> services,
                               const ResponseErrors& sizes, Rng& rng) {
  Eigen::MatrixXd factors(draws, std::ssize(services));
  for (Index d = 0; d < draws; ++d) {
    for (std::size_t k = 0; k < services.size(); ++k) {
      factors(d, static_cast<Index>(k)) = std::exp(sizes.of(services[k]) * rng.normal());
    }
  }
  return factors;
}

Eigen::MatrixXd draw_missed(Eigen::Index draws, Eigen::Index outputs, Rng& rng) {
  Eigen::MatrixXd shares(draws, outputs);
  for (double& share : shares.reshaped()) share = kMissedShare * rng.normal();
  return shares;
}

}  // namespace recald::savings
