#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/format.hpp"

namespace recald::views {
namespace {

/// "loss 4.1 kW (3.2 kW to 5.0 kW); since 12 Mar 2021 (…)"
std::string parameter_words(const std::vector<EffectParameterRow>& rows) {
  std::string words;
  for (const EffectParameterRow& row : rows) {
    words += fmt::format("{}{} {} ({} to {})", words.empty() ? "" : "; ", row.name, row.mode,
                         row.low, row.high);
  }
  return words;
}

Table candidate_table(const DiagnosisData& data) {
  Table table("Every explanation that was weighed, the likeliest first");
  table.columns({"Explanation", "Probability here", "If half of all models lack nothing",
                 "If nine in ten lack nothing", "What it would mean", "Its size (5 to 95 %)",
                 "Evidence above no effect, nats"});
  for (const CandidateBar& bar : data.candidates) {
    table.row({{bar.label},
               {probability_text(bar.probability), "number"},
               {probability_text(bar.if_half_lack_nothing), "number"},
               {probability_text(bar.if_nine_in_ten_lack_nothing), "number"},
               {bar.meaning, "words"},
               {parameter_words(bar.parameters), "words"},
               {number_text(bar.evidence_gain), "number"}});
  }
  return table;
}

void write_signs(Html& html, const DiagnosisData& data) {
  if (data.signs.empty()) return;
  html.element("h3", "What speaks for them");
  html.element("p",
               "These are the figures by which the meters differ much from the model without the "
               "effect, and little from the model with it; both are fitted as well as they can be. "
               "Each difference is a share of what the meter reads at those times plus a quarter "
               "of its mean; \"with wind\" and the like are the change for one standard deviation "
               "of the wind.");
  Table table("Figures of the meters that speak for the likeliest effects");
  table.columns({"Effect", "Meter", "Where", "Measured minus modelled", "With the effect"});
  for (const SignRow& sign : data.signs) {
    table.row({{sign.effect},
               {sign.meter},
               {sign.where},
               {signed_percent_text(sign.without), "number"},
               {signed_percent_text(sign.with), "number"}});
  }
  table.write(html);
}

void write_separations(Html& html, const DiagnosisData& data) {
  if (data.separations.empty()) return;
  html.element("h3", "What would tell them apart");
  Table table("Effects that look alike on these meters, and what to measure");
  table.columns({"Effect", "Could be mistaken for", "Probability of that", "What to measure"});
  for (const Separation& s : data.separations) {
    table.row({{s.effect},
               {s.rival},
               {probability_text(s.rival_probability), "number"},
               {s.measurement, "words"}});
  }
  table.write(html);
}

}  // namespace

void write_candidate_section(Html& html, const DiagnosisData& data) {
  if (data.candidates.empty()) return;
  open_section(html, "candidates", "What could explain it?");
  html.element(
      "p",
      "The likeliest effects were each put into the model and everything fitted anew. "
      "\"No effect\" and \"something else\" compete with them; \"something else\" stands "
      "for a gap that has "
      "a pattern, but none that the catalogue knows. Probabilities are of the first "
      "search, before anything was added, and they sum to one. How many models lack nothing "
      "is for the reader to say ([diagnosis] prior_none in the site file); the table has "
      "two answers.");
  write_figure(html,
               {.kind = "candidates",
                .index = 0,
                .title = "Probability of each explanation",
                .description = "Bars: probability of each explanation.",
                .caption = "The likeliest ones; all are in the table.",
                .size = "small"},
               candidate_table(data));
  write_signs(html, data);
  write_separations(html, data);
  html.markup("</section>\n");
}

void write_not_identifiable_section(Html& html, const DiagnosisData& data) {
  if (data.not_identifiable.empty()) return;
  open_section(html, "not-identifiable", "What can these meters not show?");
  html.element("p",
               "These effects were not weighed. That they are not named does not mean that the "
               "building does not have them.");
  Table table("Effects that are not identifiable here");
  table.columns({"Effect", "Why"});
  for (const NotIdentifiableRow& row : data.not_identifiable) {
    table.row({{row.effect}, {row.why, "words"}});
  }
  table.write(html);
  html.markup("</section>\n");
}

}  // namespace recald::views
