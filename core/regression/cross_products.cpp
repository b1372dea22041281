#include "core/regression/cross_products.hpp"

#include <cassert>

namespace recald::regression {

CrossProducts& CrossProducts::operator+=(const CrossProducts& other) {
  rows += other.rows;
  x_sum += other.x_sum;
  y_sum += other.y_sum;
  xx += other.xx;
  xy += other.xy;
  yy += other.yy;
  return *this;
}

CrossProducts& CrossProducts::operator-=(const CrossProducts& other) {
  rows -= other.rows;
  x_sum -= other.x_sum;
  y_sum -= other.y_sum;
  xx -= other.xx;
  xy -= other.xy;
  yy -= other.yy;
  return *this;
}

CrossProducts cross_products(const Eigen::Ref<const Eigen::MatrixXd>& x,
                             const Eigen::Ref<const Eigen::MatrixXd>& y) {
  assert(x.rows() == y.rows());
  CrossProducts products;
  products.rows = static_cast<double>(x.rows());
  products.x_sum = x.colwise().sum();
  products.y_sum = y.colwise().sum();
  products.xx.setZero(x.cols(), x.cols());
  products.xx.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
  products.xx.triangularView<Eigen::StrictlyUpper>() = products.xx.transpose();
  products.xy.noalias() = x.transpose() * y;
  products.yy = y.colwise().squaredNorm();
  return products;
}

CentredProducts centre(const CrossProducts& products) {
  assert(products.rows > 0.0);
  CentredProducts centred;
  centred.rows = products.rows;
  centred.x_mean = products.x_sum / products.rows;
  centred.y_mean = products.y_sum / products.rows;
  centred.xx = products.xx;
  centred.xx.noalias() -= centred.x_mean * products.x_sum.transpose();
  centred.xy = products.xy;
  centred.xy.noalias() -= centred.x_mean * products.y_sum.transpose();
  centred.yy = products.yy - centred.y_mean.cwiseProduct(products.y_sum);
  // Rounding may leave a constant response or column a hair below zero.
  centred.yy = centred.yy.cwiseMax(0.0);
  centred.xx.diagonal() = centred.xx.diagonal().cwiseMax(0.0);
  return centred;
}

}  // namespace recald::regression
