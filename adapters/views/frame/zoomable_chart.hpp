/// A chart that a script makes zoomable once the page is there. It is an SVG until then, and stays
/// one if no script comes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "adapters/views/frame/time_chart.hpp"

namespace recald::views {

/// Where finer values of a part of a chart are fetched from.
struct FinerValues {
  std::string address;  ///< Of the API's history, with its query: "/api/v1/history?meter=main".
  std::chrono::seconds interval;  ///< Nothing is finer.
  int points;                     ///< As many as the chart has room for.
  double factor = 1.0;            ///< To the chart's unit: value times factor plus offset.
  double offset = 0.0;
};

/// What the chart's values are called.
struct ChartWords {
  std::string line;       ///< "Mean"
  std::string band;       ///< "Lowest and highest interval"
  std::string mark = "";  ///< "Measured"
};

/// Opens the element around each zoomable chart: a page with it needs the script.
inline constexpr std::string_view kZoomableMarkup = "<div class=\"zoomable\">";

/// The SVG of `write_chart`, and beside it the same numbers for src/page_charts.js. Times there are
/// in seconds since 1970; the site's offsets from UTC come with them.
void write_zoomable_chart(Html& html, const TimeChart& chart, const ChartWords& words,
                          const std::optional<FinerValues>& finer,
                          const metering::LocalCalendar& calendar);

}  // namespace recald::views
