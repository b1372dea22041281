/// A followed site made up for the tests of its page.
#pragma once

#include "adapters/report/drift_page.hpp"

namespace recald::report {

/// Three years of two outputs; chilled water rises in July of the third, a parameter follows.
[[nodiscard]] DriftData sample_drift();

/// Nothing has changed, one month is not measured, and a name tries to be markup.
[[nodiscard]] DriftData quiet_drift();

}  // namespace recald::report
