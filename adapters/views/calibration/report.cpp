#include "adapters/views/calibration/report.hpp"

#include "adapters/views/frame/figure_data.hpp"
#include "adapters/views/frame/html.hpp"
#include "adapters/views/frame/page.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

struct ReportPart {
  std::string_view id;
  std::string_view link_text;
  void (*write)(Html&, const ReportData&);
};

constexpr ReportPart kReportParts[] = {
    {"verdict", "In short", write_verdict_section},
    {"data", "Data", write_data_section},
    {"fit", "Fit", write_fit_section},
    {"models", "Models", write_comparison_section},
    {"costs", "Cost", write_forecast_cost_section},
    {"parameters", "Parameters", write_parameter_section},
    {"peaks", "Peaks", write_peak_section},
    {"profile", "Schedules", write_profile_section},
    {"load", "Load", write_load_section},
    {"not-known", "Limits", write_not_known_section},
    {"provenance", "Provenance", write_provenance_section},
};

}  // namespace

std::string render_report(const ReportData& data) {
  std::vector<PagePart> parts;
  for (const ReportPart& part : kReportParts) {
    Html html;
    part.write(html, data);
    parts.push_back({part.id, part.link_text, html.str()});
  }
  return render_page({data.title, data.site, data.generated_at}, parts, figure_json(data));
}

}  // namespace recald::views
