/// One diagram within a figure: a scale, a grid, curves and bars.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/footprint/svg.hpp"

namespace recald::simulators {

/// Round numbers along an axis, `step` apart, from `first` on.
struct Ticks {
  double first;
  double step;
  int count;

  [[nodiscard]] double at(int i) const { return first + step * i; }
  [[nodiscard]] double last() const { return at(count - 1); }
  /// As many decimals as the step has.
  [[nodiscard]] std::string label(int i) const;
};

/// Ticks of 1, 2 or 5 times a power of ten that reach from below `low` to above `high` in at most
/// `intervals` steps, as few as that allows. Where both are the same: from there to one above.
/// @pre low <= high, both finite; intervals >= 2
[[nodiscard]] Ticks nice_ticks(double low, double high, int intervals);

/// The y scale that holds all values and zero.
class ValueRange {
 public:
  void include(std::span<const double> values);
  [[nodiscard]] Ticks ticks(int intervals) const { return nice_ticks(low_, high_, intervals); }

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
  Plot(Svg& svg, const Box& frame, double x_max, const Ticks& y);

  /// Above the top left corner.
  void caption(std::string_view what);
  void x_marks(std::span<const Mark> marks);
  /// Upright lines of the grid, evenly over the x axis, both ends included.
  void x_rules(int parts);
  /// One value for each of equal parts of the x axis, drawn at their middles.
  void curve(std::span<const double> values, const Stroke& stroke);
  /// One value a part of the x axis, in the `place`-th of `places` columns of it.
  void bars(std::span<const double> values, std::string_view colour, std::size_t place,
            std::size_t places);
  /// The line of zero over all that was drawn, for curves and bars that hang from it.
  void zero_line();

 private:
  [[nodiscard]] double x_px(double x) const;
  [[nodiscard]] double y_px(double y) const;

  Svg& svg_;
  Box frame_;
  double x_max_;
  Ticks y_;
};

}  // namespace recald::simulators
