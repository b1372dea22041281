#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/gateway/run/service.hpp"

namespace recald::daemon {

int run_run(const RunArguments& arguments, const Console& console) {
  auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  const auto& meters = site->config.meters;
  if (std::ranges::none_of(meters, &MeterConfig::is_stored)) {
    return console.fail(
        fmt::format("{}: no [[meter]] has source = \"modbus\" or \"http\", so there is nothing to "
                    "poll or to receive; use recald replay for recorded readings",
                    arguments.site.filename().string()));
  }
  const bool polls =
      std::ranges::any_of(meters, [](const MeterConfig& meter) { return meter.live.has_value(); });
  if (!polls && !site->config.http) {
    const auto pushed = std::ranges::find(meters, MeterSource::http, &MeterConfig::source);
    return console.fail(nowhere_to_push(site->config, *pushed));
  }
  ServiceOptions options;
  if (!arguments.clock.empty()) {
    const auto clock = metering::parse_trial_clock(arguments.clock);
    if (!clock) return console.misused("--clock: " + clock.error().message);
    options.trial = *clock;
  }
  const auto ended = run_service(std::move(*site), options);
  if (!ended) return console.fail(ended.error());
  return kSuccess;
}

}  // namespace recald::daemon
