// A site file that is accepted is consistent; one that is refused is told where and why.
#include <cmath>

#include "daemon/site/config/site_config.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using daemon::MeterConfig;
using daemon::SiteConfig;

void require_consistent(const SiteConfig& site) {
  require(!site.meters.empty(), "a site has a meter");
  require(recald::metering::LocalCalendar::open(site.timezone).has_value(), "the zone exists");
  for (const MeterConfig& meter : site.meters) {
    require(site.meter_index(meter.meter.id).has_value(), "a meter is found by its id");
    require(&site.meters[*site.meter_index(meter.meter.id)] == &meter, "ids are unique");
    require(std::isfinite(meter.multiplier) && meter.multiplier > 0.0, "a multiplier that scales");
    if (meter.meter.rated_kW) require(std::isfinite(*meter.meter.rated_kW), "a finite rating");
    if (!meter.live) continue;
    const bool has_bus = [&] {
      for (const auto& bus : site.buses) {
        if (bus.name == meter.live->bus) return true;
      }
      return false;
    }();
    require(has_bus, "a live meter's bus is described");
    require(plan_reads(metered_fields(meter.live->map), meter.live->map.function,
                       meter.live->map.limits)
                .has_value(),
            "its reads can be planned");
  }
  if (!site.model) return;
  for (const std::string& output : site.model->outputs) {
    require(site.meter_index(output).has_value(), "an output is a meter");
  }
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  const auto site = recald::daemon::parse_site(text_of(data, size), "/nowhere/site.toml");
  if (site) {
    require_consistent(*site);
    return 0;
  }
  require(!site.error().empty(), "a refusal has a reason");
  for (const std::string& problem : site.error()) {
    require_sentence(problem);
    require(problem.starts_with("site.toml:"), "a problem says where");
  }
  return 0;
}
