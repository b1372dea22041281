#include "adapters/views/frame/page.hpp"

#include <fmt/format.h>

#include "adapters/views/frame/assets.hpp"
#include "adapters/views/frame/html.hpp"

namespace recald::views {
namespace {

/// Nothing may be loaded: only this script, this style and pictures made on the page are allowed.
/// Style attributes are allowed because the drawing library sets them on its elements.
std::string content_security_policy() {
  return fmt::format(
      "default-src 'none'; script-src '{}'; style-src '{}'; style-src-attr 'unsafe-inline'; "
      "img-src data:; base-uri 'none'; form-action 'none'",
      assets().script_hash, assets().style_hash);
}

void write_head(Html& html, const PageHead& head) {
  html.markup("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n")
      .markup("<meta http-equiv=\"Content-Security-Policy\" content=\"")
      .markup(content_security_policy())
      .markup("\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n")
      .markup("<meta name=\"color-scheme\" content=\"light dark\">\n")
      .element("title", head.title)
      .markup("<style>")
      .markup(assets().style)
      .markup("</style>\n</head>\n");
}

void write_masthead(Html& html, const PageHead& head) {
  html.markup("<header>\n").element("h1", head.title);
  std::string line = head.site.name;
  if (!head.site.id.empty()) line += fmt::format(" ({})", head.site.id);
  html.markup("<p class=\"meta\">").element("span", line);
  if (!head.generated_at.empty()) html.element("span", "Made " + head.generated_at);
  if (!head.site.time_zone.empty()) html.element("span", "Times in " + head.site.time_zone);
  html.markup("</p>\n</header>\n");
}

void write_body(Html& html, const std::vector<PagePart>& parts) {
  html.markup("<nav aria-label=\"Parts of this report\">\n");
  for (const PagePart& part : parts) {
    if (part.markup.empty()) continue;
    html.markup(fmt::format("<a href=\"#{}\">{}</a>\n", part.id, part.link_text));
  }
  html.markup("</nav>\n")
      .markup(
          "<noscript><p class=\"muted\">The figures need JavaScript. Their numbers are in the "
          "tables "
          "below each of them, which do not.</p></noscript>\n<main>\n");
  for (const PagePart& part : parts) html.markup(part.markup);
  html.markup("</main>\n");
}

}  // namespace

std::string render_page(const PageHead& head, const std::vector<PagePart>& parts,
                        const std::string& figure_json) {
  Html html;
  write_head(html, head);
  html.markup("<body>\n");
  write_masthead(html, head);
  write_body(html, parts);
  html.markup("<script type=\"application/json\" id=\"report-data\">")
      .markup(figure_json)
      .markup("</script>\n<script>")
      .markup(assets().script)
      .markup("</script>\n</body>\n</html>\n");
  return html.str();
}

}  // namespace recald::views
