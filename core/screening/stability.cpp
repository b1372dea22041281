#include "core/screening/stability.hpp"

#include <cassert>
#include <vector>

#include "core/regression/cross_products.hpp"
#include "core/regression/folds.hpp"

namespace recald::screening {

Result<Eigen::MatrixXd> select_on_halves(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y,
                                         double penalty, Rng& rng, const StabilityOptions& options,
                                         const LassoOptions& lasso) {
  assert(x.rows() == y.rows() && x.rows() >= 4 && options.half_samples >= 1);
  const regression::CrossProducts total = regression::cross_products(x, y);
  const int pairs = (options.half_samples + 1) / 2;
  Eigen::MatrixXd selected = Eigen::MatrixXd::Zero(2 * pairs, x.cols());
  for (int pair = 0; pair < pairs; ++pair) {
    std::vector<int> half = regression::random_order(static_cast<int>(x.rows()), rng);
    half.resize(half.size() / 2);
    const regression::CrossProducts first =
        regression::cross_products(x(half, Eigen::all), y(half, Eigen::all));
    regression::CrossProducts second = total;
    second -= first;
    for (int which = 0; which < 2; ++which) {
      const StandardisedProducts products(regression::centre(which == 0 ? first : second));
      const auto fit = TRY(fit_lasso(products, penalty, lasso));
      for (Eigen::Index j = 0; j < x.cols(); ++j) {
        if (fit.selects(j)) selected(2 * pair + which, j) = 1.0;
      }
    }
  }
  return selected;
}

}  // namespace recald::screening
