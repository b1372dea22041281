/// One local day of one meter, as the change-point regression takes it.
#pragma once

#include "core/metering/civil_time.hpp"
#include "core/model/schedule.hpp"

namespace recald::change_point {

struct MeterDay {
  metering::Day date;
  model::DayType type;
  double
      energy_kWh;  ///< Of the whole day; NaN where it is not usable. Not looked at in a forecast.
  double dry_bulb_C;  ///< Mean over the day; NaN where it is not known.
};

}  // namespace recald::change_point
