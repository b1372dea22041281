/// One run of the hourly model as it is.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "core/model/building.hpp"
#include "core/model/drivers.hpp"
#include "core/model/end_use.hpp"

namespace recald::model::hourly {

/// (hours x outputs) kW of the building.
[[nodiscard]] Eigen::ArrayXXd modelled_kW(const Building& building,
                                          std::shared_ptr<const Drivers> drivers,
                                          std::span<const MeterMap> maps);

}  // namespace recald::model::hourly
