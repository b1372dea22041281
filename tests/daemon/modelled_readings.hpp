/// Meters that say what the hourly model gives: what is tested on them is the machinery, never that
/// an effect of a real building is found.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/metering/civil_time.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

/// Puts what the hourly model gives into the folder's readings, hour after hour.
/// @param alteration  Applied to the model; may be null.
/// @pre the site is the depot's, its months are all of the year, and heat is its second meter.
inline void write_modelled_readings(const std::filesystem::path& folder,
                                    const diagnosis::SiteProblem& site,
                                    const model::hourly::Alteration* alteration) {
  diagnosis::Predictor predictor{site};
  predictor.parts_kW({}, alteration);
  const Eigen::ArrayXXd& hours_kW = predictor.hours_kW();
  std::string readings = "timestamp,meter,value,unit\n";
  for (Eigen::Index i = 0; i < hours_kW.rows(); ++i) {
    const std::string stamp =
        metering::to_string(site.drivers->hours[static_cast<std::size_t>(i)].start);
    // No two hours alike: a meter that stands still is not believed.
    const double wiggle = 1.0 + 0.02 * std::sin(1.3 * static_cast<double>(i));
    readings += stamp + ",electricity," + std::to_string(wiggle * hours_kW(i, 0)) + ",kW\n";
    readings += stamp + ",heat," + std::to_string(wiggle * hours_kW(i, 1)) + ",kWh\n";
  }
  write_text(folder / "readings.csv", readings);
}

}  // namespace recald::testing
