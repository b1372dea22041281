#include "core/diagnosis/naming/signature_null.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "core/diagnosis/naming/signatures.hpp"

namespace recald::diagnosis {

double SignatureNull::centre_of(const std::string& parameter) const {
  const auto found = centre.find(parameter);
  return found == centre.end() ? 0.0 : found->second;
}

double SignatureNull::reach_of(const std::string& parameter) const {
  constexpr double kLeast = 0.4;  // What few buildings have shown is not known better than that.
  const auto found = reach.find(parameter);
  return found == reach.end() ? 1.0 : std::max(found->second, kLeast);
}

SignatureMetric::SignatureMetric(const SignatureNull& null, const Eigen::VectorXd& there)
    : per_meter_(there.size() / static_cast<Eigen::Index>(kSignatureMeters)) {
  assert(null.spread.size() == there.size() && null.own.size() == there.size());
  assert(null.patterns.rows() == there.size());
  for (Eigen::Index i = 0; i < there.size(); ++i) {
    if (std::isfinite(there[i]) && std::isfinite(null.spread[i])) there_.push_back(i);
  }
  spread_ = null.spread(there_);
  const Eigen::MatrixXd patterns = null.patterns(there_, Eigen::all);
  Eigen::MatrixXd covariance = patterns * patterns.transpose();
  covariance.diagonal() += null.own(there_);
  root_ = covariance.llt().matrixL();
}

Eigen::MatrixXd SignatureMetric::whiten(const Eigen::Ref<const Eigen::MatrixXd>& changes,
                                        double most) const {
  Eigen::MatrixXd in_spreads = changes(there_, Eigen::all);
  in_spreads.array().colwise() /= spread_.array();
  in_spreads = in_spreads.unaryExpr(
      [&](double x) { return std::isfinite(x) ? std::clamp(x, -most, most) : 0.0; });
  return root_.triangularView<Eigen::Lower>().solve(in_spreads);
}

Eigen::VectorXd SignatureMetric::in_spreads(const Eigen::VectorXd& change, double most) const {
  Eigen::VectorXd of_entries = Eigen::VectorXd::Zero(change.size());
  for (Eigen::Index row = 0; row < count(); ++row) {
    const Eigen::Index entry = there_[static_cast<std::size_t>(row)];
    const double spreads = change[entry] / spread_[row];
    if (std::isfinite(spreads)) of_entries[entry] = std::clamp(spreads, -most, most);
  }
  return of_entries;
}

void SignatureMetric::widen(const Eigen::VectorXd& left) {
  std::array<double, kSignatureMeters> squares{};
  std::array<double, kSignatureMeters> counts{};
  const auto meter_of = [&](Eigen::Index row) {
    return static_cast<std::size_t>(there_[static_cast<std::size_t>(row)] / per_meter_);
  };
  for (Eigen::Index row = 0; row < count(); ++row) {
    squares[meter_of(row)] += left[row] * left[row];
    counts[meter_of(row)] += 1.0;
  }
  for (Eigen::Index row = 0; row < count(); ++row) {
    const std::size_t meter = meter_of(row);
    spread_[row] *= std::sqrt(std::max(squares[meter] / counts[meter], 1.0));
  }
}

}  // namespace recald::diagnosis
