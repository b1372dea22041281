#include "adapters/views/frame/figure_data.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "adapters/views/frame/first_screen.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/histogram.hpp"
#include "adapters/views/frame/script_json.hpp"
#include "core/display/unit.hpp"

namespace recald::views {
namespace {

using nlohmann::json;

json number(double value) { return json_number(value); }

/// Corners of the prior's density, [value, density] each, over all but 0.1 % of an endless tail.
json curve(const Prior& prior, const display::Unit& unit) {
  json corners = json::array();
  const auto corner = [&](double value, double density) {
    corners.push_back(json_numbers(std::array{unit.shown(value), density / unit.factor}));
  };
  if (const auto* triangle = std::get_if<TriangularPrior>(&prior.distribution())) {
    corner(triangle->min, 0.0);
    corner(triangle->mode, 2.0 / (triangle->max - triangle->min));
    corner(triangle->max, 0.0);
    return corners;
  }
  constexpr int steps = 60;
  const double low = std::max(prior.min(), prior.quantile(0.001));
  const double high = std::min(prior.max(), prior.quantile(0.999));
  corner(low, 0.0);
  for (int i = 0; i <= steps; ++i) {
    const double value = low + (high - low) * i / steps;
    corner(value, prior.density(value));
  }
  corner(high, 0.0);
  return corners;
}

json parameter_json(const ParameterResult& parameter, const display::Unit& unit) {
  const Histogram histogram = make_histogram(parameter.draws, kPosteriorBins);
  std::vector<double> density = histogram.density();
  for (double& value : density) value /= unit.factor;
  const calibration::Summary& summary = parameter.summary;
  return {{"label", parameter.label},
          {"unit", unit.name},
          {"prior", curve(parameter.prior, unit)},
          {"binStart", number(unit.shown(histogram.start))},
          {"binWidth", number(unit.shown_difference(histogram.width))},
          {"density", json_numbers(density)},
          {"mean", number(unit.shown(summary.mean))},
          {"q05", number(unit.shown(summary.q05))},
          {"q95", number(unit.shown(summary.q95))}};
}

json shown_numbers(std::array<double, 5> values, const display::Unit& unit) {
  for (double& value : values) value = unit.shown(value);
  return json_numbers(values);
}

json box_json(const std::optional<assessment::BoxPlot>& box, const display::Unit& unit) {
  if (!box) return nullptr;
  return shown_numbers({box->low_whisker, box->q25, box->q50, box->q75, box->high_whisker}, unit);
}

json forecast_json(const std::optional<assessment::MonthForecast>& forecast,
                   const display::Unit& unit) {
  if (!forecast) return nullptr;
  return shown_numbers({forecast->q05, forecast->q25, forecast->q50, forecast->q75, forecast->q95},
                       unit);
}

json month_json(const OutputResult& output, const OutputMonth& month) {
  const display::Unit& unit = output.unit();
  return {{"month", month_key(month.figure.month, month.number)},
          {"role", name_of(month.role)},
          {"measured", number(unit.shown(measured_of(output, month)))},
          {"usable", month.figure.usable},
          {"filled", json_number(month.figure.filled_share, 4)},
          {"different", month.flagged_different},
          {"box", box_json(month.box, unit)},
          {"forecast", forecast_json(month.forecast, unit)}};
}

json metric_histogram_json(const std::vector<double>& values) {
  const Histogram histogram = make_histogram(values, kMetricBins);
  return {{"start", number(histogram.start)},
          {"width", number(histogram.width)},
          {"counts", histogram.counts}};
}

json output_json(const OutputResult& output) {
  json months = json::array();
  for (const OutputMonth& month : output.months) months.push_back(month_json(output, month));
  const assessment::OutputAssessment fit =
      output.assessment.value_or(assessment::OutputAssessment{});
  return {{"label", output.label},
          {"unit", output.unit().name},
          {"months", months},
          {"cvrmse",
           {{"calibration", metric_histogram_json(fit.draw_cvrmse_calibration)},
            {"validation", metric_histogram_json(fit.draw_cvrmse_validation)}}}};
}

json peaks_json(const ReportData& data) {
  json peaks = json::array();
  for (const PeakSeries& series : data.peaks) {
    json months = json::array();
    for (const metering::MonthlyFigure& figure : series.months) {
      const auto& peak = figure.peak;
      months.push_back({{"month", month_key(figure.month)},
                        {"peak", peak ? number(series.units.power.shown(peak->kW)) : json(nullptr)},
                        {"start", peak ? local_text(peak->start, data.calendar) : ""},
                        {"exceedable", peak && peak->could_be_exceeded}});
    }
    peaks.push_back(
        {{"label", series.meter}, {"unit", series.units.power.name}, {"months", months}});
  }
  return peaks;
}

json day_type_json(const DayTypeProfile& day_type) {
  json parts = json::array();
  for (const ProfilePart& part : day_type.parts) {
    parts.push_back({{"label", part.label}, {"kW", json_numbers(part.mean_kW)}});
  }
  return {{"label", day_type.label},
          {"parts", parts},
          {"measured", json_numbers(day_type.measured_mean_kW)}};
}

/// One letter per hour: o(k), p(artly filled), m(issing), s(uspect).
char status_letter(HourStatus status) {
  switch (status) {
    case HourStatus::ok:
      return 'o';
    case HourStatus::partly_filled:
      return 'p';
    case HourStatus::missing:
      return 'm';
    case HourStatus::suspect:
      return 's';
  }
  return 'm';
}

json load_json(const LoadGrid& load) {
  json values = json::array();
  for (const float value : load.mean_kW) values.push_back(json_number(value, 4));
  std::string letters;
  for (const HourStatus status : load.status) letters += status_letter(status);
  const display::Unit& power = load.units.power;
  return {{"label", load.meter},
          {"unit", power.name},
          {"unitsPerKW", json_number(power.factor, 9)},
          {"firstDay", day_key(load.first_day)},
          {"kW", std::move(values)},
          {"status", letters}};
}

template <class Item>
json array_of(const std::vector<Item>& items, json (*convert)(const Item&)) {
  json array = json::array();
  for (const Item& item : items) array.push_back(convert(item));
  return array;
}

}  // namespace

nlohmann::json report_json(const ReportData& data) {
  json parameters = json::array();
  for (const ParameterResult& parameter : data.parameters) {
    parameters.push_back(
        parameter_json(parameter, display::unit_of(data.units, parameter.summary.unit)));
  }
  return {{"parameters", parameters},
          {"overview", overview_json(model_overview(data))},
          {"outputs", array_of(data.outputs, output_json)},
          {"peaks", peaks_json(data)},
          {"dayTypes", array_of(data.profile.day_types, day_type_json)},
          {"loads", array_of(data.loads, load_json)}};
}

std::string figure_json(const ReportData& data) { return script_safe_text(report_json(data)); }

}  // namespace recald::views
