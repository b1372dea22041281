/// The page of a diagnosis: what the model lacks, where that shows, and whether adding it helped.
#pragma once

#include <string>

#include "adapters/views/diagnosis/diagnosis_data.hpp"

namespace recald::views {

/// Renders the page under the rules of `render_report`: self-contained, every text escaped, the
/// same data give the same bytes.
///
/// @pre  Maps have a row per part and a column per month or temperature bin; `uses` is as long as
///       `months`; a step has a gap per meter.
[[nodiscard]] std::string render_diagnosis(const DiagnosisData& data);

/// The numbers that the page's script draws.
[[nodiscard]] std::string diagnosis_figure_json(const DiagnosisData& data);

}  // namespace recald::views
