/// The seed's regression rows, one a run, month and output type, without writing them out.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/regression/cross_products.hpp"
#include "core/regression/stepwise.hpp"
#include "core/regression/term.hpp"

namespace recald::regression {

/// A full crossing of runs with cells (a cell is a month and output type).
///
/// Every column of the long form is u(cell) v(run): month inputs and the type vary over cells,
/// parameters over runs. So a sum over all rows is a sum over cells times a sum over runs,
///   sum_rows (u v)(u' v') = (U'U) (V'V),   X'y = elements of V'YU,
/// and 200 runs x 48 cells x 561 columns cost as much as 200 rows do.
class LongForm {
 public:
  /// @param cells      (cells x a) variables 0 … a - 1, the same in every run.
  /// @param runs       (runs x q) variables a … a + q - 1, the same in every cell.
  /// @param responses  (runs x cells)
  LongForm(const Eigen::MatrixXd& cells, const Eigen::MatrixXd& runs, std::span<const Term> terms,
           Eigen::MatrixXd responses);

  /// Over the rows of some runs; one response.
  [[nodiscard]] CrossProducts products(std::span<const int> runs) const;
  [[nodiscard]] CrossProducts products() const;

  /// (runs given x cells)
  [[nodiscard]] Eigen::MatrixXd predict(const StepwiseFit& fit, std::span<const int> runs) const;

 private:
  /// Which factor of a cell and which of a run a term is made of; 0 is the constant 1.
  struct Factors {
    Eigen::Index cell = 0;
    Eigen::Index run = 0;
  };

  std::vector<Factors> terms_;
  Eigen::MatrixXd cell_factors_;  ///< U (cells x factors)
  Eigen::MatrixXd run_factors_;   ///< V (runs x factors)
  Eigen::MatrixXd responses_;
  Eigen::MatrixXd cell_products_;  ///< U'U
};

}  // namespace recald::regression
