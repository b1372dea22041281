#include "core/diagnosis/detectability.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "core/random/rng.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::diagnosis::detectability_test {
namespace {

using metering::Utility;

constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// Three months of the sample building, the change of clocks among them, with two made-up meters
/// and a gap.
SiteProblem two_meters() {
  SiteProblem site;
  site.nominal = testing::sample_building();
  site.drivers = std::make_shared<const model::Drivers>(testing::sample_drivers(site.nominal, 3));
  site.meters = {{"electricity", Utility::electricity, {}}, {"steam", Utility::steam, {}}};
  site.day_parts = make_day_parts(*site.drivers);
  const auto hours = static_cast<Eigen::Index>(site.drivers->hours.size());
  Rng rng{3};
  site.measured_kW = Eigen::ArrayXXd::NullaryExpr(hours, 2, [&](Eigen::Index, Eigen::Index g) {
    return (g == 0 ? 50.0 : 70.0) + 5.0 * rng.normal();
  });
  site.measured_kW.col(1).segment(100, 60) = absent;
  site.measured_parts_kW = measured_parts(site.day_parts, site.measured_kW);
  site.month_roles = {Role::fit, Role::fit, Role::fit};
  site.roles.assign(site.day_parts.parts.size(), Role::fit);
  return site;
}

/// The noise of each meter, the second one much the louder.
std::vector<NoiseLevel> two_levels() {
  return {{.structure_sd = 3.0, .correlation_h = 60.0, .white_sd = 1.0, .pattern_sd = 0.5},
          {.structure_sd = 6.0, .correlation_h = 20.0, .white_sd = 4.0, .pattern_sd = 1.5}};
}

struct Made {
  Observations observations;
  NoiseNode noise;
  Eigen::MatrixXd jacobian;
};

Made made_up(const SiteProblem& site, ResidualScale scale) {
  const std::vector<MeterScale> scales(2, MeterScale{scale});
  Made made;
  made.observations = observe(site, parts_of(site, {Role::fit}), scales);
  for (MeterRows& meter : made.observations.meters) {
    meter.design.gated.assign(meter.rows.size(), false);
    meter.design.gated[40] = true;
  }
  made.noise = noise_grid(made.observations, two_levels(), false).front();
  Rng rng{4};
  made.jacobian = Eigen::MatrixXd::NullaryExpr(
      made.observations.count(), 3, [&](Eigen::Index, Eigen::Index) { return 2.0 * rng.normal(); });
  made.jacobian.col(1).array() += 3.0;
  return made;
}

Eigen::ArrayXXd random_footprint(const SiteProblem& site) {
  Rng rng{5};
  return Eigen::ArrayXXd::NullaryExpr(
      site.measured_kW.rows(), 2,
      [&](Eigen::Index i, Eigen::Index) { return (i % 24 < 5 ? 3.0 : -0.5) + rng.normal(); });
}

/// Sigma of both meters as its definition says, element by element.
Eigen::MatrixXd dense_covariance(const Observations& observations) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(observations.count(), observations.count());
  for (std::size_t g = 0; g < 2; ++g) {
    const MeterRows& meter = observations.meters[g];
    const BlockDesign& design = meter.design;
    const NoiseLevel level = two_levels()[g];
    const Eigen::Index n = design.times_h.size();
    Eigen::MatrixXd covariance =
        std::pow(level.pattern_sd, 2) * design.patterns * design.patterns.transpose();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        covariance(i, j) +=
            std::pow(level.structure_sd, 2) *
            std::exp(-std::abs(design.times_h[i] - design.times_h[j]) / level.correlation_h);
      }
      covariance(i, i) += std::pow(level.white_sd, 2) * (design.gated[i] ? 25.0 : 1.0);
    }
    whole.block(meter.offset, meter.offset, n, n) = covariance;
  }
  return whole;
}

/// Means of rows by meter and group, weighted by hours.
Eigen::MatrixXd dense_averaging(const SiteProblem& site, const Observations& observations,
                                int (*group)(const DayPart&)) {
  std::vector<std::pair<std::size_t, int>> groups;
  Eigen::MatrixXd averaging = Eigen::MatrixXd::Zero(observations.count(), observations.count());
  for (std::size_t g = 0; g < 2; ++g) {
    const MeterRows& meter = observations.meters[g];
    for (std::size_t i = 0; i < meter.rows.size(); ++i) {
      const DayPart& part = site.day_parts.parts[static_cast<std::size_t>(meter.rows[i])];
      const std::pair key{g, group(part)};
      if (groups.empty() || groups.back() != key) groups.push_back(key);
      averaging(static_cast<Eigen::Index>(groups.size()) - 1,
                meter.offset + static_cast<Eigen::Index>(i)) = part.hours;
    }
  }
  averaging.conservativeResize(static_cast<Eigen::Index>(groups.size()), Eigen::NoChange);
  return averaging.array().colwise() / averaging.rowwise().sum().array();
}

void expect_as_dense(const Visibility& seen, const Eigen::MatrixXd& covariance,
                     const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& footprint) {
  const double signal = footprint.dot(covariance.llt().solve(footprint));
  const Eigen::MatrixXd confused = covariance + jacobian * jacobian.transpose();
  const double left = footprint.dot(confused.llt().solve(footprint));
  EXPECT_NEAR(seen.unprojected, std::sqrt(signal), 1e-8 * std::sqrt(signal));
  EXPECT_NEAR(seen.detectability, std::sqrt(left), 1e-8 * std::sqrt(signal));
  EXPECT_NEAR(seen.absorbed_share, 1.0 - left / signal, 1e-8);
}

// On both scales and at all grains, under gaps and gates, against matrices that are simply formed.
TEST(FootprintGauge, AgreesWithDenseAlgebra) {
  const SiteProblem site = two_meters();
  const Eigen::ArrayXXd footprint_kW = random_footprint(site);
  for (const ResidualScale scale : {ResidualScale::linear, ResidualScale::square_root}) {
    const Made made = made_up(site, scale);
    const auto gauge = FootprintGauge::make(site, made.observations, made.noise, made.jacobian);
    ASSERT_TRUE(gauge.has_value()) << gauge.error().message;
    const auto measured = gauge->measure(footprint_kW);
    ASSERT_TRUE(measured.has_value()) << measured.error().message;

    const Eigen::ArrayXXd with = measured_parts(site.day_parts, site.measured_kW + footprint_kW);
    const Eigen::VectorXd s = made.observations.stack(with) - made.observations.measured;
    const Eigen::MatrixXd covariance = dense_covariance(made.observations);
    expect_as_dense(measured->block, covariance, made.jacobian, s);
    const auto day =
        dense_averaging(site, made.observations, [](const DayPart& p) { return p.day_index; });
    expect_as_dense(measured->day, day * covariance * day.transpose(), day * made.jacobian,
                    day * s);
    const auto month =
        dense_averaging(site, made.observations, [](const DayPart& p) { return p.month; });
    expect_as_dense(measured->month, month * covariance * month.transpose(), month * made.jacobian,
                    month * s);
  }
}

TEST(FootprintGauge, CoarserGrainsShowLess) {
  const SiteProblem site = two_meters();
  const Made made = made_up(site, ResidualScale::linear);
  const auto gauge = FootprintGauge::make(site, made.observations, made.noise, made.jacobian);
  const auto seen = gauge->measure(random_footprint(site));
  EXPECT_GT(seen->block.detectability, seen->day.detectability);
  EXPECT_GT(seen->day.detectability, seen->month.detectability);
}

TEST(FootprintGauge, SaysWhatPartOfEachMeterMoves) {
  const SiteProblem site = two_meters();
  const Made made = made_up(site, ResidualScale::linear);
  const auto gauge = FootprintGauge::make(site, made.observations, made.noise, made.jacobian);
  Eigen::ArrayXXd footprint_kW = Eigen::ArrayXXd::Zero(site.measured_kW.rows(), 2);
  const Eigen::ArrayXd steam_kW = site.measured_kW.col(1).isFinite().select(
      site.measured_kW.col(1), 1e6);  // 1e6: where nothing was measured nothing may count
  footprint_kW.col(1) = -0.1 * steam_kW;
  const auto seen = gauge->measure(footprint_kW);
  ASSERT_TRUE(seen.has_value());
  EXPECT_EQ(seen->meters[0].net_share, 0.0);
  EXPECT_EQ(seen->meters[0].moved_share, 0.0);
  EXPECT_NEAR(seen->meters[1].net_share, -0.1, 1e-9);
  EXPECT_NEAR(seen->meters[1].moved_share, 0.1, 1e-9);
}

TEST(FootprintGauge, GrowsWithTheFootprintAndIsNothingWithoutOne) {
  const SiteProblem site = two_meters();
  const Made made = made_up(site, ResidualScale::linear);
  const auto gauge = FootprintGauge::make(site, made.observations, made.noise, made.jacobian);
  const Eigen::ArrayXXd footprint_kW = random_footprint(site);
  const auto once = gauge->measure(footprint_kW);
  const auto thrice = gauge->measure(-3.0 * footprint_kW);
  EXPECT_NEAR(thrice->block.detectability, 3.0 * once->block.detectability, 1e-8);
  EXPECT_NEAR(thrice->day.absorbed_share, once->day.absorbed_share, 1e-8);
  const auto nothing = gauge->measure(0.0 * footprint_kW);
  EXPECT_EQ(nothing->block.detectability, 0.0);
  EXPECT_EQ(nothing->block.absorbed_share, 0.0);
}

TEST(FootprintGauge, RefusesWhatIsNoNumber) {
  const SiteProblem site = two_meters();
  Made made = made_up(site, ResidualScale::linear);
  const auto gauge = FootprintGauge::make(site, made.observations, made.noise, made.jacobian);
  Eigen::ArrayXXd footprint_kW = random_footprint(site);
  footprint_kW(110, 1) = absent;  // not measured there
  EXPECT_TRUE(gauge->measure(footprint_kW).has_value());
  footprint_kW.block(400, 0, 8, 1) = absent;
  EXPECT_EQ(gauge->measure(footprint_kW).error().code, ErrorCode::not_finite);
  made.jacobian(7, 1) = absent;
  const auto refused = FootprintGauge::make(site, made.observations, made.noise, made.jacobian);
  EXPECT_EQ(refused.error().code, ErrorCode::not_positive_definite);
}

std::vector<double> values_at_middle(const SiteProblem& site) {
  std::vector<double> values;
  for (const Parameter& parameter : site.parameters) {
    values.push_back(parameter.prior.quantile(0.5));
  }
  return values;
}

/// A year of the sample building as its own meters, with noise.
SiteProblem own_meters() {
  SiteProblem site;
  site.nominal = testing::sample_building();
  for (const char* name : {"outdoor_airflow", "cooling_setpoint"}) {
    site.parameters.push_back(*model::make_parameter(**model::find_parameter(name), site.nominal));
  }
  site.drivers = std::make_shared<const model::Drivers>(testing::sample_drivers(site.nominal, 12));
  for (const auto& [id, utility] : {std::pair{"electricity", Utility::electricity},
                                    std::pair{"chilled_water", Utility::chilled_water}}) {
    site.meters.push_back({id, utility, *model::default_meter_map(utility)});
  }
  site.day_parts = make_day_parts(*site.drivers);
  site.month_roles = split_months(site.drivers->months, {});
  site.roles = part_roles(site.day_parts, site.month_roles, 7);
  Predictor predictor{site};
  predictor.parts_kW(values_at_middle(site));
  site.measured_kW = predictor.hours_kW();
  Rng rng{7};
  for (Eigen::Index g = 0; g < 2; ++g) {
    const double mean = site.measured_kW.col(g).mean();
    for (double& value : site.measured_kW.col(g)) value += 0.05 * mean * rng.normal();
  }
  site.measured_parts_kW = measured_parts(site.day_parts, site.measured_kW);
  return site;
}

// What a base parameter does is what it can imitate; what only one meter shows by night it cannot.
TEST(FootprintGauge, AMovedParameterIsAbsorbedAndANightLoadIsNot) {
  const SiteProblem site = own_meters();
  const auto gauge = FootprintGauge::calibrate(site);
  ASSERT_TRUE(gauge.has_value()) << gauge.error().message;

  Predictor predictor{site};
  std::vector<double> theta = values_at_middle(site);
  predictor.parts_kW(theta);
  const Eigen::ArrayXXd before_kW = predictor.hours_kW();
  theta[0] *= 1.1;
  predictor.parts_kW(theta);
  const auto moved = gauge->measure(predictor.hours_kW() - before_kW);
  ASSERT_TRUE(moved.has_value());
  EXPECT_GT(moved->block.absorbed_share, 0.9);
  EXPECT_GT(moved->block.unprojected, 5.0);

  Eigen::ArrayXXd nights_kW = Eigen::ArrayXXd::Zero(before_kW.rows(), 2);
  for (std::size_t i = 0; i < site.drivers->hours.size(); ++i) {
    if (site.drivers->hours[i].local_hour < 4) nights_kW(static_cast<Eigen::Index>(i), 1) = 5.0;
  }
  const auto night = gauge->measure(nights_kW);
  EXPECT_LT(night->block.absorbed_share, 0.5);
  EXPECT_GT(night->block.detectability, night->day.detectability);
}

TEST(FootprintGauge, NeedsReadingsToCalibrateTo) {
  SiteProblem site = own_meters();
  site.measured_parts_kW.col(1).setConstant(absent);
  EXPECT_EQ(FootprintGauge::calibrate(site).error().code, ErrorCode::not_enough_data);
}

}  // namespace
}  // namespace recald::diagnosis::detectability_test
