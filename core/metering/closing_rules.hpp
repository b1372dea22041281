/// The rules for closing a month, identified by a short text.
#pragma once

#include <string>

#include "core/metering/close_month.hpp"

namespace recald::metering {

/// The same text for the same rules, on every machine; another one when a rule for gaps, holidays,
/// coverage, validation or peaks changes, or what the meter is said to be able to do. What has no
/// say in a month's figures (its watermark, how long it may be reopened) is not in it.
[[nodiscard]] std::string closing_rules(const ClosingOptions& options, const Meter& meter);

}  // namespace recald::metering
