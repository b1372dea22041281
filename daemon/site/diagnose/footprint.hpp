/// What an effect adds to a site's meters, from readings to the hours that a diagnosis works in.
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Collects intervals of any length into the hours of a site. What is never added is zero.
class FootprintHours {
 public:
  /// @param site  Must outlive this.
  explicit FootprintHours(const diagnosis::SiteProblem& site);

  /// Intervals outside the site's hours are left out.
  /// @param meter    Column: index into the site's meters.
  /// @param mean_kW  With the effect minus without, of either sign.
  void add(Eigen::Index meter, metering::Instant start, std::chrono::seconds length,
           double mean_kW);

  [[nodiscard]] const Eigen::ArrayXXd& hours_kW() const { return hours_kW_; }  ///< (hours x m)
  /// (hours x m) how much of each hour was added, in seconds.
  [[nodiscard]] const Eigen::ArrayXXd& covered_s() const { return covered_s_; }
  /// Whether anything was added that lies within the site's hours.
  [[nodiscard]] bool meets_site() const { return meets_site_; }

 private:
  const model::Drivers& drivers_;
  Eigen::ArrayXXd hours_kW_;
  Eigen::ArrayXXd covered_s_;
  bool meets_site_ = false;
};

/// Reads a footprint as the site's own readings are read: `timestamp,meter,value,unit`, meters by
/// their names in the site's files, stamps as there. Values are differences and may be negative;
/// multipliers and counters are not applied. A meter is not moved in hours without a row.
/// @return (hours x m) kW; not_found, io_failed or malformed from the file; or
///         malformed        a line that cannot be used, repeats an interval or is not in order; a
///                          blank value; an hour of which only a part is known;
///         invalid_value    a meter that the model does not have, or two of one name;
///         not_enough_data  no row, or none within the site's months.
[[nodiscard]] Result<Eigen::ArrayXXd> read_footprint(const std::filesystem::path& file,
                                                     const SiteConfig& config,
                                                     const diagnosis::SiteProblem& site);

}  // namespace recald::daemon
