#include "core/model/hourly/hourly_run.hpp"

#include <utility>

#include "core/model/hourly/hourly.hpp"

namespace recald::model::hourly {

Eigen::ArrayXXd modelled_kW(const Building& building, std::shared_ptr<const Drivers> drivers,
                            std::span<const MeterMap> maps) {
  Hourly hourly{std::move(drivers)};
  Eigen::ArrayXXd power_kW(hourly.step_count(), static_cast<Eigen::Index>(maps.size()));
  hourly.run(building, {}, maps, power_kW);
  return power_kW;
}

}  // namespace recald::model::hourly
