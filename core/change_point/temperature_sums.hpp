/// Sums over days below each of many temperatures, from which least squares of any curve follow.
#pragma once

#include <array>
#include <vector>

#include "core/model/schedule.hpp"

namespace recald::change_point {

/// Weighted sums over some days, T counted from `TemperatureSums::reference_C`.
struct DaySums {
  double weight = 0.0;              ///< sum w
  double temperature = 0.0;         ///< sum w T, K
  double temperature_square = 0.0;  ///< sum w T^2, K²
  double energy = 0.0;              ///< sum w E, kWh
  double product = 0.0;             ///< sum w T E, kWh K

  DaySums& operator+=(const DaySums& other);
  friend DaySums operator-(const DaySums& a, const DaySums& b);
};

/// The sums of each kind of day below each tenth of a kelvin. A hinge max(0, a - T) is linear in T
/// on one side of `a` and zero on the other, so its products with itself, with 1 and with E are
/// linear in these sums, exactly for every `a` that is an edge: days are looked at once, not once
/// for each balance temperature tried.
class TemperatureSums {
 public:
  static constexpr int kEdgesPerKelvin = 10;

  /// @pre lowest_C <= highest_C, both finite. All days added later lie between them.
  TemperatureSums(double lowest_C, double highest_C);

  void clear();
  void add(model::DayType type, double dry_bulb_C, double energy_kWh, double weight);
  /// To be called once all days are added.
  void cumulate();

  [[nodiscard]] int last_edge() const { return edges_ - 1; }
  [[nodiscard]] double edge_C(int edge) const;
  [[nodiscard]] double reference_C() const { return reference_C_; }
  [[nodiscard]] const DaySums& below(model::DayType type, int edge) const {
    return sums_[static_cast<std::size_t>(type)][static_cast<std::size_t>(edge)];
  }
  [[nodiscard]] const DaySums& all(model::DayType type) const {
    return sums_[static_cast<std::size_t>(type)].back();
  }

 private:
  int lowest_tenth_;  ///< The first edge, in tenths of a degree.
  int edges_;
  double reference_C_;
  std::array<std::vector<DaySums>, model::kDayTypes> sums_;
};

}  // namespace recald::change_point
