#include "daemon/gateway/upkeep/stored_site.hpp"

#include <fmt/format.h>

#include "adapters/stores/open.hpp"

namespace recald::daemon {

Result<std::vector<StoredMeter>> stored_meters(IntervalStore& store, const SiteConfig& site) {
  std::vector<StoredMeter> meters;
  for (const MeterConfig& config : site.meters) {
    const auto number = TRY(store.find_meter(config.meter.id));
    if (number) meters.push_back({*number, config.meter});
  }
  if (meters.empty()) {
    return failure(
        ErrorCode::not_found,
        fmt::format(
            "the store '{}' has no meter of the site; fill it with recald run or recald import",
            site.store.file.string()));
  }
  return meters;
}

Result<std::unique_ptr<Store>> open_to_read(const SiteConfig& site) {
  if (std::error_code ignored; !std::filesystem::exists(site.store.file, ignored)) {
    return failure(
        ErrorCode::not_found,
        fmt::format("there is no store '{}' yet; create it with recald run or recald import",
                    site.store.file.string()));
  }
  return stores::open_to_read(site.store.file);
}

}  // namespace recald::daemon
