#include "core/regression/weather_response.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/statistics/expected_maximum.hpp"

namespace recald::regression {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::array kPenalties = {0.3, 1.0, 3.0, 10.0, 30.0};
constexpr std::array kSpreadShares = {0.0, 0.5, 1.0};
constexpr int kKinds = 3;
// A level is hardly penalised; that the weather acts otherwise in spring than in autumn is less
// likely than that it acts.
constexpr double kLevelWeight = 3.0;
constexpr double kSeasonWeight = 0.5;

/// Rows of the days of each month, which lie together.
struct MonthRows {
  Index first;
  Index count;
};
std::vector<MonthRows> month_rows(const std::vector<int>& months) {
  assert(std::ranges::is_sorted(months));
  std::vector<MonthRows> rows(months.empty() ? 0 : static_cast<std::size_t>(months.back()) + 1,
                              MonthRows{0, 0});
  for (std::size_t i = 0; i < months.size(); ++i) {
    MonthRows& month = rows[static_cast<std::size_t>(months[i])];
    if (month.count++ == 0) month.first = static_cast<Index>(i);
  }
  return rows;
}

/// B. (days x columns)
MatrixXd columns_of(const ResponseDays& days, const VectorXd& means, const VectorXd& scales) {
  const Index n = days.count();
  const Index p = days.terms.cols();
  MatrixXd b = MatrixXd::Zero(n, 1 + kKinds + 6 + p * (1 + kKinds + 2));
  const Index levels = 1 + kKinds;
  for (Index i = 0; i < n; ++i) {
    const int kind = days.kinds[static_cast<std::size_t>(i)];
    const double cosine = std::cos(days.season[i]);
    const double sine = std::sin(days.season[i]);
    const double works = kind == 0 ? 1.0 : 0.0;
    b(i, 0) = kLevelWeight;
    b(i, 1 + kind) = kLevelWeight;
    b.row(i).segment(levels, 6) << cosine, sine, works * cosine, works * sine,
        std::cos(2.0 * days.season[i]), std::sin(2.0 * days.season[i]);
    const Index first = levels + 6;
    auto plain = b.row(i).segment(first, p);
    plain = ((days.terms.row(i).transpose() - means).array() / scales.array()).matrix().transpose();
    b.row(i).segment(first + (1 + kind) * p, p) = plain;
    b.row(i).segment(first + (1 + kKinds) * p, p) = kSeasonWeight * cosine * plain;
    b.row(i).segment(first + (2 + kKinds) * p, p) = kSeasonWeight * sine * plain;
  }
  return b;
}

double spread(const Eigen::Ref<const VectorXd>& values, double mean) {
  return std::sqrt((values.array() - mean).square().mean());
}

/// A constant column or output is left as it is: its centred values are zero.
double scale_or_one(double scale) { return scale > 0.0 ? scale : 1.0; }

/// Residuals of months left out, from those of the fit, in place. (days x runs)
void leave_out_months(const MatrixXd& z, const std::vector<MonthRows>& months,
                      MatrixXd& residuals) {
  for (const auto& [first, count] : months) {
    if (count == 0) continue;
    const auto z_m = z.middleCols(first, count);
    MatrixXd rest = -z_m.transpose() * z_m;
    rest.diagonal().array() += 1.0;
    rest.llt().solveInPlace(residuals.middleRows(first, count));
  }
}

/// What the days of a month come to.
double month_value(const Eigen::Ref<const VectorXd>& days, bool is_peak, double sd) {
  if (!is_peak) return days.mean();
  return expected_maximum({days.data(), static_cast<std::size_t>(days.size())}, sd);
}

/// Errors of left-out months. (months x runs)
MatrixXd month_errors(const MatrixXd& values, const MatrixXd& left_out, const VectorXd& spreads,
                      const std::vector<MonthRows>& months, bool is_peak, double share) {
  MatrixXd errors = MatrixXd::Zero(static_cast<Index>(months.size()), values.cols());
  for (Index run = 0; run < values.cols(); ++run) {
    for (std::size_t m = 0; m < months.size(); ++m) {
      const auto& [first, count] = months[m];
      if (count == 0) continue;
      errors(static_cast<Index>(m), run) =
          month_value(left_out.col(run).segment(first, count), is_peak, share * spreads[run]) -
          month_value(values.col(run).segment(first, count), is_peak, 0.0);
    }
  }
  return errors;
}

double root_mean_square(const MatrixXd& errors) {
  return std::sqrt(errors.array().square().mean());
}

/// One output while penalties are tried.
struct OutputFit {
  MatrixXd values;  ///< (days x runs)
  VectorXd means;   ///< (runs)
  VectorXd scales;
  MatrixXd coefficients = {};
  MatrixXd left_out = {};  ///< (days x runs) in the output's unit.
  VectorXd spreads = {};
  ResponseError error{0.0, 0.0, std::numeric_limits<double>::infinity(), {}};
};

OutputFit start_output(MatrixXd values) {
  OutputFit output{std::move(values), {}, {}};
  output.means = output.values.colwise().mean();
  output.scales.resize(output.means.size());
  for (Index run = 0; run < output.means.size(); ++run) {
    output.scales[run] = scale_or_one(spread(output.values.col(run), output.means[run]));
  }
  return output;
}

/// Fits with this penalty, and keeps the fit where it predicts left-out months better.
void try_penalty(double penalty, const Eigen::LLT<MatrixXd>& llt, const MatrixXd& z,
                 const std::vector<MonthRows>& months, bool is_peak, OutputFit& output) {
  const MatrixXd scaled = (output.values.rowwise() - output.means.transpose()) *
                          output.scales.cwiseInverse().asDiagonal();
  const MatrixXd projected = z * scaled;
  MatrixXd residuals = scaled - z.transpose() * projected;
  leave_out_months(z, months, residuals);
  residuals *= output.scales.asDiagonal();
  const MatrixXd left_out = output.values - residuals;
  VectorXd spreads = VectorXd::Zero(residuals.cols());
  if (is_peak) spreads = residuals.array().square().colwise().mean().sqrt();
  const double error =
      root_mean_square(month_errors(output.values, left_out, spreads, months, is_peak, 0.0));
  if (!(error < output.error.sd)) return;
  output.error = {penalty, 0.0, error, {}};
  output.coefficients = llt.matrixU().solve(projected);
  output.left_out = left_out;
  output.spreads = spreads;
}

void choose_spread(const std::vector<MonthRows>& months, bool is_peak, OutputFit& output) {
  output.error.sd = std::numeric_limits<double>::infinity();
  for (const double share : kSpreadShares) {
    if (share > 0.0 && !is_peak) break;
    const MatrixXd errors =
        month_errors(output.values, output.left_out, output.spreads, months, is_peak, share);
    const double error = root_mean_square(errors);
    if (!(error < output.error.sd)) continue;
    output.error.sd = error;
    output.error.spread_share = share;
    output.error.by_month = errors.array().square().rowwise().mean().sqrt();
  }
}

}  // namespace

Result<WeatherResponse> fit_weather_response(const ResponseDays& days, const MatrixXd& values,
                                             const std::vector<bool>& is_peak) {
  const Index n = days.count();
  const auto outputs = static_cast<Index>(is_peak.size());
  const Index runs = values.rows();
  assert(values.cols() == outputs * n && days.season.size() == n);
  if (days.month_count() < 3) {
    return failure(ErrorCode::not_enough_data,
                   "a response to the weather needs the days of at least three months");
  }
  if (!values.allFinite()) {
    return failure(ErrorCode::not_finite, "a day of a run has no finite value");
  }
  WeatherResponse response;
  response.is_peak = is_peak;
  response.term_means = days.terms.colwise().mean();
  response.term_scales.resize(days.terms.cols());
  for (Index j = 0; j < days.terms.cols(); ++j) {
    response.term_scales[j] = scale_or_one(spread(days.terms.col(j), response.term_means[j]));
  }
  const MatrixXd b = columns_of(days, response.term_means, response.term_scales);
  const std::vector<MonthRows> months = month_rows(days.months);
  std::vector<OutputFit> fits;
  for (Index k = 0; k < outputs; ++k) {
    fits.push_back(start_output(values.middleCols(k * n, n).transpose()));
  }
  const MatrixXd gram = b.transpose() * b;
  for (const double penalty : kPenalties) {
    MatrixXd ridge = gram;
    ridge.diagonal().array() += penalty;
    const Eigen::LLT<MatrixXd> llt{ridge};
    const MatrixXd z = llt.matrixL().solve(b.transpose());
    for (std::size_t k = 0; k < fits.size(); ++k) {
      try_penalty(penalty, llt, z, months, is_peak[k], fits[k]);
    }
  }
  response.coefficients.resize(b.cols(), outputs * runs);
  for (VectorXd* of : {&response.means, &response.scales, &response.spreads}) {
    of->resize(outputs * runs);
  }
  for (Index k = 0; k < outputs; ++k) {
    OutputFit& fit = fits[static_cast<std::size_t>(k)];
    choose_spread(months, is_peak[static_cast<std::size_t>(k)], fit);
    response.coefficients.middleCols(k * runs, runs) = fit.coefficients;
    response.means.segment(k * runs, runs) = fit.means;
    response.scales.segment(k * runs, runs) = fit.scales;
    response.spreads.segment(k * runs, runs) = fit.spreads;
    response.errors.push_back(std::move(fit.error));
  }
  return response;
}

MatrixXd predict_months(const WeatherResponse& response, const ResponseDays& days) {
  const auto outputs = static_cast<Index>(response.is_peak.size());
  const Index runs = response.means.size() / outputs;
  const std::vector<MonthRows> months = month_rows(days.months);
  const auto month_count = static_cast<Index>(months.size());
  const MatrixXd b = columns_of(days, response.term_means, response.term_scales);
  MatrixXd predicted(runs, outputs * month_count);
  for (Index k = 0; k < outputs; ++k) {
    const bool is_peak = response.is_peak[static_cast<std::size_t>(k)];
    const double share = response.errors[static_cast<std::size_t>(k)].spread_share;
    MatrixXd of_days = b * response.coefficients.middleCols(k * runs, runs);
    of_days *= response.scales.segment(k * runs, runs).asDiagonal();
    of_days.rowwise() += response.means.segment(k * runs, runs).transpose();
    for (Index run = 0; run < runs; ++run) {
      for (Index m = 0; m < month_count; ++m) {
        const auto& [first, count] = months[static_cast<std::size_t>(m)];
        predicted(run, k * month_count + m) =
            month_value(of_days.col(run).segment(first, count), is_peak,
                        share * response.spreads[k * runs + run]);
      }
    }
  }
  return predicted;
}

}  // namespace recald::regression
