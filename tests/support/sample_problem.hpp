/// The sample building as a site to be diagnosed.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <utility>

#include "core/diagnosis/evidence/site_problem.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::testing {

/// Electricity, chilled water and steam of the sample building over two years at most; measured is
/// what the drawings give. Months have their roles.
inline diagnosis::SiteProblem sample_problem(std::span<const char* const> parameters, int months) {
  using metering::Utility;
  diagnosis::SiteProblem site;
  site.nominal = sample_building();
  for (const char* name : parameters) {
    site.parameters.push_back(*model::make_parameter(**model::find_parameter(name), site.nominal));
  }
  site.drivers = std::make_shared<const model::Drivers>(sample_drivers(site.nominal, months));
  for (const auto& [id, utility] :
       {std::pair{"electricity", Utility::electricity},
        std::pair{"chilled_water", Utility::chilled_water}, std::pair{"steam", Utility::steam}}) {
    site.meters.push_back({id, utility, *model::default_meter_map(utility)});
  }
  site.day_parts = diagnosis::make_day_parts(*site.drivers);
  site.month_roles = diagnosis::split_months(site.drivers->months, {});
  site.roles = diagnosis::part_roles(site.day_parts, site.month_roles, 7);
  diagnosis::Predictor predictor{site};
  site.measured_parts_kW = predictor.parts_kW({});
  site.measured_kW = predictor.hours_kW();
  return site;
}

}  // namespace recald::testing
