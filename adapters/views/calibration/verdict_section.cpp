#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

#include "adapters/views/frame/first_screen.hpp"
#include "adapters/views/frame/most_likely.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

/// A word, a sign and a class, so that the meaning never depends on colour alone.
struct VerdictMark {
  std::string_view word;
  std::string_view css_class;
};

VerdictMark severity_mark(Severity severity) {
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

/// Without a first screen, the first headline is the answer.
void write_headlines(Html& html, const ReportData& data) {
  const bool is_answered = !data.first.sentence.empty();
  for (std::size_t i = 0; i < data.headlines.size(); ++i) {
    html.element("p", data.headlines[i], is_answered ? "" : (i == 0 ? "headline" : "lead"));
  }
}

/// Where the diagnosis of the same data is, or how to run one. `with_most_likely` finds
/// this line again.
void write_most_likely(Html& html, const ReportData& data) {
  if (!data.asks_for_diagnosis) return;
  html.markup(kMostLikelyOpen).markup(most_likely_markup(data.most_likely)).markup("</p>\n");
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

constexpr std::size_t kNoticesShown = 5;

void write_notice_list(Html& html, std::span<const Notice> notices) {
  html.markup("<ul class=\"notices\">\n");
  for (const Notice& notice : notices) {
    const VerdictMark mark = severity_mark(notice.severity);
    html.markup(fmt::format("<li class=\"{}\">", mark.css_class))
        .element("span", mark.word, "badge")
        .markup("<div>\n")
        .element("span", notice.sentence);
    if (!notice.details.empty()) {
      html.markup("<details><summary>Details</summary>\n")
          .element("p", notice.details)
          .markup("</details>\n");
    }
    html.markup("</div>\n</li>\n");
  }
  html.markup("</ul>\n");
}

}  // namespace

void write_notices(Html& html, const std::vector<Notice>& notices) {
  if (notices.empty()) return;
  // The gravest first, then what costs most; what costs the same in the caller's order.
  std::vector<Notice> ranked = notices;
  std::ranges::stable_sort(ranked, std::greater{}, [](const Notice& notice) {
    return std::pair{notice.severity, notice.share};
  });
  html.element("h3", "What to keep in mind");
  const std::size_t shown = std::min(ranked.size(), kNoticesShown);
  write_notice_list(html, std::span{ranked}.first(shown));
  if (shown == ranked.size()) return;
  html.markup(
      fmt::format("<details class=\"more\"><summary>{} more</summary>\n", ranked.size() - shown));
  write_notice_list(html, std::span{ranked}.subspan(shown));
  html.markup("</details>\n");
}

void write_verdict_section(Html& html, const ReportData& data) {
  if (data.headlines.empty() && data.verdicts.empty() && data.notices.empty() &&
      data.first.sentence.empty()) {
    return;
  }
  open_section(html, "verdict", "In short");
  if (!data.first.sentence.empty()) {
    write_first_words(html, data.first);
    write_most_likely(html, data);
    write_key_numbers(html, data.first);
    write_overview(html, model_overview(data),
                   {"calibrated model, as its parameters leave it",
                    "Months outside the band are those that the model does not follow, whatever "
                    "its parameters."});
    if (!data.headlines.empty()) html.element("h3", "Forecasts and model in figures");
  }
  write_headlines(html, data);
  write_verdicts(html, data);
  write_notices(html, data.notices);
  html.markup("</section>\n");
}

}  // namespace recald::views
