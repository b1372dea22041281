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
/// exponentials, the Jacobian as much again; neither allocates.
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
  /// How much there is of a pattern, t being the scaled parameters and c = t - 1/2:
  /// sum_i weight_i exp(-|p_i - root t|^2 / 2) + constant + linear . c + c' quadratic c.
  struct Amount {
    Eigen::VectorXd root;        ///< (q) square root of the relevance.
    Eigen::MatrixXd points;      ///< (n x q) p, scaled by `root`.
    Eigen::VectorXd half_norms;  ///< (n) |p|^2 / 2
    Eigen::VectorXd weights;     ///< (n)
    double constant;
    Eigen::VectorXd linear;     ///< (q)
    Eigen::MatrixXd quadratic;  ///< (q x q), symmetric.
    Eigen::Index first_row;     ///< Of its output.
    Eigen::VectorXd loadings;   ///< (months) in units, of one.
  };

  void scale(std::span<const double> theta);
  /// @return how much; leaves each run's part of it in `parts_`.
  double amount_at_scaled(const Amount& amount);

  int outputs_;
  int months_;
  std::vector<regression::ParameterCap> caps_;
  Eigen::VectorXd min_;            ///< (q)
  Eigen::VectorXd inverse_range_;  ///< (q)
  Eigen::VectorXd means_;          ///< (outputs * months)
  std::vector<Amount> amounts_;
  Eigen::VectorXd scaled_;   ///< (q) t
  Eigen::VectorXd centred_;  ///< (q) c
  Eigen::VectorXd rooted_;   ///< (q) root t
  Eigen::VectorXd slope_;    ///< (q) of an amount by t.
  Eigen::VectorXd parts_;    ///< (n)
};

}  // namespace recald::model::metamodel
