#include "simulators/footprint/effect_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "simulators/footprint/meter_key.hpp"
#include "simulators/footprint/plot.hpp"

namespace recald::simulators {
namespace {

constexpr double kWidth = 900.0;
constexpr double kMargin = 22.0;
constexpr double kPlotHeight = 170.0;
constexpr int kIntervals = 6;  ///< Of a scale, at most.

/// A meter with less than this is called unchanged: no building's meter resolves a watt.
constexpr double kNothing_kW = 0.001;

bool changed(const MeterFootprint& meter) {
  return std::ranges::any_of(meter.added_kW,
                             [](double added) { return std::abs(added) > kNothing_kW; });
}

IntervalSeries added(const Footprint& footprint, const MeterFootprint& meter) {
  return {footprint.begin, meter.added_kW};
}

/// The mean days of one diagram.
struct DayCurve {
  Utility utility;
  PartOfWeek part_of_week;
  MeanDay mean_kW;
};

std::vector<DayCurve> day_curves(const Footprint& footprint, HalfYear half_year,
                                 const metering::LocalCalendar& calendar) {
  std::vector<DayCurve> curves;
  for (const MeterFootprint& meter : footprint.meters) {
    if (!changed(meter)) continue;
    for (const PartOfWeek part : {PartOfWeek::weekend, PartOfWeek::working_days}) {
      const DayGroup group{half_year, part, footprint.effect.from, footprint.effect.to};
      const auto mean_kW = mean_day(added(footprint, meter), group, calendar);
      if (mean_kW) curves.push_back({meter.utility, part, *mean_kW});
    }
  }
  return curves;
}

/// In % of the meter's mean month, so that the mean of the bars is its share of the year.
MonthlySum monthly_percent(const Footprint& footprint, const MeterFootprint& meter,
                           const metering::LocalCalendar& calendar) {
  const MonthlySum plain_kWh = monthly_kWh({footprint.begin, meter.plain_kW}, calendar);
  const double mean_kWh = std::accumulate(plain_kWh.begin(), plain_kWh.end(), 0.0) / 12.0;
  MonthlySum percent = monthly_kWh(added(footprint, meter), calendar);
  for (double& month : percent) month = mean_kWh > 0.0 ? 100.0 * month / mean_kWh : 0.0;
  return percent;
}

void draw_day(Svg& svg, const Box& frame, const Scale& scale, std::string_view caption,
              const std::vector<DayCurve>& curves) {
  Plot plot(svg, frame, 24.0, scale);
  plot.caption(caption);
  const std::vector<Mark> hours{{0, "0 h"}, {6, "6"}, {12, "12"}, {18, "18"}, {24, "24"}};
  plot.x_marks(hours);
  plot.x_rules(4);
  plot.zero_line();
  for (const DayCurve& curve : curves) {
    plot.curve(curve.mean_kW, {.colour = colour_of(curve.utility),
                               .width = 1.8,
                               .dashed = curve.part_of_week == PartOfWeek::weekend});
  }
}

/// Draws both half-years to one scale.
void draw_days(Svg& svg, double top, const Footprint& footprint,
               const metering::LocalCalendar& calendar) {
  const auto winter = day_curves(footprint, HalfYear::winter, calendar);
  const auto summer = day_curves(footprint, HalfYear::summer, calendar);
  ValueRange range;
  for (const DayCurve& curve : winter) range.include(curve.mean_kW);
  for (const DayCurve& curve : summer) range.include(curve.mean_kW);
  const Scale scale = range.scale(kIntervals);
  const Box left{66.0, top, 222.0, kPlotHeight};
  const Box right{336.0, top, 222.0, kPlotHeight};
  draw_day(svg, left, scale, "Mean day, October to March, kW", winter);
  draw_day(svg, right, scale, "April to September, kW", summer);
}

void draw_months(Svg& svg, double top, const Footprint& footprint,
                 const metering::LocalCalendar& calendar) {
  std::vector<std::pair<Utility, MonthlySum>> shown;
  ValueRange range;
  for (const MeterFootprint& meter : footprint.meters) {
    if (!changed(meter)) continue;
    shown.emplace_back(meter.utility, monthly_percent(footprint, meter, calendar));
    range.include(shown.back().second);
  }
  range.widen_to(1.0);
  const Box frame{612.0, top, 266.0, kPlotHeight};
  Plot plot(svg, frame, 12.0, range.scale(kIntervals));
  plot.caption("By month, % of a mean month");
  std::vector<Mark> months;
  for (const char initial : std::string_view("JFMAMJJASOND")) {
    months.push_back({static_cast<double>(months.size()) + 0.5, std::string(1, initial)});
  }
  plot.x_marks(months);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    plot.bars(shown[i].second, colour_of(shown[i].first), i, shown.size());
  }
  plot.zero_line();
}

/// Means of what one meter adds, by outdoor temperature; a temperature that hardly ever occurred
/// has the mean of the nearest cooler one.
struct TemperatureCurve {
  Utility utility;
  std::vector<double> mean_kW;
};

struct TemperatureAxis {
  static constexpr double kStep_K = 2.5;
  double low_C;
  std::size_t bins;

  [[nodiscard]] std::size_t bin_of(double outdoor_C) const {
    return std::min(static_cast<std::size_t>((outdoor_C - low_C) / kStep_K), bins - 1);
  }
};

TemperatureAxis axis_of(const std::vector<double>& outdoor_C) {
  const auto [low, high] = std::ranges::minmax_element(outdoor_C);
  const double low_C = TemperatureAxis::kStep_K * std::floor(*low / TemperatureAxis::kStep_K);
  const double bins = std::ceil((*high - low_C) / TemperatureAxis::kStep_K);
  return {low_C, std::max<std::size_t>(static_cast<std::size_t>(bins), 1)};
}

bool in_working_hours(const metering::LocalTime& local) {
  constexpr int kFirst_min = 8 * 60;
  constexpr int kLast_min = 18 * 60;
  const unsigned weekday = std::chrono::weekday{std::chrono::sys_days{local.date}}.iso_encoding();
  return weekday <= 5 && local.minute_of_day >= kFirst_min && local.minute_of_day < kLast_min;
}

std::vector<TemperatureCurve> temperature_curves(const Footprint& footprint,
                                                 const TemperatureAxis& axis, bool working,
                                                 const metering::LocalCalendar& calendar) {
  std::vector<TemperatureCurve> curves;
  for (const MeterFootprint& meter : footprint.meters) {
    if (!changed(meter)) continue;
    std::vector<double> sum_kW(axis.bins, 0.0);
    std::vector<double> count(axis.bins, 0.0);
    for (std::size_t i = 0; i < meter.added_kW.size(); ++i) {
      const auto local = calendar.local_time(footprint.begin + i * kInterval);
      const bool is_before = footprint.effect.from && local.date < *footprint.effect.from;
      const bool is_after = footprint.effect.to && local.date > *footprint.effect.to;
      if (is_before || is_after || in_working_hours(local) != working) continue;
      const std::size_t bin = axis.bin_of(footprint.outdoor_C[i]);
      sum_kW[bin] += meter.added_kW[i];
      count[bin] += 1.0;
    }
    constexpr double kFewest = 8.0;  // Two hours.
    const auto is_known = [](double quarters) { return quarters >= kFewest; };
    std::size_t nearest =
        static_cast<std::size_t>(std::ranges::find_if(count, is_known) - count.begin());
    if (nearest == axis.bins) continue;
    std::vector<double> mean_kW(axis.bins);
    for (std::size_t bin = 0; bin < axis.bins; ++bin) {
      if (is_known(count[bin])) nearest = bin;
      mean_kW[bin] = sum_kW[nearest] / count[nearest];
    }
    curves.push_back({meter.utility, std::move(mean_kW)});
  }
  return curves;
}

void draw_temperatures(Svg& svg, double top, const Footprint& footprint,
                       const metering::LocalCalendar& calendar) {
  const TemperatureAxis axis = axis_of(footprint.outdoor_C);
  std::array<std::vector<TemperatureCurve>, 2> halves;
  ValueRange range;
  for (const bool working : {true, false}) {
    halves[working ? 0 : 1] = temperature_curves(footprint, axis, working, calendar);
    for (const TemperatureCurve& curve : halves[working ? 0 : 1]) range.include(curve.mean_kW);
  }
  const Scale scale = range.scale(kIntervals);
  const std::array<std::string_view, 2> captions{
      "By outdoor temperature, Monday to Friday 8 to 18 h, kW",
      "By outdoor temperature, other hours"};
  const std::array<Box, 2> frames{Box{66.0, top, 366.0, kPlotHeight},
                                  Box{502.0, top, 376.0, kPlotHeight}};
  std::vector<Mark> marks;
  for (std::size_t bin = 0; bin <= axis.bins; bin += axis.bins > 16 ? 4 : 2) {
    const double edge_C = axis.low_C + TemperatureAxis::kStep_K * static_cast<double>(bin);
    marks.push_back({static_cast<double>(bin), fmt::format("{:g}", edge_C)});
  }
  marks.back().text += " °C";
  for (std::size_t half = 0; half < halves.size(); ++half) {
    Plot plot(svg, frames[half], static_cast<double>(axis.bins), scale);
    plot.caption(captions[half]);
    plot.x_marks(marks);
    plot.zero_line();
    for (const TemperatureCurve& curve : halves[half]) {
      plot.curve(curve.mean_kW, {.colour = colour_of(curve.utility), .width = 1.8});
    }
  }
}

/// Below the diagrams: how to read the curves, and which building is shown.
void draw_foot(Svg& svg, double y, const Footprint& footprint) {
  constexpr TextStyle style{.size = 11.0, .colour = kFaintInk};
  constexpr Stroke sample{.colour = kFaintInk, .width = 1.8};
  Stroke dashed = sample;
  dashed.dashed = true;
  svg.line({66.0, y - 4.0}, {90.0, y - 4.0}, sample);
  svg.text({96.0, y}, "Monday to Friday", style);
  svg.line({212.0, y - 4.0}, {236.0, y - 4.0}, dashed);
  svg.text({242.0, y}, "Saturday and Sunday", style);
  TextStyle at_right = style;
  at_right.anchor = Anchor::end;
  svg.text({kWidth - kMargin, y}, footprint.building, at_right);
}

void draw_shares(Svg& svg, double y, const Footprint& footprint) {
  std::vector<KeyEntry> key;
  for (const MeterFootprint& meter : footprint.meters) {
    key.push_back({meter.utility, share_text(meter)});
  }
  const Point after = draw_key(svg, {kMargin, y}, key);
  svg.text(after, "of the year", {.size = 13.0, .colour = kFaintInk});
}

}  // namespace

double MeterFootprint::share() const {
  const double plain = std::accumulate(plain_kW.begin(), plain_kW.end(), 0.0);
  const double more = std::accumulate(added_kW.begin(), added_kW.end(), 0.0);
  return plain > 0.0 ? more / plain : 0.0;
}

std::string share_text(const MeterFootprint& meter) {
  if (!changed(meter)) return meter.name + " unchanged";
  const double percent = 100.0 * meter.share();
  const std::string number = signed_number(percent, std::abs(percent) < 1.0 ? 2 : 1);
  return fmt::format("{} {} %", meter.name, number == "0" ? "\u00b10" : number);
}

std::string share_text(const Footprint& footprint) {
  std::string text;
  for (const MeterFootprint& meter : footprint.meters) {
    text += (text.empty() ? "" : ", ") + share_text(meter);
  }
  return text;
}

std::string strength_text(const HiddenChoice& effect) {
  std::string text = fmt::format("Strength {}{:.3g}: {}", effect.strength < 0.0 ? "\u2212" : "",
                                 std::abs(effect.strength), effect.kind->strength.unit);
  if (effect.from) text += "; from " + metering::to_string(*effect.from);
  if (effect.to) text += " to " + metering::to_string(*effect.to);
  return text + '.';
}

std::string effect_figure(const Footprint& footprint, const metering::LocalCalendar& calendar) {
  const EffectKind& kind = *footprint.effect.kind;
  constexpr double text_px = kWidth - 2.0 * kMargin;
  const auto sentence = wrap_text(kind.sentence, 13.0, text_px);
  const auto details = wrap_text(strength_text(footprint.effect), 12.0, text_px);
  const double shares_y = 62.0 + 18.0 * static_cast<double>(sentence.size()) +
                          16.0 * static_cast<double>(details.size());
  const double plots_y = shares_y + 44.0;

  constexpr double kRow_px = kPlotHeight + 82.0;
  const double rows = footprint.outdoor_C.empty() ? 1.0 : 2.0;
  Svg svg(kWidth, plots_y + rows * kRow_px - 30.0,
          fmt::format("{}: {}", kind.title, share_text(footprint)));
  svg.text({kMargin, 32.0}, kind.title, {.size = 18.0, .bold = true});
  svg.text({kWidth - kMargin, 32.0}, kind.id,
           {.size = 12.0, .colour = kFaintInk, .anchor = Anchor::end});
  double y = 56.0;
  for (const std::string& line : sentence) {
    svg.text({kMargin, y}, line, {.size = 13.0});
    y += 18.0;
  }
  for (const std::string& line : details) {
    svg.text({kMargin, y}, line, {.size = 12.0, .colour = kFaintInk});
    y += 16.0;
  }
  draw_shares(svg, shares_y, footprint);
  draw_days(svg, plots_y, footprint, calendar);
  draw_months(svg, plots_y, footprint, calendar);
  draw_foot(svg, plots_y + kPlotHeight + 36.0, footprint);
  if (!footprint.outdoor_C.empty()) draw_temperatures(svg, plots_y + kRow_px, footprint, calendar);
  return svg.finished();
}

}  // namespace recald::simulators
