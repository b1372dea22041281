#include <fmt/format.h>

#include "adapters/views/frame/assets.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

template <class Number>
std::string plain(const std::optional<Number>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

void write_licences(Html& html) {
  html.markup(
          "<details id=\"licences\"><summary>Licences of the libraries that draw this page's "
          "figures</summary>\n")
      .element("pre", assets().licences)
      .markup("</details>\n");
}

}  // namespace

void write_not_known_section(Html& html, const ReportData& data) {
  if (data.not_known.empty()) return;
  open_section(html, "not-known", "What this report does not know");
  html.markup("<ul class=\"plain\">\n");
  for (const std::string& sentence : data.not_known) html.element("li", sentence);
  html.markup("</ul>\n</section>\n");
}

void write_provenance(Html& html, const Provenance& from, const std::string& time_zone,
                      const std::string& generated_at) {
  open_section(html, "provenance", "How to repeat these numbers");
  html.element(
      "p", "The same readings, model, settings and seed give the same numbers, to the last digit.");
  html.markup("<dl>\n");
  const auto entry = [&html](std::string_view name, std::string_view value) {
    if (value.empty()) return;
    html.markup("<div>").element("dt", name).element("dd", value).markup("</div>\n");
  };
  entry("recald", from.recald_version);
  entry("Data revision", from.data_revision);
  entry("Model", from.model_version);
  entry("Catalogue of effects", from.catalogue);
  entry("Sampler", from.sampler);
  entry("Prior of the model discrepancy", from.hyper_prior_profile);
  entry("Chains", plain(from.chains));
  entry("Iterations a chain", from.iterations ? count_text(*from.iterations) : "");
  entry("Of these dropped", from.burn_in ? count_text(*from.burn_in) : "");
  entry("Seed", plain(from.seed));
  entry("Computing time", from.wall_s ? fmt::format("{:.1f} s", *from.wall_s) : "");
  entry("Weather file's temperatures", from.weather_values);
  entry("Time zone", time_zone);
  entry("Time zone rules", from.time_zone_data);
  entry("Report made", generated_at);
  html.markup("</dl>\n");
  write_licences(html);
  html.markup("</section>\n");
}

void write_provenance_section(Html& html, const ReportData& data) {
  write_provenance(html, data.provenance, data.site.time_zone, data.generated_at);
}

}  // namespace recald::views
