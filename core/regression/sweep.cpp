#include "core/regression/sweep.hpp"

#include <cassert>

namespace recald::regression {

SweptProducts::SweptProducts(const CentredProducts& products)
    : a_(products.xx),
      b_(products.xy),
      residual_(products.yy),
      total_(products.xx.diagonal()),
      pivot_column_(products.xx.cols()),
      pivot_response_(products.xy.cols()),
      swept_(static_cast<std::size_t>(products.xx.cols()), false) {}

double SweptProducts::free_share(Eigen::Index j) const {
  assert(!swept(j));
  return total_(j) > 0.0 ? a_(j, j) / total_(j) : 0.0;
}

void SweptProducts::toggle(Eigen::Index j) {
  const bool out = swept(j);
  const Eigen::Index p = columns();
  const double pivot = a_(j, j);
  assert(out ? pivot < 0.0 : pivot > 0.0);
  pivot_column_.head(j) = a_.row(j).head(j).transpose();
  pivot_column_.tail(p - j) = a_.col(j).tail(p - j);
  pivot_response_ = b_.row(j);

  for (Eigen::Index k = 0; k < p; ++k) {
    const double factor = pivot_column_(k) / pivot;
    a_.col(k).tail(p - k).noalias() -= factor * pivot_column_.tail(p - k);
  }
  b_.noalias() -= (pivot_column_ / pivot) * pivot_response_;
  residual_ -= pivot_response_.cwiseAbs2().transpose() / pivot;

  // Row and column of the pivot itself; sweeping out only differs in the sign (Dempster's RSW).
  const double scale = (out ? -1.0 : 1.0) / pivot;
  a_.row(j).head(j) = scale * pivot_column_.head(j).transpose();
  a_.col(j).tail(p - j) = scale * pivot_column_.tail(p - j);
  a_(j, j) = -1.0 / pivot;
  b_.row(j) = scale * pivot_response_;
  swept_[static_cast<std::size_t>(j)] = !out;
  swept_count_ += out ? -1 : 1;
}

}  // namespace recald::regression
