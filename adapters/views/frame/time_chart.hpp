/// A meter's values over time, drawn as SVG without any script: the first view of a page.
#pragma once

#include <string>
#include <vector>

#include "adapters/views/frame/html.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::views {

/// What a chart shows of a piece of time.
struct ChartPoint {
  metering::Instant start;
  double low;   ///< NaN in all three: nothing is known, and the line has a gap.
  double mean;  ///< The line.
  double high;  ///< With `low` the band around it.
  metering::Instant end;
};

/// A short thick line over the others.
struct ChartMark {
  metering::TimeSpan span;
  double value;
};

struct TimeChart {
  std::string title;  ///< For readers who cannot see it.
  std::string unit;   ///< "kW"
  metering::TimeSpan span;
  std::vector<ChartPoint> points;  ///< In order of time, within the span.
  std::vector<ChartMark> marks = {};
};

/// An <svg class="chart">; as wide as its place, with text of the page's size at any width. Colours
/// are the style sheet's (`chart-line`, `chart-band`, `chart-mark`, `chart-grid`).
void write_chart(Html& html, const TimeChart& chart, const metering::LocalCalendar& calendar);

/// Where an axis from zero (or `least`, if that is below) to `most` has its lines: three to six
/// round numbers.
[[nodiscard]] std::vector<double> value_ticks(double least, double most);

/// A line of the time axis, and what is written there.
struct TimeTick {
  metering::Instant at;
  std::string label;
};

/// Two to seven round local times within the span, if it has so many: hours, days, months or years.
[[nodiscard]] std::vector<TimeTick> time_ticks(const metering::TimeSpan& span,
                                               const metering::LocalCalendar& calendar);

}  // namespace recald::views
