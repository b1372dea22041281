/// A followed site made up for the tests of its page.
#pragma once

#include "adapters/views/drift/drift_page.hpp"

namespace recald::views {

/// Three years of two outputs; chilled water rises in July of the third, a parameter follows.
[[nodiscard]] DriftData sample_drift();

/// Nothing has changed, one month is not measured, and a name tries to be markup.
[[nodiscard]] DriftData quiet_drift();

}  // namespace recald::views
