#include "adapters/views/savings/savings_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "adapters/views/drift/forecast_table.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/html.hpp"
#include "adapters/views/frame/page.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

void write_saving_card(Html& html, const SavingCard& card) {
  html.element("h3", card.title);
  if (!card.sentence.empty()) html.element("p", card.sentence, "lead");
  Table table(card.caption);
  table.columns({"What", "Median", "5 %", "95 %", "Share", "Saves at all"});
  for (const SavedAmount& amount : card.amounts) {
    table.row({{with_unit(amount.what, amount.unit)},
               {number_text(amount.q50), "number"},
               {number_text(amount.q05), "number"},
               {number_text(amount.q95), "number"},
               {amount.share ? signed_percent_text(*amount.share) : "–", "number"},
               {probability_text(amount.probability), "number"}});
  }
  table.with_labels().write(html);
  if (card.notes.empty()) return;
  html.markup("<ul class=\"plain\">\n");
  for (const std::string& note : card.notes) html.element("li", note);
  html.markup("</ul>\n");
}

void write_saving_cards(Html& html, const SavingsData& data) {
  open_section(html, "savings", "In short");
  html.element("p", data.headline, "headline");
  for (const SavingCard& card : data.cards) write_saving_card(html, card);
  write_notices(html, data.notices);
  html.markup("</section>\n");
}

void write_expected_months(Html& html, const SavingsData& data) {
  if (data.months.empty()) return;
  open_section(html, "months", "Months before and after");
  html.element("p", fmt::format("Learnt from: {}.", fmt::join(data.months_before, ", ")));
  html.element("p", fmt::format("Looked at: {}.", fmt::join(data.months_after, ", ")));
  for (std::size_t i = 0; i < data.months.size(); ++i) {
    const ForecastSeries& series = data.months[i];
    write_figure(html,
                 {.kind = "forecast",
                  .index = static_cast<int>(i),
                  .title = series.label,
                  .description = fmt::format("What {} would have shown without the measure, with a "
                                             "90 % band, and what it showed, {} months.",
                                             series.label, series.months.size()),
                  .caption = series.trust},
                 forecast_table(series, "expected"));
  }
  html.markup("</section>\n");
}

void write_not_known_of_savings(Html& html, const SavingsData& data) {
  if (data.not_known.empty()) return;
  open_section(html, "not-known", "What these numbers do not know");
  html.markup("<ul class=\"plain\">\n");
  for (const std::string& sentence : data.not_known) html.element("li", sentence);
  html.markup("</ul>\n</section>\n");
}

}  // namespace

std::string render_savings(const SavingsData& data) {
  std::vector<PagePart> parts;
  const auto add = [&](std::string_view id, std::string_view link_text, auto write) {
    Html html;
    write(html, data);
    parts.push_back({id, link_text, html.str()});
  };
  add("savings", "In short", write_saving_cards);
  add("months", "Months", write_expected_months);
  add("not-known", "Not known", write_not_known_of_savings);
  add("provenance", "Provenance", [](Html& html, const SavingsData& savings) {
    write_provenance(html, savings.provenance, savings.site.time_zone, savings.generated_at);
  });
  return render_page({data.title, data.site, data.generated_at}, parts,
                     drift_figure_json({.title = {},
                                        .site = {},
                                        .generated_at = {},
                                        .headline = {},
                                        .alarms = {},
                                        .meter_changes = {},
                                        .notices = {},
                                        .outputs = data.months,
                                        .parameters = {},
                                        .windows = {},
                                        .history = {},
                                        .provenance = {}}));
}

}  // namespace recald::views
