/// Power averaged over six four-hour parts of each local day, the resolution at which effects
/// are distinguished.
///
/// Monthly figures cannot identify effects, and single hours cost too much; four hours show nights,
/// mornings, working hours and evenings.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/model/drivers.hpp"

namespace recald::diagnosis {

inline constexpr int kPartsPerDay = 6;
inline constexpr int kPartsPerWeek = 7 * kPartsPerDay;
inline constexpr int kHoursPerPart = 24 / kPartsPerDay;

/// The use of a block. Buffers between the others prevent leakage across the split.
enum class Role { fit, select, show, buffer };

struct DayPart {
  metering::Day date;
  int part;          ///< 0…5: 00–04 h … 20–24 h local.
  int day_index;     ///< As `DriverHour::day_index`.
  int part_of_week;  ///< 0…41 from Sunday 00 h; holidays keep their weekday.
  int first_hour;    ///< Index into Drivers::hours.
  int hours;         ///< 3, 4 or 5.
  int month;         ///< Index into Drivers::months.
  model::DayType day;
  double time_h;      ///< Middle, hours since the first hour of the period.
  double dry_bulb_C;  ///< Means over the part.
  double humidity_ratio;
  double wind_m_s;
  double global_horizontal_W_m2;
};

/// The parts of a period, in order of time.
struct DayParts {
  std::vector<DayPart> parts;
  /// Means of hourly columns over the parts. @param hourly  (hours x m) @param means  (parts x m)
  void average_into(const Eigen::Ref<const Eigen::ArrayXXd>& hourly, Eigen::ArrayXXd& means) const;
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(parts.size()); }
};

[[nodiscard]] DayParts make_day_parts(const model::Drivers& drivers);

/// Means of measured hours over the parts; NaN if less than three quarters of a part's hours were
/// measured, since filled hours carry no information.
/// @param hourly_kW  (hours x m) NaN where not measured.
[[nodiscard]] Eigen::ArrayXXd measured_parts(const DayParts& day_parts,
                                             const Eigen::Ref<const Eigen::ArrayXXd>& hourly_kW);

struct SplitOptions {
  double show_share = 0.2;
  double select_share = 0.2;
  int buffer_days = 7;
  int last_months_to_show = 3;
};

/// Assigns whole months to fitting, choosing and the final check: the last three months are held
/// out for the check (`show`), and at least one winter and one summer month if the period has them.
/// @return one role per month, before buffers. Fewer than 6 months: all fit.
[[nodiscard]] std::vector<Role> split_months(const std::vector<metering::Month>& months,
                                             const SplitOptions& options);

/// As above, for months with readings. A month without readings proves nothing, so it is not held
/// out: it counts as one to fit and adds nothing.
/// @param read  Some of `months`, in their order.
[[nodiscard]] std::vector<Role> split_months(const std::vector<metering::Month>& months,
                                             const std::vector<metering::Month>& read,
                                             const SplitOptions& options);

/// One role per part: its month's, or buffer within `buffer_days` of a month with another role.
/// Buffers are taken from the fitted side, so that held-out months stay complete.
[[nodiscard]] std::vector<Role> part_roles(const DayParts& day_parts,
                                           const std::vector<Role>& month_roles, int buffer_days);

}  // namespace recald::diagnosis
