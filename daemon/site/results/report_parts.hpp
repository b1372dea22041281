/// What the pages of a calibration and of meters alone have in common.
#pragma once

#include "adapters/report/report_data.hpp"
#include "core/display/unit.hpp"
#include "daemon/site/model/run_facts.hpp"
#include "daemon/site/replay/recording.hpp"

namespace recald::daemon {

/// Without the computing time: the same data and seed give the same page.
[[nodiscard]] report::Provenance provenance_of(const RunFacts& facts);

/// A meter's hours as a calendar of whole months.
[[nodiscard]] report::LoadGrid load_of(const MeterRecord& record, display::UnitSystem system);

}  // namespace recald::daemon
