/// What a message of a broker says about the meters of a site.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// A value of a meter with source = "mqtt".
struct MeterValue {
  std::string meter;  ///< Its id.
  bool is_counter;    ///< Its energy in kWh; else its power in kW.
  double value;
  std::optional<metering::Instant> measured;  ///< As its sender says; absent: just now.
};

/// What could not be read, for people.
struct MqttRefusal {
  std::string meter;
  std::string why;  ///< A sentence.
};

struct MeterMessage {
  std::vector<MeterValue> values;
  std::vector<MqttRefusal> refusals;
};

/// Reads the values of all meters that this topic carries.
/// @param is_retained  It was kept by the broker: without a time of its own it may be of any age,
///                     and is left out.
/// @param now          Values from more than five minutes later are refused.
[[nodiscard]] MeterMessage parse_meter_message(const SiteConfig& site, std::string_view topic,
                                               std::string_view payload, bool is_retained,
                                               metering::Instant now);

/// The topics that the site's meters need, each once.
[[nodiscard]] std::vector<std::string> meter_topics(const SiteConfig& site);

}  // namespace recald::daemon
