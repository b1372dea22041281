/// A site's own model over a design of experiments: what is run, by what, and what was measured.
#pragma once

#include <cstdint>
#include <string>

#include "adapters/doe/design_writer.hpp"
#include "adapters/engines/built_in_engine.hpp"
#include "core/design/latin_hypercube.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"

namespace recald::daemon {

struct SiteDesignOptions {
  int runs = 200;
  std::uint64_t seed = 1;
  design::Points points = design::Points::wide;
  std::string fingerprint;  ///< Of site file, data and program: what a run depends on.
};

/// Daily averages and peaks of a site's months, by name of the output. NaN: not measured.
[[nodiscard]] doe::MonthlyTable measured_table(const PreparedSite& site);

/// What is to be run, and with what it is to be compared.
[[nodiscard]] doe::DesignPlan plan_design(const PreparedSite& site,
                                          const SiteDesignOptions& options);

/// The site's model of the calibration months, ready to be run.
[[nodiscard]] engines::BuiltInEngine site_engine(const PreparedSite& site);

}  // namespace recald::daemon
