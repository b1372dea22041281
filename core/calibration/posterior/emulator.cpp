#include "core/calibration/posterior/emulator.hpp"

#include <Eigen/QR>
#include <cassert>
#include <string>
#include <utility>
#include <vector>

namespace recald::calibration {
namespace {

/// (runs x terms + 1): the constant first.
Eigen::MatrixXd features(const Eigen::MatrixXd& scaled,
                         const std::vector<regression::Term>& terms) {
  Eigen::MatrixXd x(scaled.rows(), static_cast<Eigen::Index>(terms.size()) + 1);
  x.col(0).setOnes();
  for (std::size_t k = 0; k < terms.size(); ++k) {
    auto column = x.col(static_cast<Eigen::Index>(k) + 1);
    column = scaled.col(terms[k].first);
    if (!terms[k].is_main_effect()) column.array() *= scaled.col(terms[k].second).array();
  }
  return x;
}

}  // namespace

Result<Emulator> emulate(const Eigen::MatrixXd& theta, const Eigen::MatrixXd& outputs,
                         int output_count, int month_count) {
  assert(outputs.rows() == theta.rows() &&
         outputs.cols() == Eigen::Index{output_count} * month_count);
  const std::vector<regression::Term> terms =
      regression::all_terms(static_cast<int>(theta.cols()), true);
  const auto coefficients = static_cast<Eigen::Index>(terms.size()) + 1;
  if (theta.rows() < 2 * coefficients) {
    return failure(ErrorCode::not_enough_data,
                   "an emulator of the model has " + std::to_string(coefficients) +
                       " coefficients and needs twice as many runs, not " +
                       std::to_string(theta.rows()));
  }
  std::vector<regression::ColumnScale> scales;
  Eigen::MatrixXd scaled = theta;
  for (Eigen::Index j = 0; j < theta.cols(); ++j) {
    scales.push_back({theta.col(j).minCoeff(), theta.col(j).maxCoeff()});
    scaled.col(j) = (theta.col(j).array() - scales.back().min) / scales.back().range();
  }
  const Eigen::MatrixXd x = features(scaled, terms);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr{x};
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(x.rows(), coefficients);
  const Eigen::MatrixXd fitted = qr.solve(outputs);
  // Residual of a run left out of the fit: its residual divided by one minus its leverage.
  const Eigen::ArrayXd unseen = 1.0 - q.rowwise().squaredNorm().array();
  const Eigen::MatrixXd left = ((outputs - x * fitted).array().colwise() / unseen).matrix();

  model::metamodel::QuadraticCoefficients collected{std::move(scales), output_count, month_count};
  for (int output = 0; output < output_count; ++output) {
    for (int month = 0; month < month_count; ++month) {
      const Eigen::Index row = output * month_count + month;
      collected.add_constant(output, month, fitted(0, row));
      for (std::size_t k = 0; k < terms.size(); ++k) {
        collected.add(output, month, terms[k], fitted(static_cast<Eigen::Index>(k) + 1, row));
      }
    }
  }
  return Emulator{
      model::metamodel::QuadraticModel{collected},
      (left.colwise().squaredNorm() / static_cast<double>(left.rows())).cwiseSqrt().transpose()};
}

void add_emulator_error(const Eigen::VectorXd& error_sd, int month_count, PosteriorData& data) {
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const auto& [output, month] = data.points[i];
    const double sd = error_sd(Eigen::Index{output} * month_count + month);
    data.extra_variances(static_cast<Eigen::Index>(i)) +=
        data.scales[static_cast<std::size_t>(output)].normalise_variance(sd * sd);
  }
}

}  // namespace recald::calibration
