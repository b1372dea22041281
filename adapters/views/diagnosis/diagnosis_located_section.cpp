#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/format.hpp"

namespace recald::views {
namespace {

constexpr std::size_t kRowsShown = 15;
// Above three times the model's value a percentage is meaningless: the model has
// almost nothing there.
constexpr double kSharePeopleRead = 2.0;

/// "14.0 % more than the model (± 3.0 %)"
std::string share_words(const diagnosis::Misfit& row) {
  if (!std::isfinite(row.share)) return "–";
  if (row.share > kSharePeopleRead) {
    return fmt::format("{} times what the model says", number_text(1.0 + row.share));
  }
  return fmt::format("{} {} than the model (±\u00a0{})", percent_text(std::abs(row.share)),
                     row.share > 0.0 ? "more" : "less", percent_text(row.share_se));
}

void write_rows(Html& html, const DiagnosisData& data, const std::vector<diagnosis::Misfit>& rows,
                std::string caption) {
  const std::size_t shown = std::min(rows.size(), kRowsShown);
  if (shown < rows.size()) {
    caption += fmt::format(" ({} of {} places; diagnosis.json has more)", shown, rows.size());
  }
  Table table(std::move(caption));
  table.columns({"Meter", "When", "The meter reads", "A month"});
  for (std::size_t i = 0; i < shown; ++i) {
    const diagnosis::Misfit& row = rows[i];
    table.row({{data.meters[row.meter]},
               {row.words, "words"},
               {share_words(row), "nowrap"},
               {signed_amount_text(row.kWh_month, data.units[row.meter].energy), "number"}});
  }
  table.write(html);
}

}  // namespace

void write_located_section(Html& html, const DiagnosisData& data) {
  open_section(html, "located", "Where do the meters and the model disagree?");
  if (data.located.empty()) {
    html.element("p",
                 data.added.empty()
                     ? "Nowhere beyond chance: in no hours, weather or months does a meter "
                       "stand apart from the calibrated model further than a model without any "
                       "missing effect would let it."
                     : "No single place stands out beyond chance. What was named shows only "
                       "when all of them are taken together.");
    html.markup("</section>\n");
    return;
  }
  html.element("p",
               "The model was calibrated first: what is listed here is what is left when its "
               "parameters have done what they can. The clearest places come first; a place that "
               "chance could explain is not listed. The months kept back have no part in it.");
  write_rows(html, data, data.located, "Before anything was added");
  if (!data.added.empty()) {
    if (data.located_after.empty()) {
      html.element("p", "With what was added, no place is left that chance could not explain.");
    } else {
      write_rows(html, data, data.located_after, "What is left with the additions in the model");
    }
  }
  html.markup("</section>\n");
}

}  // namespace recald::views
