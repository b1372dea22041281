/// Least squares of base loads and a curve whose balance temperatures are not known.
#pragma once

#include <array>
#include <vector>

#include "core/change_point/curve.hpp"
#include "core/change_point/temperature_sums.hpp"
#include "core/model/schedule.hpp"

namespace recald::change_point {

/// Kinds of day that share a curve: the number of each kind's base load, or kNotInGroup.
using DayGroup = std::array<int, model::kDayTypes>;
inline constexpr int kNotInGroup = -1;

/// Edges that a balance temperature may be, such that enough days lie on the side with a slope.
/// Nothing is allowed where first > last.
struct EdgeLimits {
  int heating_first;  ///< Up to the last edge of all.
  int cooling_last;   ///< From edge 0.
};

struct GroupFit {
  Curve curve;
  std::array<double, model::kDayTypes> base_kWh;  ///< By the group's number of the base load.
};

/// Minimises  sum w (E - base - curve(T))^2  over base loads, slopes and balance temperatures, the
/// latter to a tenth of a kelvin: a grid of whole kelvins, then each in turn within a kelvin of the
/// best point. For given balance temperatures the minimum is exact.
/// @note  O(K^2) for K kelvins of range. Does not allocate once it has seen the widest range.
class CurveSearch {
 public:
  /// All forms at once. A form that no balance temperature allows, or whose slopes would have the
  /// wrong sign everywhere, comes back as the best simpler one that it contains.
  /// @pre each base load of the group has days of positive weight.
  [[nodiscard]] std::array<GroupFit, kForms> fit(const TemperatureSums& sums, const DayGroup& group,
                                                 EdgeLimits limits);

 private:
  /// A hinge's products once the base loads are eliminated (the Schur complement).
  struct Hinge {
    double square = 0.0;                               ///< with itself, K²
    double product = 0.0;                              ///< with E, kWh K
    std::array<double, model::kDayTypes> with_base{};  ///< with each unit vector of a base, K
  };
  struct Slopes {
    double heating = 0.0;
    double cooling = 0.0;
    double gain = 0.0;  ///< By how much the sum of squares falls, kWh²; < 0: not allowed.
  };
  struct Found {
    int heating_edge = 0;
    int cooling_edge = 0;
    Slopes slopes;
  };

  void begin(const TemperatureSums& sums, const DayGroup& group);
  [[nodiscard]] Hinge heating_hinge(int edge) const;
  [[nodiscard]] Hinge cooling_hinge(int edge) const;
  void eliminate_bases(Hinge& hinge) const;
  [[nodiscard]] Slopes one_slope(const Hinge& hinge, bool heats) const;
  [[nodiscard]] Slopes two_slopes(const Hinge& cold, const Hinge& warm) const;
  [[nodiscard]] Found search_one(EdgeLimits limits, bool heats) const;
  [[nodiscard]] Found search_4p(EdgeLimits limits) const;
  [[nodiscard]] Found search_5p(EdgeLimits limits);
  void refine_5p(EdgeLimits limits, Found& best) const;
  [[nodiscard]] GroupFit assemble(Form form, const Found& found) const;

  const TemperatureSums* sums_ = nullptr;
  DayGroup group_{};
  double least_square_ = 0.0;  ///< A hinge below it does not vary.
  /// Of the unit vector of each base load: 1 / sqrt(sum w), 0 where the group has none, and its
  /// product with E, kWh.
  std::array<double, model::kDayTypes> inverse_norm_{};
  std::array<double, model::kDayTypes> energy_{};
  std::vector<Hinge> cold_;  ///< At whole kelvins.
  std::vector<Hinge> warm_;
};

}  // namespace recald::change_point
