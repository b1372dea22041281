/// A building model that is a quadratic polynomial in the parameters: a meta-model
/// for fixed months.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/model/monthly_model.hpp"
#include "core/regression/design_data.hpp"
#include "core/regression/term.hpp"

namespace recald::model::metamodel {

/// Collects the coefficients of a QuadraticModel; repeated ones for the same place add up.
class QuadraticCoefficients {
 public:
  /// @param parameter_scales  (q) values at 0 and 1 on the scaled axis t_j.
  QuadraticCoefficients(std::vector<regression::ColumnScale> parameter_scales, int outputs,
                        int months);

  void add_constant(int output, int month, double value);
  /// @param term  Main effect, square or product of scaled parameters, in either order.
  void add(int output, int month, regression::Term term, double coefficient);

 private:
  friend class QuadraticModel;

  [[nodiscard]] Eigen::Index row(int output, int month) const;
  [[nodiscard]] Eigen::Index column(regression::Term term) const;

  std::vector<regression::ColumnScale> scales_;
  int outputs_;
  int months_;
  std::vector<regression::Term> terms_;  ///< All main effects, squares and products.
  Eigen::VectorXd constants_;            ///< (outputs * months), output-major.
  Eigen::MatrixXd coefficients_;         ///< (outputs * months x terms)
};

/// f_i(theta) = c_i + sum_j b_ij t_j + sum_{j <= k} b_ijk t_j t_k for every output and month i,
/// with t_j = (theta_j - min_j) / (max_j - min_j), in the outputs' own units.
///
/// Terms that no output uses are left out. `evaluate` is one product of a (rows x terms) matrix and
/// a vector, and the Jacobian at most two; neither allocates.
class QuadraticModel final : public MonthlyModel {
 public:
  explicit QuadraticModel(const QuadraticCoefficients& coefficients);

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override;
  [[nodiscard]] int parameter_count() const override { return static_cast<int>(scaled_.size()); }
  [[nodiscard]] int output_count() const override { return outputs_; }
  [[nodiscard]] int month_count() const override { return months_; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override;

  [[nodiscard]] bool has_jacobian() const override { return true; }
  void evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                              std::span<double> jacobian) override;

  /// Terms that some output uses, without the constant.
  [[nodiscard]] std::span<const regression::Term> terms() const { return terms_; }

 private:
  int outputs_;
  int months_;
  std::vector<regression::Term> terms_;
  Eigen::VectorXd min_;            ///< (q)
  Eigen::VectorXd inverse_range_;  ///< (q)
  Eigen::VectorXd constants_;      ///< (rows)
  Eigen::MatrixXd coefficients_;   ///< (rows x terms)
  Eigen::VectorXd scaled_;         ///< (q) t
  Eigen::VectorXd basis_;          ///< (terms) products of t
};

}  // namespace recald::model::metamodel
