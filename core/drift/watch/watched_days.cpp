#include "core/drift/watch/watched_days.hpp"

#include <algorithm>
#include <cmath>

#include "core/absent.hpp"

namespace recald::drift {
namespace {

constexpr int kFewestHours = 20;  // of a day, to judge it

/// A day as it is put together from its hours.
struct Sum {
  double measured = 0.0;
  double modelled = 0.0;
  int hours = 0;
};

/// The followed month of each of the model's; -1: none.
std::vector<int> months_followed(const std::vector<metering::Month>& modelled,
                                 const std::vector<std::string>& followed) {
  std::vector<int> indices;
  for (const metering::Month month : modelled) {
    const auto found = std::ranges::find(followed, metering::to_string(month));
    indices.push_back(found == followed.end() ? -1 : static_cast<int>(found - followed.begin()));
  }
  return indices;
}

}  // namespace

DayFrame frame_of(const model::Drivers& drivers, const std::vector<std::string>& followed) {
  const std::vector<int> months = months_followed(drivers.months, followed);
  DayFrame frame;
  std::vector<double> hours;
  for (const model::DriverHour& hour : drivers.hours) {
    const int month = months[static_cast<std::size_t>(hour.month)];
    frame.day_of_hour.push_back(-1);
    if (month < 0) continue;
    if (frame.days.empty() || frame.days.back().date != hour.date) {
      frame.days.push_back({.date = hour.date,
                            .month = month,
                            .is_workday = hour.day == model::DayType::workday,
                            .dry_bulb_C = 0.0,
                            .humidity_ratio = 0.0,
                            .modelled_kW = 0.0,
                            .measured_kW = kAbsent});
      hours.push_back(0.0);
    }
    frame.day_of_hour.back() = static_cast<int>(frame.days.size()) - 1;
    frame.days.back().dry_bulb_C += hour.dry_bulb_C;
    frame.days.back().humidity_ratio += hour.humidity_ratio;
    hours.back() += 1.0;
  }
  for (std::size_t i = 0; i < hours.size(); ++i) {
    frame.days[i].dry_bulb_C /= hours[i];
    frame.days[i].humidity_ratio /= hours[i];
  }
  return frame;
}

std::vector<WatchedDay> days_of(const DayFrame& frame, std::span<const double> followed,
                                const Eigen::Ref<const Eigen::ArrayXd>& measured_kW,
                                const Eigen::Ref<const Eigen::ArrayXd>& modelled_kW) {
  std::vector<Sum> sums(frame.days.size());
  for (std::size_t i = 0; i < frame.day_of_hour.size(); ++i) {
    const double measured = measured_kW(static_cast<Eigen::Index>(i));
    if (frame.day_of_hour[i] < 0 || std::isnan(measured)) continue;
    Sum& sum = sums[static_cast<std::size_t>(frame.day_of_hour[i])];
    sum.measured += measured;
    sum.modelled += modelled_kW(static_cast<Eigen::Index>(i));
    ++sum.hours;
  }
  std::vector<WatchedDay> days = frame.days;
  for (std::size_t i = 0; i < days.size(); ++i) {
    const bool is_followed = !std::isnan(followed[static_cast<std::size_t>(days[i].month)]);
    if (!is_followed || sums[i].hours < kFewestHours) continue;
    days[i].measured_kW = sums[i].measured / sums[i].hours;
    days[i].modelled_kW = sums[i].modelled / sums[i].hours;
  }
  return days;
}

}  // namespace recald::drift
