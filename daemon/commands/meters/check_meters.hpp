/// `recald check --meters`: what each live meter says now.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "daemon/commands/console.hpp"
#include "daemon/commands/meters/try_meter.hpp"

namespace recald::daemon {

struct TriedMeter {
  const MeterConfig* meter;
  const BusConfig* bus;
  MeterTrial trial;
};

/// Reads each live meter bus by bus, and its counters a few seconds later again, for what a single
/// read cannot show; `tell` hears of each as soon as it is done.
/// @param site  Outlives the result.
[[nodiscard]] std::vector<TriedMeter> try_meters(
    const SiteConfig& site, const std::function<void(const TriedMeter&)>& tell);

void print_trial(const TriedMeter& tried, const Console& console);
[[nodiscard]] nlohmann::ordered_json json_of(const TriedMeter& tried);

/// "meter 'main' (unit 7 at 10.20.0.15:1502) does not answer", one for each failure.
[[nodiscard]] std::vector<std::string> problems_of(const TriedMeter& tried);

}  // namespace recald::daemon
