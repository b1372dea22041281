/// Notifies people and programs outside of events: each destination of all of them, once, in order.
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "daemon/gateway/alert/alert_message.hpp"
#include "daemon/gateway/alert/alert_outbox.hpp"
#include "daemon/gateway/forward/forwarder.hpp"

namespace recald::daemon {

/// Sends a message; runs on a worker, and ends soon after a stop is requested.
using Deliver = std::function<Result<void>(const AlertDestination&, const AlertMessage&,
                                           const std::stop_token&)>;

/// How a mail or a webhook is named in the store and to people: "mail to operator@example.org",
/// "webhook at hooks.example.org".
[[nodiscard]] Destination destination_of(const AlertDestination& destination);

class Alerts {
 public:
  struct Ports {
    Loop& loop;
    EventStore& store;
    std::function<std::unique_ptr<Worker>()> make_worker;  ///< One for each destination.
  };
  using Notified = decltype(AlertMemory::notified);

  /// @param notify    Receives events about the deliveries themselves.
  /// @param notified  By an earlier object, whose store was another.
  Alerts(Ports ports, std::shared_ptr<const SiteConfig> site, metering::LocalCalendar calendar,
         Deliver deliver, Outbox::Notify notify, Notified notified = {});
  Alerts(const Alerts&) = delete;
  Alerts& operator=(const Alerts&) = delete;

  /// Call with each event when it happens, whether or not the store accepts it.
  void observe(const StoreEvent& event);

  /// Continues with another site file. Destinations that stay receive what is new to them; what is
  /// on its way is sent again.
  void set_site(std::shared_ptr<const SiteConfig> site);

  [[nodiscard]] Notified take_notified() { return std::move(memory_.notified); }

 private:
  Ports ports_;
  metering::LocalCalendar calendar_;
  Deliver deliver_;
  Outbox::Notify notify_;
  AlertMemory memory_;
  std::vector<std::unique_ptr<Forwarder>> forwarders_;
};

}  // namespace recald::daemon
