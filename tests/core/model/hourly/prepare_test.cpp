#include "core/model/hourly/prepare.hpp"

#include <gtest/gtest.h>

#include "core/model/hourly/hourly.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::model::hourly::prepare_test {
namespace {

// Made with the model's own fans, pumps and chiller, the meter must give back the loads that went
// in: counted twice they would come back a fifth too high in summer.
TEST(FitProfileWithoutPlant, FindsTheLoadsBesideAnOwnChiller) {
  Building building = testing::sample_building();
  building.chiller_cop = 4.0;
  const auto calendar = *metering::LocalCalendar::open("America/New_York");
  const auto begin = std::chrono::sys_days{std::chrono::year{2020} / 12 / 31};
  const auto weather = testing::sample_weather(begin, 24 * 380);
  const auto months = testing::months_of_2021_22(12);
  const Holidays holidays;
  const auto drivers = std::make_shared<const Drivers>(testing::sample_drivers(building, 12));
  Hourly hourly{drivers};
  const MeterMap electricity = *default_meter_map(metering::Utility::electricity);
  Eigen::ArrayXXd power_kW(hourly.step_count(), 1);
  hourly.run(building, {}, {&electricity, 1}, power_kW);
  std::vector<model::HourlyLoad> loads;
  for (std::size_t i = 0; i < drivers->hours.size(); ++i) {
    const DriverHour& hour = drivers->hours[i];
    if (!loads.empty() && loads.back().date == hour.date && loads.back().hour == hour.local_hour) {
      continue;  // the hour that the clock repeats is recorded once
    }
    loads.push_back(
        {hour.date, hour.local_hour, power_kW(static_cast<Eigen::Index>(i), 0), 1.0, false});
  }

  const auto profile = fit_profile_without_plant(
      loads, building, {calendar, holidays, testing::sample_location(), weather}, months);
  ASSERT_TRUE(profile.has_value()) << profile.error().message;
  const ElectricLoads truth = testing::sample_loads();
  for (const auto& [day, hour] :
       {std::pair{DayType::workday, 14}, {DayType::workday, 3}, {DayType::saturday, 12}}) {
    const double found_kW =
        profile->loads.lights_kW.at(day, hour) + profile->loads.plugs_kW.at(day, hour);
    const double true_kW = truth.lights_kW.at(day, hour) + truth.plugs_kW.at(day, hour);
    EXPECT_NEAR(found_kW, true_kW, 0.01 * true_kW) << hour << " h";
    EXPECT_NEAR(profile->measured_kW.at(day, hour),
                found_kW + profile->known.fans_and_pumps_kW.at(day, hour), 1e-6);
  }
  EXPECT_TRUE(profile->check.constant) << profile->check.monthly_cvrmse;
}

}  // namespace
}  // namespace recald::model::hourly::prepare_test
