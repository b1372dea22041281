#include <fmt/format.h>

#include <algorithm>

#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/run/service.hpp"

namespace recald::daemon {

int run_run(const SiteArguments& arguments, const Console& console) {
  const auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  const bool reads_anything = std::ranges::any_of(
      site->config.meters, [](const MeterConfig& meter) { return meter.live.has_value(); });
  if (!reads_anything) {
    return console.fail(
        fmt::format("{}: no [[meter]] has source = \"modbus\", so there is nothing to poll; use "
                    "recald replay for recorded readings",
                    arguments.site.filename().string()));
  }
  const auto ended = run_service(site->config, site->calendar);
  if (!ended) return console.fail(ended.error());
  return kSuccess;
}

}  // namespace recald::daemon
