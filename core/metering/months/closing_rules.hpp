/// The rules for closing a month, identified by a short text.
#pragma once

#include <string>

#include "core/metering/months/close_month.hpp"

namespace recald::metering {

/// The same text for the same rules, on every machine. It changes with the rules for gaps,
/// holidays, coverage, validation or peaks, and with the meter's declared limits. Settings that do
/// not affect a month's figures (its watermark, how long it may be reopened) are not included.
[[nodiscard]] std::string closing_rules(const ClosingOptions& options, const Meter& meter);

}  // namespace recald::metering
