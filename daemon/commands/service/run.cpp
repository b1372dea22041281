#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/gateway/run/service.hpp"

namespace recald::daemon {

int run_run(const RunArguments& arguments, const Console& console) {
  auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  const SiteConfig& config = site->config;
  const auto any = [&](auto is_it) {
    return std::ranges::any_of(config.meters, is_it) || std::ranges::any_of(config.sensors, is_it);
  };
  if (!any(&MeterConfig::is_stored)) {
    return console.fail(
        fmt::format("{}: no [[meter]] has source = \"modbus\", \"http\" or \"mqtt\", so there is "
                    "nothing to poll or receive; use recald replay for recorded readings",
                    arguments.site.filename().string()));
  }
  const bool is_live = any([](const MeterConfig& meter) { return meter.live || meter.mqtt; });
  if (!is_live && !config.http) {
    const auto pushed = std::ranges::find(config.meters, MeterSource::http, &MeterConfig::source);
    return console.fail(
        nowhere_to_push(config, pushed == config.meters.end() ? config.sensors.front() : *pushed));
  }
  ServiceOptions options;
  if (!arguments.clock.empty()) {
    const auto clock = metering::parse_trial_clock(arguments.clock);
    if (!clock) return console.misused("--clock: " + clock.error().message);
    options.trial = *clock;
  }
  options.record = arguments.record;
  options.record_max_bytes = static_cast<std::uint64_t>(arguments.record_max_MB) * 1'000'000;
  if (console.detail == Console::Detail::little) spdlog::set_level(spdlog::level::warn);
  if (console.detail == Console::Detail::all) spdlog::set_level(spdlog::level::debug);
  const auto ended = run_service(std::move(*site), options);
  if (!ended) return console.fail(ended.error());
  return kSuccess;
}

}  // namespace recald::daemon
