/// Notifies people and programs outside of events: each destination of all of them, once, in order.
///
/// The store is the outbox: a destination has a cursor over its events, which moves when a message
/// was taken. Events that the store refuses are sent from memory. Deliveries run on a
/// worker of their own, so that no poll waits for a mail server.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/event_store.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/wakeup.hpp"
#include "adapters/ports/worker.hpp"
#include "daemon/gateway/alert/alert_message.hpp"

namespace recald::daemon {

struct AlertRules {
  std::chrono::milliseconds gather{10'000};      ///< What happens together is one message.
  std::chrono::milliseconds poll_every{60'000};  ///< For the end of quiet hours.
  std::chrono::milliseconds retry_min{60'000};   ///< After a failure; doubles.
  std::chrono::milliseconds retry_max{3'600'000};
  std::chrono::hours forget{72};  ///< Older events are not sent any more.
  int events = 500;               ///< In one message at most; read at a time.
};

/// Sends a message; runs on the worker, and ends soon after a stop is requested.
using Deliver = std::function<Result<void>(const AlertDestination&, const AlertMessage&,
                                           const std::stop_token&)>;

/// The name under which a destination's cursor is stored. An address may hold a secret, so it is
/// not part of the name as it is.
[[nodiscard]] std::string cursor_name(const AlertDestination& destination);

/// "mail to operator@example.org", "webhook at hooks.example.org"
[[nodiscard]] std::string destination_words(const AlertDestination& destination);

class Alerts {
 public:
  struct Ports {
    Loop& loop;
    EventStore& store;
    Worker& worker;  ///< For this object alone.
  };

  /// What a destination has received, by the name of its cursor.
  struct NotifiedEvent {
    metering::Instant time;
    std::string kind;
    std::string subject;
  };
  using Notified = std::map<std::string, std::deque<NotifiedEvent>>;

  /// @param notify    Receives events about the deliveries themselves.
  /// @param notified  By an earlier object, whose store was another.
  Alerts(Ports ports, std::shared_ptr<const SiteConfig> site, metering::LocalCalendar calendar,
         Deliver deliver, std::function<void(StoreEvent)> notify, Notified notified = {},
         const AlertRules& rules = {});
  /// Stops the worker's delivery early.
  ~Alerts();
  Alerts(const Alerts&) = delete;
  Alerts& operator=(const Alerts&) = delete;

  /// Sends what an earlier process could not.
  void start();

  /// Call with each event when it happens, whether or not the store accepts it.
  void observe(const StoreEvent& event);

  /// Continues with another site file. Destinations that stay receive what is new to them.
  void set_site(std::shared_ptr<const SiteConfig> site);

  [[nodiscard]] Notified take_notified() { return std::move(notified_); }

 private:
  struct Outgoing {
    AlertDestination destination;
    std::string cursor;                       ///< Its name.
    std::optional<std::int64_t> position;     ///< Ahead of the store's if that refuses the write.
    std::chrono::milliseconds not_before{0};  ///< By the monotonic clock.
    std::chrono::milliseconds wait{0};        ///< Before the next try; 0: the last one succeeded.
    int events_max = 0;                       ///< In the next message; halves where it is refused.
    /// Refused alone. If it then takes another message, it was for what is in them.
    std::vector<StoreEvent> refused = {};
    std::string refusal = {};  ///< Why, of the last one.
  };
  /// What a destination has still to receive.
  struct Pending {
    std::vector<StoreEvent> events;
    std::optional<std::int64_t> position = {};  ///< Of the cursor once they are sent, if it moves.
  };

  void poll_after(std::chrono::milliseconds wait);
  void poll();
  [[nodiscard]] Result<Pending> pending_for(Outgoing& outgoing, const Moment& now);
  [[nodiscard]] Result<std::int64_t> position_of(Outgoing& outgoing, metering::Instant now);
  [[nodiscard]] Result<void> add_stored(Outgoing& outgoing, const Moment& now, Pending& pending);
  void add_unstored(const Outgoing& outgoing, const Moment& now, Pending& pending) const;
  [[nodiscard]] bool is_alert(const StoreEvent& event, metering::Instant now) const;
  [[nodiscard]] bool was_notified(const Outgoing& outgoing, const StoreEvent& event) const;
  [[nodiscard]] bool waits_for_morning(const Pending& pending, metering::Instant now) const;
  void move(Outgoing& outgoing, std::optional<std::int64_t> position);
  void send(const Outgoing& outgoing, Pending pending, metering::Instant now);
  void finish(const std::string& cursor, const Pending& pending, const Result<void>& sent);
  void finish_failed(Outgoing& outgoing, const Pending& pending, const Error& why);
  void finish_sent(Outgoing& outgoing, const Pending& pending);
  void set_aside_refused(Outgoing& outgoing);
  void remember(const Outgoing& outgoing, const std::vector<StoreEvent>& events);

  Ports ports_;
  std::shared_ptr<const SiteConfig> site_;
  metering::LocalCalendar calendar_;
  Deliver deliver_;
  std::function<void(StoreEvent)> notify_;
  AlertRules rules_;
  std::vector<Outgoing> outgoing_;
  Notified notified_;
  /// What may not be in the store yet, or not at all.
  struct Recent {
    StoreEvent event;
    std::chrono::milliseconds at;  ///< By the monotonic clock.
  };
  std::deque<Recent> recent_;
  bool store_refuses_ = false;
  bool is_sending_ = false;
  Wakeup wakeup_;
  std::stop_source stop_;
  Alive alive_;
};

}  // namespace recald::daemon
