#include "core/model/epc/utilisation.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

namespace recald::model::epc::utilisation_test {
namespace {

// Wide enough that the textbook form's cancellation leaves fifty digits even at γ^100 = e^300.
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<250>>;

/// 1 − η γ with η = (1 − γ^a)/(1 − γ^(a+1)) as the standard prints it, in 250 digits.
double textbook_need_share(double u, double a) {
  const Wide gamma = exp(Wide(u));
  if (u == 0.0) return 1.0 / (a + 1.0);
  const Wide eta = (1 - pow(gamma, Wide(a))) / (1 - pow(gamma, Wide(a) + 1));
  return static_cast<double>(1 - eta * gamma);
}

TEST(Utilisation, EqualsTheTextbookFormInWideArithmetic) {
  for (const double a : {1.0, 1.5, 4.236817, 20.0, 100.0}) {
    for (const double u : {-3.0, -0.5, -1e-3, -1e-9, 0.0, 1e-9, 1e-3, 0.5, 3.0}) {
      SCOPED_TRACE(::testing::Message() << "a = " << a << ", u = " << u);
      const double expected = textbook_need_share(u, a);
      EXPECT_NEAR(need_share(u, a), expected, 1e-7 * expected);
      if (std::abs(u) > 1e-8) {
        EXPECT_NEAR(need_share(u, a), expected, 1e-13 * expected);
      }
    }
  }
}

TEST(Utilisation, StaysFiniteWhereTheTextbookFormIsNot) {
  EXPECT_EQ(need_share(std::log(50.0), 1000.0), 0.0);  // γ^a overflows a double
  EXPECT_NEAR(need_share(-std::log(50.0), 1000.0), 1.0 - 1.0 / 50.0, 1e-15);
  EXPECT_TRUE(std::isfinite(need_share(700.0, 1e6)));
}

// Worked example, heating month: 744 h, H_tr = 2500, H_g = 300, H_ve = 1920 W/K, 21 °C inside,
// 5 °C outside, 15 °C ground, 45 kW of gains, κ = 165 kJ/m²K on 5000 m².
TEST(Utilisation, WorkedHeatingMonth) {
  const double hours = 744.0;
  const double transfer_kWh = (2500.0 * 16.0 + 300.0 * 6.0 + 1920.0 * 16.0) * hours / 1000.0;
  EXPECT_NEAR(transfer_kWh, 53954.88, 1e-9);
  const double tau_h = 165e3 * 5000.0 / 3600.0 / (2500.0 + 300.0 + 1920.0);
  EXPECT_NEAR(tau_h, 48.552260, 1e-6);
  const double a = utilisation_exponent(tau_h);
  EXPECT_NEAR(a, 4.236817, 1e-6);
  EXPECT_NEAR(heating_need_kWh(transfer_kWh, 45.0 * hours, a), 22307.8347, 1e-4);
}

TEST(Utilisation, WorkedCoolingMonths) {
  const double hours = 744.0;
  const double a = utilisation_exponent(165e3 * 5000.0 / 3600.0 / 4720.0);
  const double spring_kWh = ((2500.0 + 1920.0) * 4.0 + 300.0 * 7.0) * hours / 1000.0;
  EXPECT_NEAR(spring_kWh, 14716.32, 1e-9);
  EXPECT_NEAR(cooling_need_kWh(spring_kWh, 60.0 * hours, a), 30013.5395, 1e-4);
  const double july_kWh = ((2500.0 + 1920.0) * -3.0 + 300.0 * 4.0) * hours / 1000.0;
  EXPECT_NEAR(july_kWh, -8972.64, 1e-9);
  EXPECT_NEAR(cooling_need_kWh(july_kWh, 75.0 * hours, a), 64772.64, 1e-9);
}

// Energy must go somewhere: what is not heated and not cooled is what gains cover of the losses.
TEST(Utilisation, ClosesTheBalanceAtEqualSetPoints) {
  for (const double transfer : {-300.0, -1.0, 1e-6, 10.0, 500.0}) {
    for (const double gains : {-200.0, -1e-6, 0.0, 5.0, 500.0, 5000.0}) {
      SCOPED_TRACE(::testing::Message() << transfer << " " << gains);
      const double heating = heating_need_kWh(transfer, gains, 3.0);
      const double cooling = cooling_need_kWh(transfer, gains, 3.0);
      EXPECT_NEAR(heating - cooling, transfer - gains, 1e-9);
      EXPECT_GE(heating, 0.0);
      EXPECT_GE(cooling, 0.0);
    }
  }
}

TEST(Utilisation, MassDecidesHowMuchGainsHelp) {
  // No mass: no more than a share 1/(1+γ)… of the gains; infinite mass: all of them.
  EXPECT_NEAR(heating_need_kWh(100.0, 40.0, 1e6), 60.0, 1e-9);
  EXPECT_NEAR(cooling_need_kWh(100.0, 40.0, 1e6), 0.0, 1e-9);
  EXPECT_NEAR(heating_need_kWh(100.0, 140.0, 1e6), 0.0, 1e-9);
  double previous = heating_need_kWh(100.0, 90.0, 1.0);
  for (const double a : {1.5, 2.0, 4.0, 10.0, 100.0}) {
    const double need = heating_need_kWh(100.0, 90.0, a);
    EXPECT_LT(need, previous);
    previous = need;
  }
}

}  // namespace
}  // namespace recald::model::epc::utilisation_test
