#include "core/calibration/posterior/points_at_draw.hpp"

#include <cmath>

namespace recald::calibration {

PointsAtDraw::PointsAtDraw(const PosteriorData& data, const HyperPrior& prior)
    : covariance_(make_covariance(data, prior)),
      precision_(data.values.size(), data.values.size()) {}

Result<void> PointsAtDraw::go_to(const ChainDraws& chain, Eigen::Index row,
                                 const Eigen::VectorXd& residual) {
  bool jittered = false;
  if (!factorise(*covariance_,
                 {chain.discrepancy_precision(row), chain.error_precision(row),
                  chain.beta.row(row).transpose()},
                 jittered)) {
    return failure(ErrorCode::not_positive_definite,
                   "the covariance of the measured points has no Cholesky factor at a draw of the "
                   "posterior; the assumed measurement error is far too small");
  }
  residual_ = residual;
  covariance_->precision(precision_);
  weighted_ = precision_ * residual_;
  if (weighted_.allFinite()) return {};
  return failure(ErrorCode::not_finite,
                 "the model gives a value that is not finite at a draw of the posterior");
}

PointNormal PointsAtDraw::given_others(Eigen::Index point) const {
  const double precision = precision_(point, point);
  return {residual_(point) - weighted_(point) / precision, 1.0 / std::sqrt(precision)};
}

}  // namespace recald::calibration
