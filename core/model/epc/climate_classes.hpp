/// A month reduced to a few classes of similar hours, so that the model need not visit each hour.
///
/// Anything with a max(), a root or a product of schedule and weather must be evaluated before it
/// is averaged. Hours of one month and state (occupied or not) are separated by time of day,
/// because the sun's position differs, sorted by outdoor temperature within each part and cut into
/// classes of equal count; within a class all values are means. Humidity does not follow
/// temperature closely enough, so the latent terms have their own prefix sums.
#pragma once

#include <span>
#include <vector>

#include "core/model/drivers.hpp"

namespace recald::model::epc {

struct ClimateClass {
  double hours;
  double dry_bulb_C;
  double wind2_m2_s2;  ///< Mean of the square: infiltration grows with v².
  double occupied_fraction;
  double lights_W;
  double plugs_W;
  double humidity_ratio;  ///< kg/kg
};

/// Unoccupied stretches of similar length and outdoor temperature.
struct StretchClass {
  double hours;     ///< All stretches of the class together.
  double length_h;  ///< Mean length of one.
  double dry_bulb_C;
};

/// Hours of one month in one state, occupied or not.
struct ClimateState {
  double hours = 0.0;
  int first_class = 0;
  int classes = 0;
  std::vector<double> humidity_ratio;      ///< Ascending.
  std::vector<double> humidity_ratio_sum;  ///< Prefix sums: [i] is the sum of the first i.

  /// Σ max(w − cut, 0) over the hours of the state, kg/kg · h.
  [[nodiscard]] double excess_over(double cut) const;
  /// Σ max(cut − w, 0) over the hours of the state.
  [[nodiscard]] double shortfall_under(double cut) const;
};

struct ClimateMonth {
  int days;
  double day_of_year_mid;  ///< Middle of the month, for the cold water's season.
  ClimateState occupied;
  ClimateState unoccupied;
  std::vector<StretchClass> stretches;
  double heating_share = 1.0;  ///< Share of the hours in which the plant runs.
  double cooling_share = 1.0;
};

struct ClimateClasses {
  std::vector<ClimateMonth> months;
  std::vector<ClimateClass> classes;
  std::vector<double> irradiance_W_m2;  ///< [class * orientations + orientation]
  std::vector<weather::Orientation> orientations;
  double pressure_Pa;

  [[nodiscard]] std::span<const double> irradiance(int class_index) const;
};

/// @param classes_per_state  Equal-count classes per month and state; 0 makes every hour its own
///                           class, which gives the plain hourly sum that the classes approximate.
[[nodiscard]] ClimateClasses make_climate_classes(const Drivers& drivers, int classes_per_state);

}  // namespace recald::model::epc
