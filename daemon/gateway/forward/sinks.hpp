/// The destinations that recald knows.
#pragma once

#include <memory>

#include "core/metering/civil_time.hpp"
#include "daemon/gateway/forward/broker_link.hpp"
#include "daemon/gateway/forward/outbox/sink.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Prometheus or InfluxDB. Secrets are read from their files each time, so that they can be
/// renewed.
[[nodiscard]] std::unique_ptr<Sink> make_series_sink(std::shared_ptr<const SiteConfig> site,
                                                     const metering::LocalCalendar& calendar,
                                                     const RemoteWriteConfig& config);

/// A broker. @param link  Null while there is none: everything waits.
[[nodiscard]] std::unique_ptr<Sink> make_mqtt_sink(std::shared_ptr<const SiteConfig> site,
                                                   std::shared_ptr<BrokerLink> link);

}  // namespace recald::daemon
