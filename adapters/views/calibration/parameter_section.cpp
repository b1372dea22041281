#include <fmt/format.h>

#include <cmath>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/histogram.hpp"
#include "adapters/views/frame/sections.hpp"
#include "core/display/unit.hpp"

namespace recald::views {
namespace {

display::Unit unit_of(const ReportData& data, const ParameterResult& parameter) {
  return display::unit_of(data.units, parameter.summary.unit);
}

std::string label_with_unit(const ParameterResult& parameter, const display::Unit& unit) {
  return unit.name.empty() ? parameter.label : fmt::format("{} ({})", parameter.label, unit.name);
}

Table parameter_table(const ParameterResult& parameter, const display::Unit& unit) {
  Table table(label_with_unit(parameter, unit));
  table.columns({"", "Prior", "Posterior"});
  const Prior& prior = parameter.prior;
  const calibration::Summary& posterior = parameter.summary;
  const auto row = [&table](const char* name, double before, double after) {
    table.row({{name}, {number_text(before), "number"}, {number_text(after), "number"}});
  };
  const auto value_row = [&](const char* name, double before, double after) {
    row(name, unit.shown(before), unit.shown(after));
  };
  value_row("Mean", prior.mean(), posterior.mean);
  row("Standard deviation", unit.shown_difference(std::sqrt(prior.variance())),
      unit.shown_difference(posterior.sd));
  value_row("5 %", prior.quantile(0.05), posterior.q05);
  value_row("Median", prior.quantile(0.5), posterior.q50);
  value_row("95 %", prior.quantile(0.95), posterior.q95);
  value_row("Minimum", prior.min(), NAN);
  value_row("Mode", prior.mode(), NAN);
  value_row("Maximum", prior.max(), NAN);
  const Histogram histogram = make_histogram(parameter.draws, kPosteriorBins);
  if (!histogram.counts.empty()) table.group("Probability of each bar");
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const double low = histogram.edge(i);
    const double high = histogram.edge(i + 1);
    const double of_draws = histogram.density()[i] * histogram.width;
    table.row(
        {{fmt::format("{} to {}", number_text(unit.shown(low)), number_text(unit.shown(high)))},
         {percent_text(prior.cumulative(high) - prior.cumulative(low)), "number"},
         {percent_text(of_draws), "number"}});
  }
  return table;
}

void write_parameter_figure(Html& html, const ParameterResult& parameter, const display::Unit& unit,
                            int index) {
  const calibration::Summary& posterior = parameter.summary;
  const std::string learnt = contraction_sentence(posterior.contraction);
  const std::string interval =
      fmt::format("Mean {}, 90 % interval {} to {}{}{}. ", number_text(unit.shown(posterior.mean)),
                  number_text(unit.shown(posterior.q05)), number_text(unit.shown(posterior.q95)),
                  unit.name.empty() ? "" : " ", unit.name);
  write_figure(html,
               {.kind = "parameter",
                .index = index,
                .title = label_with_unit(parameter, unit),
                .description = fmt::format("Prior and posterior of {}. {}{}", parameter.label,
                                           interval, learnt),
                .caption = interval + learnt,
                .size = "small"},
               parameter_table(parameter, unit));
}

void write_summary(Html& html, const ReportData& data) {
  Table table(
      "Posterior of each parameter. Converged: R-hat at most 1.01, effective draws at least 400");
  table.columns({"Parameter", "Name in files", "Mean", "Standard deviation", "5 %", "Median",
                 "95 %", "Contraction", "R-hat", "Effective draws (bulk)",
                 "Effective draws (tail)"});
  for (const ParameterResult& parameter : data.parameters) {
    const display::Unit unit = unit_of(data, parameter);
    // The thresholds of Vehtari et al. (2021), Bayesian Analysis 16(2).
    const auto ess_cell = [](double ess) {
      return Cell{count_text(ess) + (ess >= 400.0 ? " ✓" : " ✕"),
                  ess >= 400.0 ? "number good" : "number bad"};
    };
    const calibration::Summary& posterior = parameter.summary;
    const bool mixed = posterior.rhat <= 1.01;
    table.row({{label_with_unit(parameter, unit)},
               {posterior.name, "code"},
               {number_text(unit.shown(posterior.mean)), "number"},
               {number_text(unit.shown_difference(posterior.sd)), "number"},
               {number_text(unit.shown(posterior.q05)), "number"},
               {number_text(unit.shown(posterior.q50)), "number"},
               {number_text(unit.shown(posterior.q95)), "number"},
               {signed_percent_text(posterior.contraction), "number"},
               {number_text(posterior.rhat) + (mixed ? " ✓" : " ✕"),
                mixed ? "number good" : "number bad"},
               ess_cell(posterior.ess_bulk),
               ess_cell(posterior.ess_tail)});
  }
  table.write(html);
}

constexpr std::string_view kParameterKey =
    "<p class=\"key\" aria-hidden=\"true\">"
    "<span><i class=\"sign dashed\"></i>prior: before any data</span>"
    "<span><i class=\"sign box\"></i>posterior: after the data</span>"
    "<span><i class=\"sign line\"></i>posterior mean</span>"
    "<span><i class=\"sign bracket\"></i>90 % interval</span></p>\n";

}  // namespace

void write_parameter_section(Html& html, const ReportData& data) {
  if (data.parameters.empty()) return;
  open_section(html, "parameters", "What did the data teach about the building?");
  html.element("p",
               "Each figure sets what was believed before (dashed) against what is believed after "
               "the data (bars). A calibrated value is the one with which this model repeats the "
               "meters best; it is not a measurement of the building.");
  html.markup(kParameterKey).markup("<div class=\"multiples\">\n");
  for (std::size_t i = 0; i < data.parameters.size(); ++i) {
    write_parameter_figure(html, data.parameters[i], unit_of(data, data.parameters[i]),
                           static_cast<int>(i));
  }
  html.markup("</div>\n");
  html.element("h3", "The parameters in numbers");
  write_summary(html, data);
  html.markup("</section>\n");
}

}  // namespace recald::views
