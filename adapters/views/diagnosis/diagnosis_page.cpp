#include "adapters/views/diagnosis/diagnosis_page.hpp"

#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/page.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

struct DiagnosisPart {
  std::string_view id;
  std::string_view link_text;
  void (*write)(Html&, const DiagnosisData&);
};

void write_origin_section(Html& html, const DiagnosisData& data) {
  write_provenance(html, data.provenance, data.site.time_zone, data.generated_at);
}

constexpr DiagnosisPart kDiagnosisParts[] = {
    {"outcome", "In short", write_outcome_section},
    {"located", "Where", write_located_section},
    {"maps", "Maps", write_map_section},
    {"candidates", "Explanations", write_candidate_section},
    {"gap", "Gap", write_gap_section},
    {"signature", "Shape", write_signature_section},
    {"not-identifiable", "Not seen here", write_not_identifiable_section},
    {"base", "Starting point", write_base_section},
    {"provenance", "Provenance", write_origin_section},
};

}  // namespace

std::string render_diagnosis(const DiagnosisData& data) {
  std::vector<PagePart> parts;
  for (const DiagnosisPart& part : kDiagnosisParts) {
    Html html;
    part.write(html, data);
    parts.push_back({part.id, part.link_text, html.str()});
  }
  return render_page({data.title, data.site, data.generated_at}, parts,
                     diagnosis_figure_json(data));
}

}  // namespace recald::views
