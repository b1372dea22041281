/// Everything that the site file has of brokers, databases and a fleet: tells them of what is
/// stored, and takes what a broker says of the site's meters.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "adapters/mqtt/message.hpp"
#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/gateway/forward/broker_link.hpp"
#include "daemon/gateway/forward/broker_state.hpp"
#include "daemon/gateway/forward/forwarder.hpp"
#include "daemon/gateway/forward/open_broker.hpp"
#include "daemon/gateway/forward/record_link.hpp"
#include "daemon/gateway/forward/waiting_messages.hpp"
#include "daemon/gateway/ingest/meter_message.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

class Forwarding {
 public:
  struct Ports {
    Loop& loop;
    Store& store;
    bool is_on_disk = true;   ///< Of the store: what is only in memory is sent once it is on disk.
    ForwardRules rules = {};  ///< Of every destination.
  };
  using Notify = std::function<void(StoreEvent)>;
  using OnValue = std::function<void(const MeterValue&)>;

  /// @param notify    Adds an event.
  /// @param on_value  Called on the loop's thread for each value of a meter.
  Forwarding(Ports ports, std::shared_ptr<const SiteConfig> site, metering::LocalCalendar calendar,
             Notify notify, OnValue on_value);
  ~Forwarding();
  Forwarding(const Forwarding&) = delete;
  Forwarding& operator=(const Forwarding&) = delete;

  void start();

  /// Continues with another site file. A connection and a destination that are described as before
  /// go on.
  void set_site(std::shared_ptr<const SiteConfig> site);

  /// For the retained state at the broker; may be called often.
  void set_facts(const SiteFacts& facts) {
    if (state_) state_->set(facts);
  }

  [[nodiscard]] std::vector<DestinationStatus> status() const;

 private:
  void begin();
  void connect();
  void connect_to_fleet();
  void keep_outbox();
  void add_forwarder(Destination destination, std::unique_ptr<Sink> sink);
  void read_messages();
  void read(const mqtt::Message& message);
  void on_broker_state(bool is_connected, const std::string& why);
  void on_record();
  void on_fleet_state(bool is_connected, const std::string& why);
  void begin_again_in_a_minute();
  void notify(StoreEvent event);

  /// A function for other threads: calls a member on the loop's thread, while this lives.
  template <class... Arguments>
  [[nodiscard]] auto on_loop(void (Forwarding::*member)(Arguments...)) {
    auto call = alive_.guard([this, member](const auto&... each) { (this->*member)(each...); });
    return [&loop = ports_.loop, call](const auto&... values) {
      loop.post([call, copies = std::tuple{values...}]() mutable { std::apply(call, copies); });
    };
  }

  Ports ports_;
  std::shared_ptr<const SiteConfig> site_;
  metering::LocalCalendar calendar_;
  Notify notify_;
  OnValue on_value_;
  bool is_started_ = false;
  bool is_again_due_ = false;
  BrokerNews broker_news_, fleet_news_;
  /// Shared with the broker's thread.
  std::shared_ptr<WaitingMessages> messages_ = std::make_shared<WaitingMessages>();
  std::shared_ptr<std::atomic<bool>> is_sign_due_ = std::make_shared<std::atomic<bool>>(false);
  std::int64_t dropped_ = 0;                                     ///< Of the messages, as said.
  std::map<std::string, std::chrono::milliseconds> refused_at_;  ///< By meter, monotonic.
  std::shared_ptr<BrokerLink> link_;
  std::unique_ptr<BrokerState> state_;
  std::shared_ptr<RecordLink> fleet_;
  std::vector<std::unique_ptr<Forwarder>> forwarders_;
  Alive alive_;
};

}  // namespace recald::daemon
