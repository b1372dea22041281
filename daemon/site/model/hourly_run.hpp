/// The hourly model of the drawings over weather that ends before the month does.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "core/model/building.hpp"
#include "core/model/drivers.hpp"
#include "core/model/end_use.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::daemon {

/// (hours x outputs) kW of the building.
[[nodiscard]] Eigen::ArrayXXd modelled_kW(const model::Building& building,
                                          std::shared_ptr<const model::Drivers> drivers,
                                          std::span<const model::MeterMap> maps);

/// The weather from `from` on, as it is known at `known_until`; its last seven days go on from
/// there to `until`. Less than seven days are given back as they are.
[[nodiscard]] weather::WeatherSeries continued(const weather::WeatherSeries& series,
                                               metering::Instant from,
                                               metering::Instant known_until,
                                               metering::Instant until);

}  // namespace recald::daemon
