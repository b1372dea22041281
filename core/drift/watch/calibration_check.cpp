#include "core/drift/watch/calibration_check.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <string>

namespace recald::drift {
namespace {

constexpr std::size_t kLeast = 8;

}  // namespace

Result<CalibrationCheck> check_calibration(std::span<const double> u) {
  if (u.size() < kLeast) {
    return failure(ErrorCode::not_enough_data, "forecasts of " + std::to_string(u.size()) +
                                                   " months are too few to check; " +
                                                   std::to_string(kLeast) + " are needed");
  }
  const auto n = static_cast<double>(u.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double one : u) {
    sum += one;
    squares += one * one;
  }
  CalibrationCheck check{};
  check.mean = sum / n;
  check.sd = std::sqrt(std::max(0.0, squares / n - check.mean * check.mean));

  // Least squares of u_t on u_(t-1), the first given.
  const double m = n - 1.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t t = 1; t < u.size(); ++t) {
    x += u[t - 1];
    y += u[t];
    xx += u[t - 1] * u[t - 1];
    xy += u[t - 1] * u[t];
    yy += u[t] * u[t];
  }
  const double spread = xx - x * x / m;
  const double r = spread > 0.0 ? (xy - x * y / m) / spread : 0.0;
  const double c = (y - r * x) / m;
  const double left = std::max(yy - c * y - r * xy, 1e-300);
  const double variance = left / m;
  check.lag_one = r;
  // log L1 - log L0 of the m conditionals; the fitted variance makes the exponent of L1 -m/2.
  const double statistic = -m * std::log(variance) - m + yy;
  const boost::math::chi_squared_distribution<> law{3.0};
  check.pvalue = boost::math::cdf(boost::math::complement(law, std::max(statistic, 0.0)));
  return check;
}

}  // namespace recald::drift
