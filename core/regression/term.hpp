/// The terms of a regression: main effects, squares and two-factor products of named variables.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace recald::regression {

/// One term; the intercept is not a term, every regression has it.
struct Term {
  int first;        ///< Index of a variable.
  int second = -1;  ///< -1: main effect. Equal to `first`: a square.

  [[nodiscard]] bool is_main_effect() const { return second < 0; }
  [[nodiscard]] bool is_square() const { return first == second; }
  bool operator==(const Term&) const = default;
};

/// Terms that have to be in a model before this one may be; -1: none.
///
/// A product needs the main effects of its factors. Without them its coefficient would depend on
/// where the zero of each variable lies.
using Parents = std::array<int, 2>;

/// Main effects in the order of the variables, then (if asked) their squares, then the products in
/// the order of R's `y ~ .^2`: 1:2, 1:3, …, 2:3, …
[[nodiscard]] std::vector<Term> all_terms(int variables, bool squares);

/// @pre every factor of a square or product has its main effect among `terms`.
[[nodiscard]] std::vector<Parents> parents_of(std::span<const Term> terms);

/// "a", "a^2" or "a:b".
[[nodiscard]] std::string term_name(const Term& term, std::span<const std::string> variables);

}  // namespace recald::regression
