/// Forty rows of three variables that R knows, too: no table to copy, the same formulas there.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

#include "core/regression/term.hpp"

namespace recald::regression {

/// i <- 0:39; a <- ((7*i)%%40)/39; b <- ((11*i+3)%%40)/39; c <- ((17*i+5)%%40)/39
inline Eigen::MatrixXd golden_variables() {
  Eigen::MatrixXd variables(40, 3);
  for (int i = 0; i < 40; ++i) {
    variables.row(i) << (7 * i) % 40 / 39.0, (11 * i + 3) % 40 / 39.0, (17 * i + 5) % 40 / 39.0;
  }
  return variables;
}

/// y <- 1 + 2*a - b + 0.5*c + 1.5*a*b + 0.1*sin(12.9898*i) + 0.08*cos(7.233*i)
inline Eigen::VectorXd golden_response() {
  const Eigen::MatrixXd v = golden_variables();
  Eigen::VectorXd y(40);
  for (int i = 0; i < 40; ++i) {
    y(i) = 1.0 + 2.0 * v(i, 0) - v(i, 1) + 0.5 * v(i, 2) + 1.5 * v(i, 0) * v(i, 1) +
           0.1 * std::sin(12.9898 * i) + 0.08 * std::cos(7.233 * i);
  }
  return y;
}

/// (rows x terms)
inline Eigen::MatrixXd columns_of(const Eigen::MatrixXd& variables, std::span<const Term> terms) {
  Eigen::MatrixXd columns(variables.rows(), static_cast<Eigen::Index>(terms.size()));
  for (std::size_t j = 0; j < terms.size(); ++j) {
    auto column = columns.col(static_cast<Eigen::Index>(j));
    column = variables.col(terms[j].first);
    if (!terms[j].is_main_effect()) column.array() *= variables.col(terms[j].second).array();
  }
  return columns;
}

}  // namespace recald::regression
