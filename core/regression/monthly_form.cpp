#include "core/regression/monthly_form.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

namespace recald::regression {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of an output's spread that patterns may leave. Months with next to no load live off the last.
constexpr double kShareLeft = 1e-5;
constexpr Index kMostPatterns = 8;

/// What a fit says of the runs, on the normalised scale.
struct Predicted {
  MatrixXd fitted;    ///< (runs x months)
  MatrixXd left_out;  ///< Each run without itself.
};

/// @param y       (runs x months)
/// @param kernel  Where the search for kernels begins; set to the last one found.
MonthlyFormOutput fit_output(const MatrixXd& points, const MatrixXd& y, Kernel& kernel,
                             Predicted& predicted) {
  MonthlyFormOutput output{y.colwise().mean(), {}};
  const MatrixXd about_means = y.rowwise() - output.means.transpose();
  const auto runs = static_cast<double>(y.rows());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver{about_means.transpose() * about_means /
                                                       runs};
  const VectorXd& variances = solver.eigenvalues();  // ascending
  const double total = variances.sum();
  double left = total;
  predicted.fitted = predicted.left_out = output.means.transpose().replicate(y.rows(), 1);
  for (Index i = variances.size() - 1; i >= 0; --i) {
    const bool is_enough =
        std::ssize(output.patterns) == kMostPatterns || left <= kShareLeft * total;
    if (is_enough || variances(i) <= 0.0) break;
    left -= variances(i);
    const double sd = std::sqrt(variances(i));
    const VectorXd direction = solver.eigenvectors().col(i);
    const VectorXd amounts = about_means * direction / sd;
    MonthPattern pattern{sd * direction, fit_gaussian_process(points, amounts, kernel)};
    kernel = pattern.amount.kernel;
    const VectorXd fitted = amounts - kernel.noise * pattern.amount.weights;
    predicted.fitted += fitted * pattern.loadings.transpose();
    predicted.left_out += (amounts - pattern.amount.left_out) * pattern.loadings.transpose();
    output.patterns.push_back(std::move(pattern));
  }
  return output;
}

}  // namespace

Result<MonthlyForm> fit_monthly_form(const DesignData& design) {
  if (auto good = check_design(design); !good) return tl::unexpected(std::move(good.error()));
  MonthlyForm form;
  form.parameters = design.parameters;
  form.caps = design.caps;
  const MatrixXd theta = capped(design.theta, design.caps);
  form.parameter_scales = column_scales(theta);
  form.points = scale_columns(theta, form.parameter_scales);
  form.months = design.months;
  form.outputs = design.outputs;
  form.output_scales = output_scales(design);
  const MatrixXd y = normalise_outputs(design, form.output_scales);
  const Index months = design.month_count();
  MatrixXd fitted(y.rows(), y.cols());
  MatrixXd left_out(y.rows(), y.cols());
  Kernel kernel = usual_kernel(form.points.cols());
  for (Index k = 0; k < std::ssize(form.outputs); ++k) {
    Predicted predicted;
    form.fits.push_back(
        fit_output(form.points, y.middleCols(k * months, months), kernel, predicted));
    fitted.middleCols(k * months, months) = predicted.fitted;
    left_out.middleCols(k * months, months) = predicted.left_out;
  }
  form.quality = assess_fit(design, form.output_scales, fitted, left_out);
  return form;
}

}  // namespace recald::regression
