/// Statistics of a generated climate, in the terms used for published climates.
#pragma once

#include <string>
#include <vector>

#include "simulators/climate/normals.hpp"
#include "simulators/climate/weather.hpp"

namespace recald::simulators {

/// Collects steps into the quantities of `Normals`. Days follow the mean sun at the place, so a day
/// has one minimum and one maximum and needs no time zone.
class ClimateStatistics {
 public:
  /// @param first_day  By the mean sun; the first step begins at its midnight.
  /// @pre the step divides a day
  ClimateStatistics(std::chrono::sys_days first_day, std::chrono::seconds step);

  void add(const Outdoors& outdoors);

  /// @pre whole years were added, at least one
  [[nodiscard]] Normals result() const;

 private:
  struct Month {
    double steps = 0.0;
    double dry_bulb_C = 0.0;
    double dew_point_C = 0.0;
    double wind_m_s = 0.0;
    double global_W_m2 = 0.0;
    double precipitation_mm = 0.0;
    double range_K = 0.0;
    double days = 0.0;
  };

  struct Today {
    int steps = 0;
    double sum_C = 0.0;
    double lowest_C = 99.0;
    double highest_C = -99.0;
    double precipitation_mm = 0.0;
  };

  void end_day();

  std::chrono::sys_days date_;
  int steps_a_day_;
  std::array<Month, 12> months_{};
  Today today_;
  std::vector<double> dry_bulbs_C_;
  std::vector<double> year_lowest_C_;
  std::vector<double> year_highest_C_;
  double days_ = 0.0;
  double wet_days_ = 0.0;
  double snowfall_mm_ = 0.0;
  double heating_K_days_ = 0.0;
  double cooling_K_days_ = 0.0;
};

/// The statistics of `years` simulated calendar years from 2021 at the comparable city.
[[nodiscard]] Normals simulated_normals(ClimateKind kind, int years, std::uint64_t seed,
                                        std::chrono::seconds step = kStep);

/// Simulated and published values of all climates, as a Markdown table.
[[nodiscard]] std::string climate_table(int years, std::uint64_t seed);

}  // namespace recald::simulators
