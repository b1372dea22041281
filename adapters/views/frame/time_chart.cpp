#include "adapters/views/frame/time_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/views/frame/format.hpp"

namespace recald::views {
namespace {

using metering::Day;
using metering::Instant;
using std::chrono::hours;
using std::chrono::sys_days;

constexpr int kHeight_px = 200;
constexpr int kFoot_px = 22;  // Below the plot, for times.
constexpr int kPlot_px = kHeight_px - kFoot_px;
// Of the plot's own coordinates, in which it is stretched to its place.
constexpr double kWide = 2000.0;
constexpr double kHigh = 1000.0;
constexpr std::size_t kTicksMax = 7;

class Scale {
 public:
  Scale(const TimeChart& chart, const std::vector<double>& ticks)
      : span_(chart.span), least_(ticks.front()), most_(ticks.back()) {}

  /// 0…1 from the left.
  [[nodiscard]] double share(Instant t) const {
    const auto all = static_cast<double>((span_.end - span_.begin).count());
    return all > 0.0 ? std::clamp(static_cast<double>((t - span_.begin).count()) / all, 0.0, 1.0)
                     : 0.0;
  }
  /// 0…1 from the top.
  [[nodiscard]] double share(double value) const { return (most_ - value) / (most_ - least_); }

  [[nodiscard]] int x(Instant t) const { return static_cast<int>(std::lround(kWide * share(t))); }
  [[nodiscard]] int y(double value) const {
    return static_cast<int>(std::lround(kHigh * share(value)));
  }

 private:
  metering::TimeSpan span_;
  double least_;
  double most_;
};

/// Runs of points without a gap between them.
std::vector<std::pair<std::size_t, std::size_t>> runs_of(const TimeChart& chart) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t i = 0; i < chart.points.size(); ++i) {
    if (!std::isfinite(chart.points[i].mean)) continue;
    const bool goes_on = i > 0 && std::isfinite(chart.points[i - 1].mean) &&
                         chart.points[i].start == chart.points[i - 1].end;
    if (goes_on) {
      runs.back().second = i + 1;
    } else {
      runs.emplace_back(i, i + 1);
    }
  }
  return runs;
}

std::string line_path(const TimeChart& chart, const Scale& scale) {
  std::string path;
  for (const auto& [first, last] : runs_of(chart)) {
    for (std::size_t i = first; i < last; ++i) {
      const ChartPoint& p = chart.points[i];
      const int y = scale.y(p.mean);
      path += i == first ? fmt::format("M{} {}", scale.x(p.start), y) : fmt::format("V{}", y);
      path += fmt::format("H{}", scale.x(p.end));
    }
  }
  return path;
}

std::string band_path(const TimeChart& chart, const Scale& scale) {
  const bool has_band = std::ranges::any_of(
      chart.points, [](const ChartPoint& p) { return p.low < p.mean || p.mean < p.high; });
  std::string path;
  if (!has_band) return path;
  for (const auto& [first, last] : runs_of(chart)) {
    for (std::size_t i = first; i < last; ++i) {
      const ChartPoint& p = chart.points[i];
      const int y = scale.y(p.high);
      path += i == first ? fmt::format("M{} {}", scale.x(p.start), y) : fmt::format("V{}", y);
      path += fmt::format("H{}", scale.x(p.end));
    }
    for (std::size_t i = last; i-- > first;) {
      const ChartPoint& p = chart.points[i];
      path += fmt::format("V{}H{}", scale.y(p.low), scale.x(p.start));
    }
    path += 'Z';
  }
  return path;
}

std::string mark_path(const TimeChart& chart, const Scale& scale) {
  std::string path;
  for (const ChartMark& mark : chart.marks) {
    if (!std::isfinite(mark.value)) continue;
    path += fmt::format("M{} {}H{}", scale.x(mark.span.begin), scale.y(mark.value),
                        scale.x(mark.span.end));
  }
  return path;
}

std::string value_label(double value) {
  constexpr double kWithoutThousands = 1e4;
  return std::abs(value) < kWithoutThousands ? fmt::format("{:g}", value) : count_text(value);
}

void write_axes(Html& html, const TimeChart& chart, const Scale& scale,
                const std::vector<double>& ticks, const metering::LocalCalendar& calendar) {
  for (const double tick : ticks) {
    const double y = 0.5 + std::round(scale.share(tick) * (kPlot_px - 1));
    html.markup(
        fmt::format(R"(<line class="chart-grid" x1="0" x2="100%" y1="{0:.1f}" y2="{0:.1f}"/>)", y));
    // Above its line, but for the highest, which would be cut.
    const double text_y = tick == ticks.back() ? y + 13.0 : y - 3.0;
    const std::string unit = tick == ticks.back() ? "\u00a0" + chart.unit : "";
    html.markup(fmt::format(R"(<text x="2" y="{:.1f}">)", text_y))
        .text(value_label(tick) + unit)
        .markup("</text>");
  }
  for (const TimeTick& tick : time_ticks(chart.span, calendar)) {
    const double x = 100.0 * scale.share(tick.at);
    const char* anchor = x < 5.0 ? "start" : x > 95.0 ? "end" : "middle";
    html.markup(
        fmt::format(R"(<line class="chart-grid" x1="{0:.2f}%" x2="{0:.2f}%" y1="0" y2="{1}"/>)"
                    R"(<text x="{0:.2f}%" y="{2}" text-anchor="{3}">)",
                    x, kPlot_px, kHeight_px - 6, anchor));
    html.text(tick.label).markup("</text>");
  }
}

std::string hour_label(const metering::LocalTime& local) {
  return fmt::format("{:02}:{:02}", local.minute_of_day / 60, local.minute_of_day % 60);
}

std::string day_label(Day day) {
  return fmt::format("{} {}", static_cast<unsigned>(day.day()),
                     month_name(static_cast<unsigned>(day.month())));
}

std::vector<TimeTick> hour_ticks(const metering::TimeSpan& span,
                                 const metering::LocalCalendar& calendar, int every_h) {
  std::vector<TimeTick> ticks;
  const Day last = calendar.local_time(span.end).date;
  for (Day day = calendar.local_time(span.begin).date; sys_days{day} <= sys_days{last};
       day = Day{sys_days{day} + std::chrono::days{1}}) {
    for (int hour = 0; hour < 24; hour += every_h) {
      const Instant at = calendar.first_instant(day, 60 * hour);
      if (at < span.begin || at >= span.end) continue;
      ticks.push_back({at, hour == 0 ? day_label(day) : hour_label(calendar.local_time(at))});
    }
  }
  return ticks;
}

std::vector<TimeTick> day_ticks(const metering::TimeSpan& span,
                                const metering::LocalCalendar& calendar, int every) {
  std::vector<TimeTick> ticks;
  Day day = calendar.local_time(span.begin).date;
  if (calendar.day_span(day).begin < span.begin) day = Day{sys_days{day} + std::chrono::days{1}};
  for (; calendar.day_span(day).begin < span.end;
       day = Day{sys_days{day} + std::chrono::days{every}}) {
    ticks.push_back({calendar.day_span(day).begin, day_label(day)});
  }
  return ticks;
}

std::vector<TimeTick> month_ticks(const metering::TimeSpan& span,
                                  const metering::LocalCalendar& calendar, unsigned every) {
  std::vector<TimeTick> ticks;
  for (metering::Month month = calendar.month_of(span.begin);
       calendar.month_span(month).begin < span.end; month = metering::next_month(month)) {
    const Instant at = calendar.month_span(month).begin;
    const unsigned number = static_cast<unsigned>(month.month()) - 1;
    if (at < span.begin || number % every != 0) continue;
    ticks.push_back(
        {at, every == 12 ? std::to_string(static_cast<int>(month.year())) : month_text(month)});
  }
  return ticks;
}

}  // namespace

std::vector<double> value_ticks(double least, double most) {
  const double low = std::min(least, 0.0);
  const double high = most > low ? most : low + 1.0;
  constexpr double kWanted = 4.0;
  const double rough = (high - low) / kWanted;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double round : {1.0, 2.0, 5.0}) {
    if (round * power >= rough) {
      step = round * power;
      break;
    }
  }
  std::vector<double> ticks;
  for (double tick = std::floor(low / step); tick < high / step + 1.0 - 1e-9; tick += 1.0) {
    ticks.push_back(tick * step);
  }
  return ticks;
}

std::vector<TimeTick> time_ticks(const metering::TimeSpan& span,
                                 const metering::LocalCalendar& calendar) {
  const auto length = span.end - span.begin;
  std::vector<TimeTick> ticks;
  const auto fits = [&](std::vector<TimeTick> tried) {
    ticks = std::move(tried);
    return ticks.size() <= kTicksMax;
  };
  for (const int every_h : {1, 3, 6, 12}) {
    if (length <= hours{every_h} * static_cast<int>(kTicksMax) &&
        fits(hour_ticks(span, calendar, every_h))) {
      return ticks;
    }
  }
  for (const int every : {1, 2, 7, 14}) {
    if (length <= hours{24 * every} * static_cast<int>(kTicksMax) &&
        fits(day_ticks(span, calendar, every))) {
      return ticks;
    }
  }
  for (const unsigned every : {1U, 3U, 6U}) {
    if (fits(month_ticks(span, calendar, every))) return ticks;
  }
  ticks = month_ticks(span, calendar, 12);
  while (ticks.size() > kTicksMax) {  // every second year, fourth, …
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      ticks.erase(ticks.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return ticks;
}

void write_chart(Html& html, const TimeChart& chart, const metering::LocalCalendar& calendar) {
  double least = 0.0;
  double most = 0.0;
  for (const ChartPoint& point : chart.points) {
    if (!std::isfinite(point.mean)) continue;
    least = std::min(least, point.low);
    most = std::max(most, point.high);
  }
  for (const ChartMark& mark : chart.marks) {
    if (!std::isfinite(mark.value)) continue;
    least = std::min(least, mark.value);
    most = std::max(most, mark.value);
  }
  const std::vector<double> ticks = value_ticks(least, most);
  const Scale scale{chart, ticks};
  html.markup(
      fmt::format(R"(<svg class="chart" role="img" width="100%" height="{}">)", kHeight_px));
  html.element("title", chart.title);
  html.markup(
      fmt::format(R"(<svg x="0" y="0" width="100%" height="{}" viewBox="0 0 {:.0f} {:.0f}" )"
                  R"(preserveAspectRatio="none"><path class="chart-band" d="{}"/>)"
                  R"(<path class="chart-line" d="{}"/><path class="chart-mark" d="{}"/></svg>)",
                  kPlot_px, kWide, kHigh, band_path(chart, scale), line_path(chart, scale),
                  mark_path(chart, scale)));
  write_axes(html, chart, scale, ticks, calendar);
  html.markup("</svg>");
}

}  // namespace recald::views
