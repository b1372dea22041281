#include <fmt/format.h>

#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/format.hpp"

namespace recald::views {
namespace {

std::string where_of(std::size_t i) { return i == 0 ? "by part of the week" : "by temperature"; }

Table signature_table(const DiagnosisData& data, const EffectSignature& s) {
  Table table(fmt::format("{} at {}: means as shares of the meter's mean", s.effect, s.meter));
  table.columns({"", "Gap before", "What the model changed", "The effect alone"});
  const auto row = [&table](std::string label, double gap, double change, double alone) {
    table.row({{std::move(label)},
               {signed_percent_text(gap), "number"},
               {signed_percent_text(change), "number"},
               {signed_percent_text(alone), "number"}});
  };
  table.group("By part of the week");
  for (int i = 0; i < s.residual.by_part_of_week.size(); ++i) {
    const int part = (i + 6) % 42;
    row(part_of_week_text(part), s.residual.by_part_of_week[part], s.change.by_part_of_week[part],
        s.effect_alone.by_part_of_week[part]);
  }
  table.group("By outdoor temperature");
  for (int bin = 0; bin < s.residual.by_temperature.size(); ++bin) {
    const auto i = static_cast<std::size_t>(bin);
    row(fmt::format("{} to {} {}", count_text(data.temperature_limits[i]),
                    count_text(data.temperature_limits[i + 1]), data.temperature_unit),
        s.residual.by_temperature[bin], s.change.by_temperature[bin],
        s.effect_alone.by_temperature[bin]);
  }
  return table;
}

constexpr std::string_view kSignatureKey =
    "<p class=\"key\" aria-hidden=\"true\">"
    "<span><i class=\"sign box\"></i>gap before: measured minus modelled</span>"
    "<span><i class=\"sign line\"></i>what the model changed</span>"
    "<span><i class=\"sign dashed\"></i>the effect alone</span></p>\n";

}  // namespace

void write_signature_section(Html& html, const DiagnosisData& data) {
  if (data.signatures.empty()) return;
  open_section(html, "signature", "Does the effect have the shape of the gap?");
  html.element(
      "p",
      "The bars are the gap before the effect was added. The line is what the model "
      "changed when it got the effect and its other parameters were fitted anew; it should "
      "follow the bars. Dashed: the effect alone. Where that stands off the line, other "
      "parameters had taken the effect's place before.");
  html.markup(kSignatureKey).markup("<div class=\"multiples wide\">\n");
  for (std::size_t i = 0; i < data.signatures.size(); ++i) {
    const EffectSignature& s = data.signatures[i];
    write_figure(html,
                 {.kind = "signature",
                  .index = static_cast<int>(i),
                  .title = fmt::format("{}: {}", s.meter, s.effect),
                  .description = fmt::format("Gap and effect at {}, {} and {}: {}.", s.meter,
                                             where_of(0), where_of(1), s.effect),
                  .caption = "Above by part of the week, below by outdoor temperature.",
                  .size = ""},
                 signature_table(data, s));
  }
  html.markup("</div>\n</section>\n");
}

}  // namespace recald::views
