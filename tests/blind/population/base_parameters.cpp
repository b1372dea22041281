#include "tests/blind/population/base_parameters.hpp"

#include <cmath>

namespace recald::blind {
namespace {

/// Standard deviation of Triangular(min, mode, max).
double triangular_sd(double min, double mode, double max) {
  return std::sqrt((min * min + mode * mode + max * max - min * mode - min * max - mode * max) /
                   18.0);
}

}  // namespace

void add_base_parameters(nlohmann::ordered_json& answer, const BaseParameters& truth,
                         const BaseParameters& drawings) {
  constexpr double kColdest_C = 20.0;
  constexpr double kWarmest_C = 27.8;
  const double people = drawings.occupancy_person_m2;
  const double air_m3_s = drawings.outdoor_air_m3_s;
  answer["true_parameters"] = {{"occupancy_density", truth.occupancy_person_m2},
                               {"outdoor_airflow", truth.outdoor_air_m3_s},
                               {"cooling_setpoint", truth.cooling_setpoint_C}};
  answer["prior_sd"] = {
      {"occupancy_density", triangular_sd(0.0, people, 2.0 * people)},
      {"outdoor_airflow", triangular_sd(0.3 * air_m3_s, air_m3_s, 1.2 * air_m3_s)},
      {"cooling_setpoint", triangular_sd(kColdest_C, drawings.cooling_setpoint_C, kWarmest_C)}};
}

}  // namespace recald::blind
