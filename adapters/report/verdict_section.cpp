#include <fmt/format.h>

#include <algorithm>

#include "adapters/report/sections.hpp"

namespace recald::report {
namespace {

/// Word, sign and class together: the meaning never rests on colour.
struct Mark {
  std::string_view word;
  std::string_view css_class;
};

Mark severity_mark(Severity severity) {
  switch (severity) {
    case Severity::info:
      return {"Note", "note"};
    case Severity::warning:
      return {"▲ Warning", "warning"};
    case Severity::failure:
      return {"✕ Failure", "failure"};
  }
  return {"Note", "note"};
}

void write_headlines(Html& html, const ReportData& data) {
  for (std::size_t i = 0; i < data.headlines.size(); ++i) {
    html.element("p", data.headlines[i], i == 0 ? "headline" : "lead");
  }
}

void write_verdicts(Html& html, const ReportData& data) {
  if (data.verdicts.empty()) return;
  const auto passed =
      std::count_if(data.verdicts.begin(), data.verdicts.end(),
                    [](const OutputVerdict& output) { return output.verdict.pass; });
  html.element("h3", fmt::format("ASHRAE Guideline 14: {} of {} outputs within the limits", passed,
                                 data.verdicts.size()));
  html.element(
      "p",
      "The monthly limits are a mean bias (NMBE) of at most 5\u00a0% in either direction and a "
      "scatter, CV(RMSE), of at most 15\u00a0%.",
      "muted");
  html.markup("<ul class=\"verdicts\">\n");
  for (const auto& [output, verdict] : data.verdicts) {
    html.markup(verdict.pass ? "<li class=\"pass\">" : "<li class=\"fail\">")
        .element("span", verdict.pass ? "✓ Within limits" : "✕ Outside limits", "badge")
        .element("strong", output)
        .element("p", verdict.why)
        .markup("</li>\n");
  }
  html.markup("</ul>\n");
}

}  // namespace

void write_notices(Html& html, const std::vector<Notice>& notices) {
  if (notices.empty()) return;
  html.element("h3", "What to keep in mind").markup("<ul class=\"notices\">\n");
  // The gravest first; within one severity the caller's order.
  for (const Severity severity : {Severity::failure, Severity::warning, Severity::info}) {
    const Mark mark = severity_mark(severity);
    for (const Notice& notice : notices) {
      if (notice.severity != severity) continue;
      html.markup(fmt::format("<li class=\"{}\">", mark.css_class))
          .element("span", mark.word, "badge")
          .element("span", notice.sentence)
          .markup("</li>\n");
    }
  }
  html.markup("</ul>\n");
}

void write_verdict_section(Html& html, const ReportData& data) {
  if (data.headlines.empty() && data.verdicts.empty() && data.notices.empty()) return;
  open_section(html, "verdict", "In short");
  write_headlines(html, data);
  write_verdicts(html, data);
  write_notices(html, data.notices);
  html.markup("</section>\n");
}

}  // namespace recald::report
