/// Which runs are left out together in a cross-validation.
#pragma once

#include <span>
#include <vector>

#include "core/random/rng.hpp"

namespace recald::regression {

/// The runs of a design dealt at random into folds whose sizes differ by at most one.
///
/// Folds are of runs, never of rows: the months of one run share its parameters, so a model that
/// has seen eleven of them has seen the twelfth, and rows left out singly would flatter it.
class RunFolds {
 public:
  /// Fewer runs than folds are left out one by one. @pre 2 <= folds, 2 <= runs
  RunFolds(int runs, int folds, Rng& rng);

  [[nodiscard]] int count() const { return static_cast<int>(left_out_.size()); }
  /// Ascending indices of the runs of fold f.
  [[nodiscard]] std::span<const int> left_out(int f) const {
    return left_out_[static_cast<std::size_t>(f)];
  }
  /// Ascending indices of all others.
  [[nodiscard]] std::vector<int> kept(int f) const;

 private:
  int runs_;
  std::vector<std::vector<int>> left_out_;
};

/// 0, …, count - 1 in random order (Fisher and Yates).
[[nodiscard]] std::vector<int> random_order(int count, Rng& rng);

}  // namespace recald::regression
