/// A building model that is a sum of Gaussian processes of the parameters: a meta-model for the
/// months of a design.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/model/monthly_model.hpp"
#include "core/regression/monthly_form.hpp"

namespace recald::model::metamodel {

/// For each output, means of its months and patterns times how much there is of them, in the
/// outputs' own units (`regression::fit_monthly_form`).
///
/// With n runs, q parameters and P patterns over all outputs a run costs 2 P n q flops and P n
/// exponentials, the Jacobian 2 P n q flops more. Both go through the runs in blocks, so that a
/// block's share stays in the cache, and neither allocates.
class GaussianModel final : public MonthlyModel {
 public:
  /// @param months  Places in the form's months, in any order.
  GaussianModel(const regression::MonthlyForm& form, std::span<const int> months);

  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override;
  [[nodiscard]] int parameter_count() const override { return static_cast<int>(min_.size()); }
  [[nodiscard]] int output_count() const override { return outputs_; }
  [[nodiscard]] int month_count() const override { return months_; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override;

  [[nodiscard]] bool has_jacobian() const override { return true; }
  void evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                              std::span<double> jacobian) override;

 private:
  /// An output's patterns, which follow each other.
  struct Output {
    Eigen::Index first;        ///< Pattern.
    Eigen::MatrixXd loadings;  ///< (months x its patterns) in units, of one of each.
  };

  /// How much there is of each pattern. @param slopes  By the scaled parameters; null: not wanted.
  void find_amounts(std::span<const double> theta, Eigen::MatrixXd* slopes);

  int outputs_;
  int months_;
  std::vector<regression::ParameterCap> caps_;
  Eigen::VectorXd min_;            ///< (q)
  Eigen::VectorXd inverse_range_;  ///< (q)
  Eigen::VectorXd means_;          ///< (outputs * months)
  std::vector<Output> patterns_;   ///< (outputs)

  // Of pattern p at scaled parameters t, c = t - 1/2, there is
  // sum_i weight_ip exp(-1/2 sum_j relevance_jp (x_ij - t_j)^2) + constant_p + linear_p . c
  // + c' quadratic_p c.
  Eigen::MatrixXd points_;     ///< (n x q) x
  Eigen::MatrixXd relevance_;  ///< (q x P)
  Eigen::MatrixXd weights_;    ///< (n x P)
  Eigen::VectorXd constants_;  ///< (P)
  Eigen::MatrixXd linear_;     ///< (q x P)
  Eigen::MatrixXd quadratic_;  ///< (P * q x q), symmetric, one below the other.

  Eigen::VectorXd scaled_;       ///< (q) t
  Eigen::VectorXd centred_;      ///< (q) c
  Eigen::VectorXd bent_;         ///< (P * q) quadratic c
  Eigen::VectorXd amounts_;      ///< (P)
  Eigen::MatrixXd differences_;  ///< (block x q) x - t
  Eigen::MatrixXd squares_;      ///< (block x q)
  Eigen::MatrixXd parts_;        ///< (block x P) each run's part of each amount.
  Eigen::MatrixXd slopes_;       ///< (q x P)
};

}  // namespace recald::model::metamodel
