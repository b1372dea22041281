#include "simulators/footprint/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr TextStyle kSmall{.size = 11.0, .colour = kFaintInk};

/// A quotient this close to a whole number counts as whole: 0.3 / 0.1 is 2.9999999999999996.
constexpr double kRounding = 1e-9;

/// Multiples of the step from `low` to `high`.
Ticks ticks_of(double low, double high, double step) {
  const double first = std::ceil(low / step - kRounding);
  const double last = std::floor(high / step + kRounding);
  return {first * step, step, static_cast<int>(last - first) + 1};
}

}  // namespace

std::string Ticks::label(int i) const {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + kRounding)));
  const double value = at(i);
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  return value < -0.5 * step ? "\u2212" + digits : digits;
}

Ticks nice_ticks(double low, double high, int intervals) {
  assert(low < high && std::isfinite(high - low) && intervals >= 4);
  // No finer step is possible: half of this makes twice as many intervals.
  double power = std::pow(10.0, std::floor(std::log10((high - low) / intervals)));
  for (;; power *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const Ticks ticks = ticks_of(low, high, factor * power);
      if (ticks.count - 1 <= intervals) return ticks;
    }
  }
}

void ValueRange::include(std::span<const double> values) {
  for (const double value : values) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
}

void ValueRange::widen_to(double span_min) {
  if (high_ - low_ >= span_min) return;
  low_ = std::min(low_, -0.5 * span_min);
  high_ = std::max(high_, 0.5 * span_min);
}

Scale ValueRange::scale(int intervals) const {
  if (low_ == high_) return {0.0, 1.0, nice_ticks(0.0, 1.0, intervals)};
  const double air = 0.04 * (high_ - low_);
  const double low = low_ < 0.0 ? low_ - air : 0.0;
  const double high = high_ > 0.0 ? high_ + air : 0.0;
  return {low, high, nice_ticks(low, high, intervals)};
}

Plot::Plot(Svg& svg, const Box& frame, double x_max, const Scale& y)
    : svg_(svg), frame_(frame), x_max_(x_max), y_(y) {
  assert(x_max > 0.0 && y.low < y.high);
  TextStyle label = kSmall;
  label.anchor = Anchor::end;
  std::vector<Segment> grid;
  for (int i = 0; i < y_.ticks.count; ++i) {
    const double at_px = y_px(y_.ticks.at(i));
    grid.push_back({{frame_.left, at_px}, {frame_.right(), at_px}});
    svg_.text({frame_.left - 6.0, at_px + 4.0}, y_.ticks.label(i), label);
  }
  svg_.lines(grid, {.colour = kGridInk});
}

void Plot::caption(std::string_view what) {
  svg_.text({frame_.left, frame_.top - 10.0}, what, {.size = 12.0, .bold = true});
}

void Plot::x_marks(std::span<const Mark> marks) {
  TextStyle label = kSmall;
  label.anchor = Anchor::middle;
  for (const Mark& mark : marks) {
    svg_.text({x_px(mark.at), frame_.bottom() + 16.0}, mark.text, label);
  }
}

void Plot::x_rules(int parts) {
  std::vector<Segment> rules;
  for (int i = 0; i <= parts; ++i) {
    const double at_px = x_px(x_max_ * i / parts);
    rules.push_back({{at_px, frame_.top}, {at_px, frame_.bottom()}});
  }
  svg_.lines(rules, {.colour = kGridInk});
}

void Plot::curve(std::span<const double> values, const Stroke& stroke) {
  const double part = x_max_ / static_cast<double>(values.size());
  std::vector<Point> points;
  points.reserve(values.size());
  for (const double value : values) {
    const double middle = part * (static_cast<double>(points.size()) + 0.5);
    points.push_back({x_px(middle), y_px(value)});
  }
  svg_.curve(points, stroke);
}

void Plot::bars(std::span<const double> values, std::string_view colour, std::size_t place,
                std::size_t places) {
  const double part_px = frame_.width / static_cast<double>(values.size());
  const double bar_px = 0.8 * part_px / static_cast<double>(places);
  const double inset_px = 0.1 * part_px + bar_px * static_cast<double>(place);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double top_px = y_px(std::max(0.0, values[i]));
    const double bottom_px = y_px(std::min(0.0, values[i]));
    if (bottom_px - top_px < 0.05) continue;
    boxes.push_back({frame_.left + part_px * static_cast<double>(i) + inset_px, top_px, bar_px,
                     bottom_px - top_px});
  }
  svg_.boxes(boxes, colour);
}

void Plot::zero_line() {
  svg_.line({frame_.left, y_px(0.0)}, {frame_.right(), y_px(0.0)}, {.colour = kFaintInk});
}

double Plot::x_px(double x) const { return frame_.left + frame_.width * x / x_max_; }

double Plot::y_px(double y) const {
  return frame_.bottom() - frame_.height * (y - y_.low) / (y_.high - y_.low);
}

}  // namespace recald::simulators
