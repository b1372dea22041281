/// The parts of a diagnosis page, in the order of the reader's questions, and helpers for its
/// tables and figures. A part without data is left out.
#pragma once

#include <span>
#include <string_view>

#include "adapters/views/diagnosis/diagnosis_data.hpp"
#include "adapters/views/frame/html.hpp"

namespace recald::views {

/// The answer: what is missing, how sure, since when, how much.
void write_outcome_section(Html& html, const DiagnosisData& data);
/// Where do meters and model disagree, in words?
void write_located_section(Html& html, const DiagnosisData& data);
/// As above, as maps before and after.
void write_map_section(Html& html, const DiagnosisData& data);
/// Which explanations were considered, and what would tell them apart?
void write_candidate_section(Html& html, const DiagnosisData& data);
/// Did the gap shrink on the months kept back?
void write_gap_section(Html& html, const DiagnosisData& data);
/// Does the effect have the shape of the gap?
void write_signature_section(Html& html, const DiagnosisData& data);
/// What these meters cannot show.
void write_not_identifiable_section(Html& html, const DiagnosisData& data);
/// What the diagnosis started from.
void write_base_section(Html& html, const DiagnosisData& data);

/// The share at which the colours of a meter's maps saturate, the same before and after: 98 % of
/// the cells lie within it, rounded up; at most 1.
[[nodiscard]] double colour_scale(const MeterMaps& maps);

/// A measure of the gap.
struct GapMeasure {
  std::string_view label;
  bool is_share;  ///< Shown in percent.
  double (*value)(const diagnosis::MeterGap& first_step, const diagnosis::MeterGap& step);
};
/// The measures that are drawn step by step.
[[nodiscard]] std::span<const GapMeasure> gap_measures();

}  // namespace recald::views
