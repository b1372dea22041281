/// The parts of the page, in the order of the reader's questions. Each writes words and tables, and
/// marks the places where the script draws; each leaves itself out where its data are absent.
#pragma once

#include "adapters/report/html.hpp"
#include "adapters/report/report_data.hpp"

namespace recald::report {

/// The answer first: headlines, Guideline 14 by output, what to heed.
void write_verdict_section(Html& html, const ReportData& data);

/// What to heed, the gravest first; nothing where there is nothing.
void write_notices(Html& html, const std::vector<Notice>& notices);

/// Are the data good? Coverage by month and meter, and what the readings showed.
void write_data_section(Html& html, const ReportData& data);

/// True where at least one month has a model's box beside its measurement.
[[nodiscard]] bool has_model(const ReportData& data);

/// Does the model follow the meters? Metrics, monthly box plots, CV(RMSE) of the draws.
void write_fit_section(Html& html, const ReportData& data);

/// What did the data teach about the building? Priors against posteriors.
void write_parameter_section(Html& html, const ReportData& data);

/// A figure of peaks for each meter, with their key.
void write_peak_figures(Html& html, const ReportData& data);
void write_peak_section(Html& html, const ReportData& data);
void write_profile_section(Html& html, const ReportData& data);
void write_load_section(Html& html, const ReportData& data);

/// What each meter's years and months cost and emitted.
void write_cost_section(Html& html, const ReportData& data);
/// What the forecast months cost and emit, with a band.
void write_forecast_cost_section(Html& html, const ReportData& data);

void write_not_known_section(Html& html, const ReportData& data);

/// What is needed to repeat the numbers, and the licences of what draws them.
void write_provenance(Html& html, const Provenance& from, const std::string& time_zone,
                      const std::string& generated_at);
void write_provenance_section(Html& html, const ReportData& data);

}  // namespace recald::report
