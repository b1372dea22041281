#include "core/model/hourly/prepare.hpp"

#include <map>
#include <memory>
#include <utility>

#include "core/model/hourly/hourly.hpp"

namespace recald::model::hourly {
namespace {

constexpr int kRounds = 4;

using LocalHour = std::pair<metering::Day, int>;

/// A value by local date and hour. The two values of an hour that a clock change repeats are
/// averaged, like the recorded loads.
class HourlyMeans {
 public:
  void add(const LocalHour& hour, double kW) {
    Sum& sum = sums_[hour];
    sum.kW += kW;
    sum.n += 1.0;
  }
  /// 0 if nothing was added.
  [[nodiscard]] double at(const LocalHour& hour) const {
    const auto found = sums_.find(hour);
    return found == sums_.end() ? 0.0 : found->second.kW / found->second.n;
  }

 private:
  struct Sum {
    double kW = 0.0;
    double n = 0.0;
  };
  std::map<LocalHour, Sum> sums_;
};

HourlyMeans plant_electricity(const Building& building, Drivers drivers) {
  MeterMap plant;
  for (const EndUse use : {EndUse::fans, EndUse::pumps, EndUse::chiller, EndUse::exterior}) {
    plant[use] = 1.0;
  }
  const auto shared = std::make_shared<const Drivers>(std::move(drivers));
  Hourly hourly{shared};
  Eigen::ArrayXXd power_kW(hourly.step_count(), 1);
  hourly.run(building, {}, {&plant, 1}, power_kW);
  HourlyMeans means;
  for (std::size_t i = 0; i < shared->hours.size(); ++i) {
    const DriverHour& hour = shared->hours[i];
    means.add({hour.date, hour.local_hour}, power_kW(static_cast<Eigen::Index>(i), 0));
  }
  return means;
}

/// Mean of the subtracted loads, by kind of day and hour.
HourlySchedule mean_schedule(std::span<const model::HourlyLoad> loads, const Holidays& holidays,
                             const HourlyMeans& taken) {
  HourlySchedule sum_kW;
  HourlySchedule count;
  for (const model::HourlyLoad& load : loads) {
    const DayType day = day_type(load.date, holidays);
    sum_kW.at(day, load.hour) += taken.at({load.date, load.hour});
    count.at(day, load.hour) += 1.0;
  }
  for (std::size_t i = 0; i < kDayTypes; ++i) {
    const auto day = static_cast<DayType>(i);
    for (int hour = 0; hour < 24; ++hour) {
      if (count.at(day, hour) > 0.0) sum_kW.at(day, hour) /= count.at(day, hour);
    }
  }
  return sum_kW;
}

void add_to(HourlySchedule& schedule, const HourlySchedule& other) {
  for (std::size_t i = 0; i < kDayTypes; ++i) {
    const auto day = static_cast<DayType>(i);
    for (int hour = 0; hour < 24; ++hour) schedule.at(day, hour) += other.at(day, hour);
  }
}

}  // namespace

Result<model::ElectricityProfile> fit_profile_without_plant(
    std::span<const model::HourlyLoad> loads, const Building& building, const epc::Place& place,
    const std::vector<metering::Month>& months) {
  // Outdoor lamps follow the sun, not the clock, so they are subtracted with the plant.
  const model::KnownLoads known{.exterior_kW = 0.0,
                                .fans_and_pumps_kW = {},
                                .lighting_W_m2 = building.use.lighting_W_m2,
                                .plugs_W_m2 = building.use.plugs_W_m2};
  auto profile = model::fit_profile(loads, place.holidays, known);
  std::vector<model::HourlyLoad> rest(loads.begin(), loads.end());
  for (int round = 0; profile && round < kRounds; ++round) {
    auto drivers =
        TRY(make_drivers(months, place.calendar, place.holidays, building, profile->loads,
                         place.location, place.weather, MissingWeather::assume));
    const HourlyMeans plant = plant_electricity(building, std::move(drivers));
    for (std::size_t i = 0; i < rest.size(); ++i) {
      rest[i].mean_kW = loads[i].mean_kW - plant.at({loads[i].date, loads[i].hour});
    }
    profile = model::fit_profile(rest, place.holidays, known);
    if (!profile || round + 1 < kRounds) continue;
    profile->known.fans_and_pumps_kW = mean_schedule(loads, place.holidays, plant);
    add_to(profile->measured_kW, profile->known.fans_and_pumps_kW);
  }
  return profile;
}

}  // namespace recald::model::hourly
