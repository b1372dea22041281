/// The Gaussian process of the model discrepancy, at the measured points.
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
/// D_s,ij is the squared distance of points i and j in model input s. If the points belong to more
/// than one output, there is one additional, last dimension: D = 1 between points of different
/// outputs and 0 otherwise. For two outputs this is the seed's 0/1 dummy. For more it is still a
/// valid kernel, while numbering the outputs 0, 1, 2, … would make the first and third less similar
/// than neighbours: with c = exp(-beta) <= 1 the factor between outputs is the matrix c 1 1' + (1 -
/// c) I, positive semi-definite, and products of such factors are too (Schur).
///
/// The distances never change, so they are computed once. Points of one month differ only in their
/// output, so exp() is evaluated for pairs of months, not of points: a quarter of the work for two
/// outputs. Pairs of months are packed: the strictly lower triangle, column by column.
class DiscrepancyKernel {
 public:
  /// @param month_inputs  (months x p) model inputs scaled to [0, 1].
  /// @param points        Ordered by output, then by month, each at most once; at least one.
  DiscrepancyKernel(const Eigen::MatrixXd& month_inputs, std::vector<PointIndex> points);

  /// Length of beta: p, plus one if the points belong to more than one output.
  [[nodiscard]] Eigen::Index dimension() const { return input_count() + (cross_output_ ? 1 : 0); }
  [[nodiscard]] Eigen::Index input_count() const { return distances_.cols(); }
  [[nodiscard]] Eigen::Index point_count() const { return static_cast<Eigen::Index>(row_.size()); }
  [[nodiscard]] Eigen::Index month_count() const { return months_; }
  [[nodiscard]] Eigen::Index output_count() const {
    return static_cast<Eigen::Index>(ranges_.size());
  }
  [[nodiscard]] bool has_output_dimension() const { return cross_output_; }
  /// Whether every output has a point in every month.
  [[nodiscard]] bool is_complete() const { return point_count() == output_count() * months_; }

  /// Computes the correlation of every pair of different months.
  ///
  /// @param beta  (dimension) >= 0; infinity means no correlation at any distance. The output
  ///              dimension, if any, is not used.
  /// @note  Does not allocate. O(months^2 p).
  void correlate_months(const Eigen::VectorXd& beta);
  /// (pairs) the last result, packed.
  [[nodiscard]] const Eigen::VectorXd& month_correlations() const { return packed_; }

  /// Writes C into the lower triangle and diagonal of `covariance`; the rest is unchanged.
  ///
  /// @param variance    1 / lambda_delta, normalised units squared.
  /// @param beta        (dimension) >= 0
  /// @param covariance  (points x points), already of that size.
  /// @note  Does not allocate. O(months^2 p + points^2).
  void covariance(double variance, const Eigen::VectorXd& beta, Eigen::MatrixXd& covariance);

  /// The sums needed for a derivative of the log-likelihood,  sum_ij W_ij C_ij D_s,ij / 2.
  struct Sums {
    double same_output = 0.0;   ///< sum_ij W_ij C_ij / 2 over pairs of the same output and i = j.
    double cross_output = 0.0;  ///< As above, over pairs of different outputs.
  };

  /// @param weights     W (points x points), lower triangle.
  /// @param covariance  C, lower triangle, as written by `covariance`.
  /// @param by_pair     (pairs of months) receives the sum of W_ij C_ij over the pairs of points of
  ///                    these two months, each pair of points once.
  Sums sum_products(const Eigen::MatrixXd& weights, const Eigen::MatrixXd& covariance,
                    Eigen::VectorXd& by_pair) const;

  /// Squared distances of months, (pairs of months x p).
  [[nodiscard]] const Eigen::MatrixXd& distances() const { return distances_; }

 private:
  struct OutputRange {
    Eigen::Index begin;
    Eigen::Index end;
  };

  /// Position of the pair of month rows i > j in packed order.
  [[nodiscard]] Eigen::Index pair_index(Eigen::Index i, Eigen::Index j) const {
    return j * months_ - j * (j + 1) / 2 + (i - j - 1);
  }

  std::vector<Eigen::Index> row_;    ///< (points) row of the point's month among those in use.
  std::vector<OutputRange> ranges_;  ///< Points of one output.
  bool cross_output_;
  Eigen::Index months_;          ///< In use.
  Eigen::MatrixXd distances_;    ///< (pairs of months x p), packed.
  Eigen::VectorXd packed_;       ///< (pairs of months) correlation.
  Eigen::MatrixXd correlation_;  ///< (months x months) symmetric, unit diagonal.
};

}  // namespace recald::calibration
