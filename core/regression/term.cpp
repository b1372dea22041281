#include "core/regression/term.hpp"

#include <algorithm>
#include <cassert>

namespace recald::regression {

std::vector<Term> all_terms(int variables, bool squares) {
  std::vector<Term> terms;
  for (int a = 0; a < variables; ++a) terms.push_back({a});
  if (squares) {
    for (int a = 0; a < variables; ++a) terms.push_back({a, a});
  }
  for (int a = 0; a < variables; ++a) {
    for (int b = a + 1; b < variables; ++b) terms.push_back({a, b});
  }
  return terms;
}

std::vector<Parents> parents_of(std::span<const Term> terms) {
  const auto main_effect = [&terms](int variable) {
    const auto found = std::find(terms.begin(), terms.end(), Term{variable});
    assert(found != terms.end());
    return static_cast<int>(found - terms.begin());
  };
  std::vector<Parents> parents;
  for (const Term& term : terms) {
    if (term.is_main_effect()) {
      parents.push_back({-1, -1});
    } else if (term.is_square()) {
      parents.push_back({main_effect(term.first), -1});
    } else {
      parents.push_back({main_effect(term.first), main_effect(term.second)});
    }
  }
  return parents;
}

std::string term_name(const Term& term, std::span<const std::string> variables) {
  const std::string& first = variables[static_cast<std::size_t>(term.first)];
  if (term.is_main_effect()) return first;
  if (term.is_square()) return first + "^2";
  return first + ":" + variables[static_cast<std::size_t>(term.second)];
}

}  // namespace recald::regression
