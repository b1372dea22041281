#include "core/regression/monthly_form.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/random/rng.hpp"
#include "core/random/streams.hpp"
#include "core/regression/folds.hpp"

namespace recald::regression {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of an output's variance that patterns may leave. Months with next to no load are described by
/// the last ones.
constexpr double kShareLeft = 1e-5;
constexpr Index kMostPatterns = 8;
/// A variance on the normalised scale that is rounding.
constexpr double kNoSpread = 1e-20;
constexpr std::uint64_t kOrderSeed = 1;

/// The runs in random order: those that the processes go through, then the others.
struct Rows {
  std::vector<int> used;
  std::vector<int> others;
};

/// A folder of runs may be in any order, and a process is chosen on the first of them.
Rows shuffled_rows(Index runs) {
  Rng rng{kOrderSeed, streams::kFolds.first};
  std::vector<int> order = random_order(static_cast<int>(runs), rng);
  const auto used = order.begin() + std::min<Index>(kRunsUsedMax, runs);
  return {{order.begin(), used}, {used, order.end()}};
}

/// What a fit says of the runs, on the normalised scale.
struct Predicted {
  MatrixXd fitted;    ///< (runs x months)
  MatrixXd left_out;  ///< Each run without itself.
};

/// @param points  (runs x q) of all runs.
/// @param y       (runs x months)
/// @param kernel  Where the search for the first pattern's kernel begins; set to what it found.
MonthlyFormOutput fit_output(const MatrixXd& points, const Rows& rows, const MatrixXd& y,
                             Kernel& kernel, Predicted& predicted) {
  MonthlyFormOutput output{y.colwise().mean(), {}};
  const MatrixXd about_means = y.rowwise() - output.means.transpose();
  const auto runs = static_cast<double>(y.rows());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver{about_means.transpose() * about_means /
                                                       runs};
  const VectorXd& variances = solver.eigenvalues();  // ascending
  const double total = variances.sum();
  double left = total;
  predicted.fitted = predicted.left_out = output.means.transpose().replicate(y.rows(), 1);
  const MatrixXd used = points(rows.used, Eigen::all);
  const MatrixXd others = points(rows.others, Eigen::all);
  const Index last = std::max<Index>(variances.size() - kMostPatterns, 0);
  for (Index i = variances.size() - 1; i >= last; --i) {
    if (left <= kShareLeft * total || variances(i) <= kNoSpread) break;
    left -= variances(i);
    const double sd = std::sqrt(variances(i));
    const VectorXd direction = solver.eigenvectors().col(i);
    const VectorXd amounts = about_means * direction / sd;
    const VectorXd used_amounts = amounts(rows.used);
    MonthPattern pattern{sd * direction, fit_gaussian_process(used, used_amounts, kernel)};
    const GaussianProcess& process = pattern.amount;
    // Noise of the simulation: its mean predicts it as well.
    if (process.left_out.squaredNorm() > used_amounts.squaredNorm()) continue;
    if (output.patterns.empty()) kernel = process.kernel;
    VectorXd fitted = amounts;
    VectorXd left_out = amounts;
    fitted(rows.used) -= process.kernel.noise * process.weights;
    left_out(rows.used) -= process.left_out;
    fitted(rows.others) = kernel_values(process.kernel, others, used) * process.weights;
    left_out(rows.others) = fitted(rows.others);
    predicted.fitted += fitted * pattern.loadings.transpose();
    predicted.left_out += left_out * pattern.loadings.transpose();
    output.patterns.push_back(std::move(pattern));
  }
  return output;
}

}  // namespace

Result<MonthlyForm> fit_monthly_form(const DesignData& design) {
  TRY(check_design(design));
  MonthlyForm form;
  form.parameters = design.parameters;
  form.caps = design.caps;
  const MatrixXd theta = capped(design.theta, design.caps);
  form.parameter_scales = column_scales(theta);
  const MatrixXd points = scale_columns(theta, form.parameter_scales);
  const Rows rows = shuffled_rows(points.rows());
  form.points = points(rows.used, Eigen::all);
  form.months = design.months;
  form.outputs = design.outputs;
  form.output_scales = output_scales(design);
  const MatrixXd y = normalise_outputs(design, form.output_scales);
  const Index months = design.month_count();
  MatrixXd fitted(y.rows(), y.cols());
  MatrixXd left_out(y.rows(), y.cols());
  Kernel kernel = usual_kernel(points.cols());
  for (Index k = 0; k < std::ssize(form.outputs); ++k) {
    Predicted predicted;
    form.fits.push_back(
        fit_output(points, rows, y.middleCols(k * months, months), kernel, predicted));
    fitted.middleCols(k * months, months) = predicted.fitted;
    left_out.middleCols(k * months, months) = predicted.left_out;
  }
  form.quality = assess_fit(design, form.output_scales, fitted, left_out);
  return form;
}

}  // namespace recald::regression
