/// One diagram within a figure: scale, grid, curves and bars.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/footprint/svg.hpp"

namespace recald::simulators {

/// Round numbers along an axis, `step` apart, starting at `first`.
struct Ticks {
  double first;
  double step;
  int count;

  [[nodiscard]] double at(int i) const { return first + step * i; }
  [[nodiscard]] double last() const { return at(count - 1); }
  /// With as many decimals as the step has.
  [[nodiscard]] std::string label(int i) const;
};

/// The finest ticks of 1, 2 or 5 times a power of ten with at most `intervals + 1`, and at least
/// two, from `low` to `high`.
/// @pre low < high, both finite; intervals >= 4
[[nodiscard]] Ticks nice_ticks(double low, double high, int intervals);

/// The meaning of a diagram's height.
struct Scale {
  double low;
  double high;
  Ticks ticks;
};

/// The range of all values seen, and zero, with a margin beyond the extremes but not beyond zero.
class ValueRange {
 public:
  void include(std::span<const double> values);
  /// Widens a smaller range to half of this on both sides of zero, so that tiny values
  /// do not look large.
  void widen_to(double span_min);
  /// From 0 to 1 if all values are zero.
  [[nodiscard]] Scale scale(int intervals) const;

 private:
  double low_ = 0.0;
  double high_ = 0.0;
};

/// A label below the diagram, where x is `at`.
struct Mark {
  double at;
  std::string text;
};

class Plot {
 public:
  /// Draws the grid and its labels; x runs from 0 to `x_max`.
  Plot(Svg& svg, const Box& frame, double x_max, const Scale& y);

  /// Above the top left corner.
  void caption(std::string_view what);
  void x_marks(std::span<const Mark> marks);
  /// Vertical grid lines, evenly spaced over the x axis, including both ends.
  void x_rules(int parts);
  /// One value per equal part of the x axis, drawn at its middle.
  void curve(std::span<const double> values, const Stroke& stroke);
  /// One value per part of the x axis, in the `place`-th of `places` columns of it.
  void bars(std::span<const double> values, std::string_view colour, std::size_t place,
            std::size_t places);
  /// The zero line over everything drawn, as the base of curves and bars.
  void zero_line();

 private:
  [[nodiscard]] double x_px(double x) const;
  [[nodiscard]] double y_px(double y) const;

  Svg& svg_;
  Box frame_;
  double x_max_;
  Scale y_;
};

}  // namespace recald::simulators
