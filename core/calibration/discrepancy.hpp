/// The Gaussian process of what the model lacks, at the measured points.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace recald::calibration {

/// A measured point: which output in which month.
struct PointIndex {
  int output;
  int month;
};

/// Covariance of the discrepancy, eq. (4) of the seed:
///
///     C_ij = variance * exp( - sum_s beta_s D_s,ij )
///
/// D_s,ij is the squared distance of points i and j in model input s. When the points belong to
/// more than one output there is one more, last, dimension: D = 1 between points of different
/// outputs and 0 otherwise. For two outputs that is the seed's 0/1 dummy. For more it stays a valid
/// kernel where numbering the outputs 0, 1, 2, … would call the first and third less alike than
/// neighbours: with c = exp(-beta) <= 1 the factor between outputs is the matrix c 1 1' + (1 - c)
/// I, positive semi-definite, and products of such factors stay so (Schur).
///
/// The distances never change, so they are computed once. Points of one month differ in their
/// output alone, so exp() runs over pairs of months, not of points: a quarter of the work for two
/// outputs.
class DiscrepancyKernel {
 public:
  /// @param month_inputs  (months x p) model inputs scaled to [0, 1].
  /// @param points        Ordered by output, then by month, each at most once; at least one.
  DiscrepancyKernel(const Eigen::MatrixXd& month_inputs, std::vector<PointIndex> points);

  /// Length of beta: p, plus one where the points belong to more than one output.
  [[nodiscard]] Eigen::Index dimension() const {
    return distances_.cols() + (cross_output_ ? 1 : 0);
  }
  [[nodiscard]] Eigen::Index point_count() const { return static_cast<Eigen::Index>(row_.size()); }
  [[nodiscard]] bool has_output_dimension() const { return cross_output_; }

  /// Writes C into the lower triangle and diagonal of `covariance`; the rest is left alone.
  ///
  /// @param variance    1 / lambda_delta, normalised units squared.
  /// @param beta        (dimension) >= 0; infinity means no correlation at any distance.
  /// @param covariance  (points x points), already of that size.
  /// @note  Does not allocate. O(months^2 p + points^2).
  void covariance(double variance, const Eigen::VectorXd& beta, Eigen::MatrixXd& covariance);

 private:
  struct OutputRange {
    Eigen::Index begin;
    Eigen::Index end;
  };

  void correlate_months(const Eigen::VectorXd& beta);

  std::vector<Eigen::Index> row_;    ///< (points) row of the point's month in `correlation_`.
  std::vector<OutputRange> ranges_;  ///< Points of one output.
  bool cross_output_;
  Eigen::MatrixXd distances_;    ///< (pairs of months x p), strictly lower triangle by columns.
  Eigen::VectorXd packed_;       ///< (pairs of months) correlation, same order.
  Eigen::MatrixXd correlation_;  ///< (months x months) symmetric, unit diagonal.
};

}  // namespace recald::calibration
