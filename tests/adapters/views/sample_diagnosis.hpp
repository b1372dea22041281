/// Diagnosis pages made of invented numbers.
#pragma once

#include "adapters/views/diagnosis/diagnosis_data.hpp"

namespace recald::views {

/// Three meters, two years, one effect that was added and confirmed; steam was not read in one
/// month. Titled as invented; the same bytes every time.
[[nodiscard]] DiagnosisData sample_diagnosis();

/// The awkward one: the same effect tried and withdrawn, a meter that was never read on the months
/// kept back, and words that try to break the page.
[[nodiscard]] DiagnosisData unconfirmed_diagnosis();

/// Nothing found, nothing added, no month kept back, four months of record.
[[nodiscard]] DiagnosisData empty_handed_diagnosis();

}  // namespace recald::views
