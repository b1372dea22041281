#include "core/diagnosis/naming/signatures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnosis/effects/support/public_holidays.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::diagnosis::signatures_test {
namespace {

using metering::Utility;
using model::DriverHour;

/// A year of the sample building with a chilled water and a gas meter.
class Signatures : public ::testing::Test {
 protected:
  Signatures() {
    site_.nominal = testing::sample_building();
    site_.drivers =
        std::make_shared<const model::Drivers>(testing::sample_drivers(site_.nominal, 12));
    site_.meters = {{"chilled_water", Utility::chilled_water, {}}, {"gas", Utility::gas, {}}};
    // Chilled water: 10 kW, 40 kW more on workdays from 7 to 19 h. Gas: 3 kW a degree below 15.
    site_.measured_kW = hourly([](const DriverHour& hour, Eigen::Index meter) {
      if (meter == 1) return 3.0 * std::max(15.0 - hour.dry_bulb_C, 0.0);
      const bool is_day =
          hour.day == model::DayType::workday && hour.local_hour >= 7 && hour.local_hour < 19;
      return is_day ? 50.0 : 10.0;
    });
  }

  /// The meter that lights and plugs are read off.
  void become_electricity() {
    site_.meters[0].utility = Utility::electricity;
    site_.meters[0].end_uses = *model::default_meter_map(Utility::electricity);
  }

  template <class Power>
  Eigen::ArrayXXd hourly(Power power) const {
    const auto& hours = site_.drivers->hours;
    Eigen::ArrayXXd kW(static_cast<Eigen::Index>(hours.size()), 2);
    for (Eigen::Index i = 0; i < kW.rows(); ++i) {
      for (Eigen::Index meter = 0; meter < 2; ++meter) {
        kW(i, meter) = power(hours[static_cast<std::size_t>(i)], meter);
      }
    }
    return kW;
  }
  /// By its name, of what was measured or of something else.
  double value(SignatureMeter meter, const std::string& name, const Eigen::ArrayXXd& kW) const {
    const auto& names = signature_names();
    const auto found = std::ranges::find(names, name);
    EXPECT_NE(found, names.end()) << name;
    return SignatureReader(site_).read(kW)(found - names.begin(), static_cast<int>(meter));
  }
  double measured(SignatureMeter meter, const std::string& name) const {
    return value(meter, name, site_.measured_kW);
  }

  SiteProblem site_;
};

constexpr auto kElectricity = SignatureMeter::electricity;
constexpr auto kCooling = SignatureMeter::cooling;
constexpr auto kHeat = SignatureMeter::heat;

TEST_F(Signatures, HaveEachANameOfItsOwn) {
  const auto& names = signature_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  const Eigen::MatrixXd values = SignatureReader(site_).read(site_.measured_kW);
  EXPECT_EQ(values.rows(), static_cast<Eigen::Index>(names.size()));
  EXPECT_EQ(values.cols(), 3);
  EXPECT_TRUE(values.col(0).array().isNaN().all()) << "no electricity";
}

TEST_F(Signatures, LeaveOutAMeterThatCountsNextToNothing) {
  const double share = 0.025 * site_.measured_kW.col(0).mean() / site_.measured_kW.col(1).mean();
  site_.measured_kW.col(1) *= share;
  const auto told = [&](const char* what) {
    const Eigen::MatrixXd values = SignatureReader(site_).read(site_.measured_kW);
    EXPECT_TRUE(values.col(1).array().isFinite().any()) << what;
    return values.col(2).array().isFinite().any();
  };
  EXPECT_TRUE(told("2.4 % of all"));
  site_.measured_kW.col(1) *= 0.8;
  EXPECT_FALSE(told("1.96 % of all"));
}

// A model errs by a share of what is there, and by a little where nothing is.
TEST_F(Signatures, MeansAreInUnitsOfWhatIsMeasuredThenAndAQuarterOfTheMean) {
  const double quarter_kW = 0.25 * site_.measured_kW.col(0).mean();
  const Eigen::ArrayXXd more = site_.measured_kW + 1.0;
  const auto change = [&](const std::string& name) {
    return value(kCooling, name, more) - measured(kCooling, name);
  };
  EXPECT_NEAR(change("workdays, when mild, 10 to 12 h"), 1.0 / (50.0 + quarter_kW), 1e-12);
  EXPECT_NEAR(change("Sundays, when mild, 10 to 12 h"), 1.0 / (10.0 + quarter_kW), 1e-12);
  EXPECT_NEAR(change("free days, about 13 degC outdoors"), 1.0 / (10.0 + quarter_kW), 1e-12);
  EXPECT_NEAR(measured(kCooling, "nights, about 13 degC outdoors"), 10.0 / (10.0 + quarter_kW),
              1e-12);
}

TEST_F(Signatures, RegressionsFindWhatDependsOnTheWeather) {
  const Eigen::ArrayXXd kW = hourly([&](const DriverHour& hour, Eigen::Index) {
    const double wind = hour.wind_m_s * std::max(20.0 - hour.dry_bulb_C, 0.0) / 60.0;
    return site_.measured_kW.col(0).mean() * (1.0 + 0.3 * wind);
  });
  // Per standard deviation of wind x cold, at night, in units of 10 kW and a quarter of the mean.
  std::vector<double> nights;
  double sum = 0.0;
  for (const DriverHour& hour : site_.drivers->hours) {
    if (hour.local_hour < 1 || hour.local_hour >= 5) continue;
    sum += hour.wind_m_s * std::max(20.0 - hour.dry_bulb_C, 0.0) / 60.0;
    if (hour.local_hour == 4) nights.push_back(std::exchange(sum, 0.0) / 4.0);
  }
  const Eigen::Map<const Eigen::ArrayXd> wind(nights.data(), std::ssize(nights));
  const double deviation = std::sqrt((wind - wind.mean()).square().mean());
  const double mean_kW = site_.measured_kW.col(0).mean();
  const double expected = 0.3 * deviation * mean_kW / (10.0 + 0.25 * mean_kW);
  EXPECT_NEAR(value(kCooling, "nights, with wind in the cold", kW), expected, 0.2 * expected);
  EXPECT_NEAR(measured(kCooling, "nights, with wind in the cold"), 0.0, 1e-6);
}

// A slope against next to nothing is anything: here 50 kW for one W/m2 of some early mornings.
TEST_F(Signatures, TheSunOfNightsIsNothing) {
  auto drivers = std::make_shared<model::Drivers>(*site_.drivers);
  const auto is_light = [](const DriverHour& hour) {
    return hour.local_hour == 4 && hour.day_index % 40 == 0 && hour.dry_bulb_C > 15.0;
  };
  int mornings = 0;
  for (DriverHour& hour : drivers->hours) {
    if (!is_light(hour)) continue;
    hour.global_horizontal_W_m2 = 1.0;
    ++mornings;
  }
  ASSERT_GT(mornings, 2);
  site_.drivers = drivers;
  const Eigen::ArrayXXd kW =
      hourly([&](const DriverHour& hour, Eigen::Index) { return is_light(hour) ? 60.0 : 10.0; });
  const double read = value(kCooling, "nights, with sun in the heat", kW);
  EXPECT_GT(read, 0.01);
  EXPECT_LT(read, 0.3) << "50 kW x 300 W/m2 / 1 W/m2 would be hundreds";
}

TEST_F(Signatures, AStepShowsInThePartsOfTheRecord) {
  const int days = site_.drivers->hours.back().day_index + 1;
  const Eigen::ArrayXXd kW = hourly([&](const DriverHour& hour, Eigen::Index) {
    return hour.day_index >= days / 2 ? 12.0 : 10.0;
  });
  const double before = value(kCooling, "nights, twelfth 3 of the record", kW);
  const double after = value(kCooling, "nights, twelfth 10 of the record", kW);
  EXPECT_GT((after - before) * (10.0 + 0.25 * site_.measured_kW.col(0).mean()), 1.0);
}

TEST_F(Signatures, LampsAreSeenByTheDark) {
  const Eigen::ArrayXXd kW = hourly([&](const DriverHour& hour, Eigen::Index) {
    return hour.sine_of_sun_altitude < 0.0 ? 14.0 : 10.0;
  });
  const double read = value(kCooling, "dark against light, evenings of workdays", kW);
  const double quarter_kW = 0.25 * site_.measured_kW.col(0).mean();
  // Of the measured evenings some hours are at 10 kW, some at 50.
  EXPECT_LT(read, 4.0 / (10.0 + quarter_kW));
  EXPECT_GT(read, 4.0 / (50.0 + quarter_kW));
}

// A building that is closed on days that its calendar has as workdays: each calendar is asked.
TEST_F(Signatures, PublicHolidaysAreTheirOwnCalendars) {
  constexpr std::size_t kNorthAmerica = 0;
  const DateTable& closed = public_holidays(kNorthAmerica);
  const Eigen::ArrayXXd kW = hourly([&](const DriverHour& hour, Eigen::Index meter) {
    if (meter == 1) return 10.0;
    const bool is_day =
        hour.day == model::DayType::workday && hour.local_hour >= 7 && hour.local_hour < 19;
    return is_day && !closed.contains(hour.date) ? 50.0 : 10.0;
  });
  const auto change = [&](const std::string& calendar) {
    const std::string name = "occupied hours, workdays that are public holidays in " + calendar;
    return value(kCooling, name, kW) - measured(kCooling, name);
  };
  EXPECT_LT(change("North America"), -0.3);
  EXPECT_GT(change("Britain"), 0.7 * change("North America"));  // some days are of both
}

// Only hours that were measured count, in the modelled ones too: else a gap would look like an
// effect.
TEST_F(Signatures, WhatWasNotMeasuredCountsNowhere) {
  const Eigen::ArrayXXd complete = site_.measured_kW;
  Eigen::ArrayXXd wrong_in_the_gap = complete;
  for (Eigen::Index i = 3000; i < 3400; ++i) {
    site_.measured_kW(i, 0) = std::numeric_limits<double>::quiet_NaN();
    wrong_in_the_gap(i, 0) = 1e6;
  }
  const SignatureReader reader(site_);
  const Eigen::VectorXd expected = reader.read(complete).col(1);
  const Eigen::VectorXd wrong = reader.read(wrong_in_the_gap).col(1);
  const Eigen::VectorXd measured = reader.read(site_.measured_kW).col(1);
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    const std::string& name = signature_names()[static_cast<std::size_t>(i)];
    for (const double value : {wrong[i], measured[i]}) {
      if (std::isfinite(expected[i])) {
        EXPECT_NEAR(value, expected[i], 1e-9) << name;
      } else {
        EXPECT_TRUE(std::isnan(value)) << name;
      }
    }
  }
}

// Months without readings or weather are left out of the record: no signature may depend on it.
TEST_F(Signatures, AMonthLeftOutTakesNothingElseAlong) {
  auto drivers = std::make_shared<model::Drivers>(*site_.drivers);
  std::erase_if(drivers->hours, [](const DriverHour& hour) { return hour.month == 4; });
  Eigen::ArrayXXd kept(static_cast<Eigen::Index>(drivers->hours.size()), 2);
  Eigen::Index to = 0;
  for (Eigen::Index from = 0; from < site_.measured_kW.rows(); ++from) {
    if (site_.drivers->hours[static_cast<std::size_t>(from)].month == 4) continue;
    kept.row(to++) = site_.measured_kW.row(from);
  }
  site_.drivers = drivers;
  site_.measured_kW = kept;
  EXPECT_TRUE(std::isfinite(measured(kHeat, "nights, with warmth of the day before")));
  EXPECT_TRUE(std::isnan(measured(kHeat, "nights, May")));
  EXPECT_TRUE(std::isfinite(measured(kHeat, "nights, June")));
}

TEST_F(Signatures, SummerAgainstWinterIsPositiveWhereSummerIsHigher) {
  const Eigen::ArrayXXd kW = hourly([&](const DriverHour& hour, Eigen::Index) {
    return 10.0 - std::cos(2.0 * std::numbers::pi * hour.day_of_year / 365.25);
  });
  EXPECT_GT(value(kCooling, "nights, summer against winter", kW), 0.0);
}

TEST_F(Signatures, AreLinearInThePower) {
  const SignatureReader reader(site_);
  const Eigen::MatrixXd once = reader.read(site_.measured_kW);
  const Eigen::MatrixXd twice = reader.read(2.0 * site_.measured_kW);
  const auto& names = signature_names();
  int known = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double was = once(static_cast<Eigen::Index>(i), static_cast<int>(kHeat));
    if (!std::isfinite(was)) continue;
    EXPECT_NEAR(twice(static_cast<Eigen::Index>(i), static_cast<int>(kHeat)), 2.0 * was, 1e-9)
        << names[i];
    ++known;
  }
  EXPECT_GT(known, 100);
}

// Lights and plugs are read off the electricity meter: what runs at the same hours all year is
// among them, and says nothing.
TEST_F(Signatures, OfElectricityKnowNoUsualDay) {
  become_electricity();
  const Eigen::ArrayXXd fans = hourly([&](const DriverHour& hour, Eigen::Index) {
    return hour.day == model::DayType::saturday ? 12.0 : 0.5 * hour.local_hour;
  });
  const SignatureReader reader(site_);
  const Eigen::MatrixXd usual = reader.read(fans + site_.measured_kW);
  const Eigen::MatrixXd was = reader.read(site_.measured_kW);
  EXPECT_LT((usual - was).col(0).array().isFinite().select((usual - was).col(0), 0.0).norm(), 1e-9);
  const int days = site_.drivers->hours.back().day_index + 1;
  const Eigen::ArrayXXd step = hourly([&](const DriverHour& hour, Eigen::Index) {
    return hour.day_index >= days / 2 ? 12.0 : 10.0;
  });
  EXPECT_GT(value(kElectricity, "nights, twelfth 10 of the record", step),
            value(kElectricity, "nights, twelfth 3 of the record", step) + 0.05);
}

/// With a meter of this utility.
class SpansOf : public Signatures, public ::testing::WithParamInterface<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, SpansOf, ::testing::Values("chilled_water", "electricity"),
                         [](const auto& utility) { return utility.param; });

// What is told of a span without reading the record anew.
TEST_P(SpansOf, AreThoseOfTheMixedRecord) {
  if (GetParam() == "electricity") become_electricity();
  const Eigen::ArrayXXd other = hourly([&](const DriverHour& hour, Eigen::Index meter) {
    const double earlier = hour.local_hour == 5 || hour.local_hour == 6 ? 40.0 : 0.0;
    return meter == 1 ? 2.0 * std::max(17.0 - hour.dry_bulb_C, 0.0)
                      : 12.0 + (hour.day == model::DayType::sunday_or_holiday ? 0.0 : earlier) +
                            (hour.local_hour >= 7 && hour.local_hour < 20 ? 35.0 : 0.0);
  });
  constexpr int kFrom = 61;
  constexpr int kTo = 240;
  Eigen::ArrayXXd mixed = site_.measured_kW;
  for (Eigen::Index i = 0; i < mixed.rows(); ++i) {
    const int day = site_.drivers->hours[static_cast<std::size_t>(i)].day_index;
    if (day >= kFrom && day < kTo) mixed.row(i) = other.row(i);
  }
  const SignatureReader reader(site_);
  SpanReader spans(reader, site_.measured_kW);
  spans.take(other);
  const Eigen::MatrixXd change = spans.change(kFrom, kTo);
  const Eigen::MatrixXd expected = reader.read(mixed) - reader.read(site_.measured_kW);
  int known = 0;
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    const double wanted = expected.data()[i];
    if (!std::isfinite(wanted)) continue;
    EXPECT_NEAR(change.data()[i], wanted, 1e-9) << i;
    ++known;
  }
  EXPECT_GT(known, 200);
  const Eigen::MatrixXd none = spans.change(30, 30);
  EXPECT_TRUE((none.array() == 0.0 || none.array().isNaN()).all()) << "no day";
  EXPECT_TRUE((none.array() == 0.0).any());
}

// Gas for a few taps: by its own mean it would seem to change many times over.
TEST_F(Signatures, ASmallMeterIsMeasuredByWhatAllMetersCount) {
  const double small_kW = 0.03 * site_.measured_kW.col(0).mean();
  site_.measured_kW.col(1) = small_kW;
  const double all_kW = small_kW + site_.measured_kW.col(0).mean();
  EXPECT_NEAR(measured(kHeat, "workdays, when cold, 00 to 02 h"),
              small_kW / (0.25 * 0.05 * all_kW + small_kW), 1e-9);
}

}  // namespace
}  // namespace recald::diagnosis::signatures_test
