/// The parts of the page, in the order of the reader's questions. Each writes words and tables and
/// marks the places where the script draws. A part without data is left out.
#pragma once

#include "adapters/views/frame/html.hpp"
#include "adapters/views/frame/report_data.hpp"

namespace recald::views {

/// The answer first: headlines, Guideline 14 by output, notices.
void write_verdict_section(Html& html, const ReportData& data);

/// The notices, most serious first; nothing if there are none.
void write_notices(Html& html, const std::vector<Notice>& notices);

/// Are the data good? Coverage by month and meter, and what the readings showed.
void write_data_section(Html& html, const ReportData& data);

/// Whether at least one month has a model's box beside its measurement.
[[nodiscard]] bool has_model(const ReportData& data);

/// Does the model match the meters? Metrics, monthly box plots, CV(RMSE) of the draws.
void write_fit_section(Html& html, const ReportData& data);

/// What do the data tell about the building? Priors and posteriors.
void write_parameter_section(Html& html, const ReportData& data);

/// A figure of peaks for each meter, with a legend.
void write_peak_figures(Html& html, const ReportData& data);
void write_peak_section(Html& html, const ReportData& data);
void write_profile_section(Html& html, const ReportData& data);
void write_load_section(Html& html, const ReportData& data);

/// What each meter's years and months cost and emitted.
void write_cost_section(Html& html, const ReportData& data);
/// What the forecast months cost and emit, with a band.
void write_forecast_cost_section(Html& html, const ReportData& data);

/// The site's models beside each other: fit before and after, forecasts, parameters.
void write_comparison_section(Html& html, const ReportData& data);

void write_not_known_section(Html& html, const ReportData& data);

/// What is needed to reproduce the numbers, and the licences of the drawing software.
void write_provenance(Html& html, const Provenance& from, const std::string& time_zone,
                      const std::string& generated_at);
void write_provenance_section(Html& html, const ReportData& data);

}  // namespace recald::views
