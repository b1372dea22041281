#include "adapters/report/report.hpp"

#include <fmt/format.h>

#include "adapters/report/assets.hpp"
#include "adapters/report/figure_data.hpp"
#include "adapters/report/html.hpp"
#include "adapters/report/sections.hpp"

namespace recald::report {
namespace {

/// Nothing may be fetched: only this script, this style and pictures made on the page. Style
/// attributes are needed by the drawing library, which sets them on the elements it makes.
std::string content_security_policy() {
  return fmt::format(
      "default-src 'none'; script-src '{}'; style-src '{}'; style-src-attr 'unsafe-inline'; "
      "img-src data:; base-uri 'none'; form-action 'none'",
      assets().script_hash, assets().style_hash);
}

void write_head(Html& html, const ReportData& data) {
  html.markup("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n")
      .markup("<meta http-equiv=\"Content-Security-Policy\" content=\"")
      .markup(content_security_policy())
      .markup("\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n")
      .markup("<meta name=\"color-scheme\" content=\"light\">\n")
      .element("title", data.title)
      .markup("<style>")
      .markup(assets().style)
      .markup("</style>\n</head>\n");
}

void write_masthead(Html& html, const ReportData& data) {
  html.markup("<header>\n").element("h1", data.title);
  std::string line = data.site.name;
  if (!data.site.id.empty()) line += fmt::format(" ({})", data.site.id);
  html.markup("<p class=\"meta\">").element("span", line);
  if (!data.generated_at.empty()) html.element("span", "Made " + data.generated_at);
  if (!data.site.time_zone.empty()) html.element("span", "Times in " + data.site.time_zone);
  html.markup("</p>\n</header>\n");
}

struct Part {
  std::string_view id;
  std::string_view link_text;
  void (*write)(Html&, const ReportData&);
};

constexpr Part kParts[] = {
    {"verdict", "In short", write_verdict_section},
    {"data", "Data", write_data_section},
    {"fit", "Fit", write_fit_section},
    {"parameters", "Parameters", write_parameter_section},
    {"peaks", "Peaks", write_peak_section},
    {"profile", "Schedules", write_profile_section},
    {"load", "Load", write_load_section},
    {"not-known", "Limits", write_not_known_section},
    {"provenance", "Provenance", write_provenance_section},
};

/// Links to the parts that are there, then the parts.
void write_body(Html& html, const ReportData& data) {
  Html navigation;
  Html parts;
  for (const Part& part : kParts) {
    const std::size_t before = parts.str().size();
    part.write(parts, data);
    if (parts.str().size() == before) continue;
    navigation.markup(fmt::format("<a href=\"#{}\">{}</a>\n", part.id, part.link_text));
  }
  html.markup("<nav aria-label=\"Parts of this report\">\n")
      .markup(navigation.str())
      .markup("</nav>\n");
  html.markup(
      "<noscript><p class=\"muted\">The figures need JavaScript. Their numbers are in the tables "
      "below each of them, which do not.</p></noscript>\n");
  html.markup("<main>\n").markup(parts.str()).markup("</main>\n");
}

}  // namespace

std::string render_report(const ReportData& data) {
  Html html;
  write_head(html, data);
  html.markup("<body>\n");
  write_masthead(html, data);
  write_body(html, data);
  html.markup("<script type=\"application/json\" id=\"report-data\">")
      .markup(figure_json(data))
      .markup("</script>\n<script>")
      .markup(assets().script)
      .markup("</script>\n</body>\n</html>\n");
  return html.str();
}

}  // namespace recald::report
