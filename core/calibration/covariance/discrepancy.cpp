#include "core/calibration/covariance/discrepancy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::calibration {
namespace {

/// Months with at least one point, ascending.
std::vector<int> months_in_use(const std::vector<PointIndex>& points) {
  std::vector<int> months;
  months.reserve(points.size());
  for (const PointIndex& point : points) months.push_back(point.month);
  std::sort(months.begin(), months.end());
  months.erase(std::unique(months.begin(), months.end()), months.end());
  return months;
}

[[maybe_unused]] bool ordered(const std::vector<PointIndex>& points) {
  return std::adjacent_find(
             points.begin(), points.end(), [](const PointIndex& a, const PointIndex& b) {
               return a.output > b.output || (a.output == b.output && a.month >= b.month);
             }) == points.end();
}

}  // namespace

DiscrepancyKernel::DiscrepancyKernel(const Eigen::MatrixXd& month_inputs,
                                     std::vector<PointIndex> points) {
  assert(!points.empty() && ordered(points));
  const std::vector<int> months = months_in_use(points);
  months_ = static_cast<Eigen::Index>(months.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto month = std::lower_bound(months.begin(), months.end(), points[i].month);
    row_.push_back(month - months.begin());
    const auto index = static_cast<Eigen::Index>(i);
    if (i == 0 || points[i].output != points[i - 1].output) ranges_.push_back({index, index});
    ranges_.back().end = index + 1;
  }
  cross_output_ = ranges_.size() > 1;

  distances_.resize(months_ * (months_ - 1) / 2, month_inputs.cols());
  Eigen::Index pair = 0;
  for (std::size_t j = 0; j < months.size(); ++j) {
    for (std::size_t i = j + 1; i < months.size(); ++i) {
      distances_.row(pair++) =
          (month_inputs.row(months[i]) - month_inputs.row(months[j])).array().square();
    }
  }
  packed_.resize(distances_.rows());
  correlation_ = Eigen::MatrixXd::Identity(months_, months_);
}

void DiscrepancyKernel::correlate_months(const Eigen::VectorXd& beta) {
  assert(beta.size() == dimension());
  // Infinite beta times zero distance would be NaN; the largest double has the same effect.
  constexpr double beta_max = 1e300;
  packed_.setZero();
  for (Eigen::Index s = 0; s < distances_.cols(); ++s) {
    packed_ -= std::min(beta(s), beta_max) * distances_.col(s);
  }
  for (double& value : packed_) value = std::exp(value);
}

void DiscrepancyKernel::covariance(double variance, const Eigen::VectorXd& beta,
                                   Eigen::MatrixXd& covariance) {
  assert(covariance.rows() == point_count() && covariance.cols() == point_count());
  correlate_months(beta);
  const double* packed = packed_.data();
  for (Eigen::Index j = 0; j < months_; ++j) {
    for (Eigen::Index i = j + 1; i < months_; ++i) {
      correlation_(i, j) = *packed;
      correlation_(j, i) = *packed++;
    }
  }
  const double between_outputs = cross_output_ ? variance * std::exp(-beta(beta.size() - 1)) : 0.0;
  for (std::size_t b = 0; b < ranges_.size(); ++b) {
    for (Eigen::Index j = ranges_[b].begin; j < ranges_[b].end; ++j) {
      const double* of_month = correlation_.col(row_[static_cast<std::size_t>(j)]).data();
      double* column = covariance.col(j).data();
      for (std::size_t a = b; a < ranges_.size(); ++a) {
        const double factor = a == b ? variance : between_outputs;
        const Eigen::Index end = ranges_[a].end;
        for (Eigen::Index i = std::max(ranges_[a].begin, j); i < end; ++i) {
          column[i] = factor * of_month[row_[static_cast<std::size_t>(i)]];
        }
      }
    }
  }
}

DiscrepancyKernel::Sums DiscrepancyKernel::sum_products(const Eigen::MatrixXd& weights,
                                                        const Eigen::MatrixXd& covariance,
                                                        Eigen::VectorXd& by_pair) const {
  assert(by_pair.size() == distances_.rows());
  by_pair.setZero();
  Sums sums;
  for (std::size_t b = 0; b < ranges_.size(); ++b) {
    for (Eigen::Index j = ranges_[b].begin; j < ranges_[b].end; ++j) {
      const Eigen::Index month_j = row_[static_cast<std::size_t>(j)];
      sums.same_output += 0.5 * weights(j, j) * covariance(j, j);
      for (std::size_t a = b; a < ranges_.size(); ++a) {
        double& sum = a == b ? sums.same_output : sums.cross_output;
        for (Eigen::Index i = std::max(ranges_[a].begin, j + 1); i < ranges_[a].end; ++i) {
          const double product = weights(i, j) * covariance(i, j);
          sum += product;
          const Eigen::Index month_i = row_[static_cast<std::size_t>(i)];
          if (month_i == month_j) continue;
          by_pair(pair_index(std::max(month_i, month_j), std::min(month_i, month_j))) += product;
        }
      }
    }
  }
  return sums;
}

}  // namespace recald::calibration
