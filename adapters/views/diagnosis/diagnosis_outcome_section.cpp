#include <fmt/format.h>

#include <cmath>

#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

/// A word, a sign and a class, so that the meaning never depends on colour alone.
struct Mark {
  std::string_view word;
  std::string_view css_class;
};

Mark outcome_mark(const DiagnosisData& data) {
  if (data.not_confirmed) return {"✕ Not confirmed", "fail"};
  switch (data.outcome) {
    case diagnosis::Outcome::named:
      return {"✓ Named", "pass"};
    case diagnosis::Outcome::confusable:
      return {"▲ Cannot be told apart", "warning"};
    case diagnosis::Outcome::unknown:
      return {"▲ Not in the catalogue", "warning"};
    case diagnosis::Outcome::none:
      break;
  }
  return {"○ Nothing named", "note"};
}

void write_parameters(Html& html, const AddedEffectCard& card) {
  Table table("Its size, fitted together with the rest of the model");
  table.columns({"Parameter", "Most likely", "5 %", "95 %"});
  for (const EffectParameterRow& row : card.parameters) {
    table.row({{row.name}, {row.mode, "number"}, {row.low, "number"}, {row.high, "number"}});
  }
  table.write(html);
}

void write_impacts(Html& html, const AddedEffectCard& card) {
  Table table("What it does to the meters");
  table.columns({"Meter", "A month, on average"});
  for (const Impact& impact : card.impacts) {
    table.row({{impact.meter}, {impact.a_month, "number"}});
  }
  table.write(html);
}

void write_card(Html& html, const AddedEffectCard& card, bool withdrawn) {
  html.markup(withdrawn ? "<li class=\"fail\">" : "<li class=\"pass\">")
      .element("span", withdrawn ? "✕ Tried and withdrawn" : "✓ Named and confirmed", "badge")
      .element("strong", card.title)
      .element("p", card.meaning)
      .element("p",
               fmt::format("Probability {}. {}", probability_text(card.probability), card.when));
  html.markup("<div class=\"side-by-side\">\n<div>\n");
  if (!card.impacts.empty()) write_impacts(html, card);
  html.markup("</div>\n<div>\n");
  if (!card.parameters.empty()) write_parameters(html, card);
  html.markup("</div>\n</div>\n");
  if (!card.physics.empty()) html.element("p", "In the model: " + card.physics, "muted");
  html.markup("</li>\n");
}

}  // namespace

void write_outcome_section(Html& html, const DiagnosisData& data) {
  const Mark mark = outcome_mark(data);
  open_section(html, "outcome", "In short");
  html.markup(fmt::format("<p class=\"{}\">", mark.css_class))
      .element("span", mark.word, "badge")
      .markup("</p>\n");
  html.element("p", data.headline, data.not_confirmed ? "headline bad" : "headline");
  for (const std::string& sentence : data.explanations) html.element("p", sentence, "lead");
  if (!data.added.empty()) {
    html.markup("<ul class=\"verdicts effects\">\n");
    for (const AddedEffectCard& card : data.added) write_card(html, card, data.not_confirmed);
    html.markup("</ul>\n");
  }
  write_notices(html, data.notices);
  html.markup("</section>\n");
}

}  // namespace recald::views
