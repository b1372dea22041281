#include "core/regression/folds.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace recald::regression {

std::vector<int> random_order(int count, Rng& rng) {
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(rng.below(i))]);
  }
  return order;
}

RunFolds::RunFolds(int runs, int folds, Rng& rng)
    : runs_(runs), left_out_(static_cast<std::size_t>(std::min(folds, runs))) {
  assert(folds >= 2 && runs >= 2);
  const std::vector<int> order = random_order(runs, rng);
  for (std::size_t i = 0; i < order.size(); ++i) {
    left_out_[i % left_out_.size()].push_back(order[i]);
  }
  for (auto& fold : left_out_) std::sort(fold.begin(), fold.end());
}

std::vector<int> RunFolds::kept(int f) const {
  std::vector<int> runs;
  const auto out = left_out(f);
  for (int r = 0; r < runs_; ++r) {
    if (!std::binary_search(out.begin(), out.end(), r)) runs.push_back(r);
  }
  return runs;
}

}  // namespace recald::regression
