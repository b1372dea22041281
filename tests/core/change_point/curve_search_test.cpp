#include "core/change_point/curve_search.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random/rng.hpp"
#include "tests/core/change_point/simulated_meter.hpp"

namespace recald::change_point::curve_search_test {
namespace {

constexpr DayGroup kAll{0, 1, 2};

struct Case {
  std::vector<MeterDay> days;
  std::vector<double> weights;
  TemperatureSums sums{-40.0, 50.0};
  EdgeLimits limits{};
};

Case make_case(const Curve& curve, std::uint64_t seed) {
  Rng rng{seed, 7};
  Case made;
  made.days = simulate(meter_with(curve), 500, rng);
  std::vector<double> temperatures;
  for (const MeterDay& day : made.days) temperatures.push_back(day.dry_bulb_C);
  const auto [low, high] = std::ranges::minmax(temperatures);
  made.sums = TemperatureSums{low, high};
  for (const MeterDay& day : made.days) {
    made.weights.push_back(rng.uniform(0.2, 1.0));
    made.sums.add(day.type, day.dry_bulb_C, day.energy_kWh, made.weights.back());
  }
  made.sums.cumulate();
  made.limits = {.heating_first = 30, .cooling_last = made.sums.last_edge() - 30};
  return made;
}

struct LeastSquares {
  Eigen::VectorXd coefficients;  ///< Three base loads, then the slopes.
  double squares;
};

/// Independent of the search: the design written out, solved by QR. NaN: no such side.
LeastSquares by_qr(const Case& made, double heating_C, double cooling_C) {
  const int slopes = (std::isnan(heating_C) ? 0 : 1) + (std::isnan(cooling_C) ? 0 : 1);
  const auto n = static_cast<Eigen::Index>(made.days.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, 3 + slopes);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const MeterDay& day = made.days[static_cast<std::size_t>(i)];
    const double root = std::sqrt(made.weights[static_cast<std::size_t>(i)]);
    int column = 3;
    x(i, static_cast<Eigen::Index>(day.type)) = root;
    if (!std::isnan(heating_C)) x(i, column++) = root * std::max(0.0, heating_C - day.dry_bulb_C);
    if (!std::isnan(cooling_C)) x(i, column) = root * std::max(0.0, day.dry_bulb_C - cooling_C);
    y(i) = root * day.energy_kWh;
  }
  const Eigen::VectorXd b = x.colPivHouseholderQr().solve(y);
  return {b, (y - x * b).squaredNorm()};
}

const GroupFit& of(const std::array<GroupFit, kForms>& fits, Form form) {
  return fits[static_cast<std::size_t>(form)];
}

LeastSquares by_qr_at(const Case& made, const Curve& curve) {
  return by_qr(made, curve.heating_balance_C, curve.cooling_balance_C);
}

TEST(CurveSearch, AtItsBalanceTemperaturesItIsLeastSquares) {
  for (const Curve& truth : {curve_3p_heating(), curve_3p_cooling(), curve_4p(), curve_5p()}) {
    SCOPED_TRACE(kFormNames[static_cast<std::size_t>(truth.form)]);
    const Case made = make_case(truth, 1);
    CurveSearch search;
    const GroupFit fit = of(search.fit(made.sums, kAll, made.limits), truth.form);
    ASSERT_EQ(fit.curve.form, truth.form);
    const Eigen::VectorXd expected = by_qr_at(made, fit.curve).coefficients;
    for (std::size_t base = 0; base < 3; ++base) {
      EXPECT_NEAR(fit.base_kWh[base], expected(static_cast<Eigen::Index>(base)), 1e-6);
    }
    int column = 3;
    if (!std::isnan(truth.heating_balance_C)) {
      EXPECT_NEAR(fit.curve.heating_slope_kWh_K, expected(column++), 1e-8);
    }
    if (!std::isnan(truth.cooling_balance_C)) {
      EXPECT_NEAR(fit.curve.cooling_slope_kWh_K, expected(column), 1e-8);
    }
  }
}

TEST(CurveSearch, WithoutTemperatureTheBaseLoadsAreMeans) {
  const Case made = make_case(curve_5p(), 2);
  CurveSearch search;
  const GroupFit fit = of(search.fit(made.sums, kAll, made.limits), Form::no_temperature);
  const Eigen::VectorXd expected = by_qr(made, NAN, NAN).coefficients;
  for (std::size_t base = 0; base < 3; ++base) {
    EXPECT_NEAR(fit.base_kWh[base], expected(static_cast<Eigen::Index>(base)), 1e-8);
  }
}

TEST(CurveSearch, NoOtherTenthOfAKelvinIsBetter) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    CurveSearch search;
    const Case heats = make_case(curve_3p_heating(), seed);
    const Case bends = make_case(curve_4p(), seed);
    const Curve three = of(search.fit(heats.sums, kAll, heats.limits), Form::heating_3p).curve;
    const Curve four = of(search.fit(bends.sums, kAll, bends.limits), Form::two_slopes_4p).curve;
    const double best_three = by_qr_at(heats, three).squares;
    const double best_four = by_qr_at(bends, four).squares;
    for (int edge = heats.limits.heating_first; edge <= heats.limits.cooling_last; ++edge) {
      const double at = heats.sums.edge_C(edge);
      EXPECT_GE(by_qr(heats, at, NAN).squares, best_three * (1.0 - 1e-9)) << at;
    }
    for (int edge = bends.limits.heating_first; edge <= bends.limits.cooling_last; ++edge) {
      const double at = bends.sums.edge_C(edge);
      EXPECT_GE(by_qr(bends, at, at).squares, best_four * (1.0 - 1e-9)) << at;
    }
  }
}

TEST(CurveSearch, NoOtherPairOfKelvinsIsBetter) {
  const Case made = make_case(curve_5p(), 3);
  CurveSearch search;
  const Curve five = of(search.fit(made.sums, kAll, made.limits), Form::two_slopes_5p).curve;
  const double best = by_qr_at(made, five).squares;
  const int last = made.limits.cooling_last;
  for (int low = made.limits.heating_first; low <= last; low += 10) {
    for (int high = low + 10; high <= last; high += 10) {
      EXPECT_GT(by_qr(made, made.sums.edge_C(low), made.sums.edge_C(high)).squares, best);
    }
  }
}

// What falls with the cold has no heating slope, and the best that is left is flat.
TEST(CurveSearch, ASlopeOfTheWrongSignIsNotTaken) {
  const Case made = make_case(curve_3p_cooling(), 4);
  CurveSearch search;
  const auto fits = search.fit(made.sums, kAll, made.limits);
  EXPECT_EQ(of(fits, Form::heating_3p).curve.form, Form::no_temperature);
  EXPECT_EQ(of(fits, Form::cooling_3p).curve.form, Form::cooling_3p);
}

TEST(CurveSearch, ARoofIsNotACurve) {
  const Curve roof{.form = Form::two_slopes_4p,
                   .heating_slope_kWh_K = -20.0,
                   .heating_balance_C = 11.0,
                   .cooling_slope_kWh_K = -20.0,
                   .cooling_balance_C = 11.0};
  const Case made = make_case(roof, 5);
  CurveSearch search;
  for (const GroupFit& fit : search.fit(made.sums, kAll, made.limits)) {
    EXPECT_FALSE(fit.curve.heating_slope_kWh_K < 0.0 && fit.curve.cooling_slope_kWh_K < 0.0);
  }
}

TEST(CurveSearch, WhereNoEdgeIsAllowedAllFormsAreFlat) {
  const Case made = make_case(curve_5p(), 6);
  CurveSearch search;
  const EdgeLimits none{.heating_first = made.sums.last_edge() + 1, .cooling_last = -1};
  for (const GroupFit& fit : search.fit(made.sums, kAll, none)) {
    EXPECT_EQ(fit.curve.form, Form::no_temperature);
  }
}

}  // namespace
}  // namespace recald::change_point::curve_search_test
