/// Keeps the retained state of a site and its meters at a broker up to date.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/worker.hpp"
#include "daemon/gateway/forward/broker_link.hpp"
#include "daemon/gateway/registers/register_facts.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Publishes what has changed, once a minute, and all of it to a broker that is new or was away. A
/// state that could not be published is replaced by the next one.
class BrokerState {
 public:
  BrokerState(Loop& loop, std::unique_ptr<Worker> worker, std::shared_ptr<const SiteConfig> site,
              std::shared_ptr<BrokerLink> link);
  /// Stops what is being published, and waits for it.
  ~BrokerState();
  BrokerState(const BrokerState&) = delete;
  BrokerState& operator=(const BrokerState&) = delete;

  /// May be called often.
  void set(const SiteFacts& facts);

  /// The broker may have forgotten everything.
  void begin_anew();

 private:
  void finish(std::span<const mqtt::Message> published);

  Loop& loop_;
  std::shared_ptr<const SiteConfig> site_;
  std::shared_ptr<BrokerLink> link_;
  std::map<std::string, std::string> published_;  ///< Payload by topic.
  std::optional<std::chrono::milliseconds> not_before_;
  bool is_publishing_ = false;
  bool is_anew_ = false;
  std::stop_source stop_;
  Alive alive_;
  std::unique_ptr<Worker> worker_;  ///< Last: its work must end before the members it uses.
};

}  // namespace recald::daemon
