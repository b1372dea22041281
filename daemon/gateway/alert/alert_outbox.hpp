/// The alerts of one destination: events of the chosen kinds, each once.
///
/// The store is the outbox: a cursor over its events moves when a message was taken. Events that
/// the store refuses are sent from memory.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/ports/event_store.hpp"
#include "core/metering/civil_time.hpp"
#include "daemon/gateway/forward/outbox/outbox.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// What happens together is one message.
inline constexpr std::chrono::seconds kGatherAlerts{10};

struct NotifiedEvent {
  metering::Instant time;
  std::string kind;
  std::string subject;
};

/// What is known of alerts apart from the store, for all destinations.
struct AlertMemory {
  /// What may not be in the store yet, or not at all.
  struct Recent {
    StoreEvent event;
    std::chrono::milliseconds at;  ///< By the monotonic clock.
  };
  std::deque<Recent> recent = {};
  bool store_refuses = false;
  /// The next two by the destination's id. Ahead of the store's cursor where that refuses the
  /// write.
  std::map<std::string, std::int64_t> positions = {};
  std::map<std::string, std::deque<NotifiedEvent>> notified = {};  ///< What it has received.
};

class AlertOutbox final : public Outbox {
 public:
  /// @param store, memory  Outlive it.
  AlertOutbox(Loop& loop, EventStore& store, AlertMemory& memory, Destination destination,
              Notify notify, std::shared_ptr<const SiteConfig> site,
              metering::LocalCalendar calendar);

  [[nodiscard]] std::int64_t waiting() const override { return 0; }
  [[nodiscard]] Result<OutgoingBatch> next(int limit) override;
  [[nodiscard]] Result<void> move_past(const OutgoingBatch& batch) override;
  /// Keeps it back: if the destination then takes another, it was for what is in it.
  [[nodiscard]] Result<bool> set_aside(const OutgoingBatch& batch, const std::string& why) override;
  void on_failure(const std::string& why, bool is_first) override;
  void on_success(const OutgoingBatch& batch, bool is_first) override;

 private:
  /// What it has still to receive.
  struct Pending {
    std::vector<StoreEvent> events;
    std::optional<std::int64_t> position = {};  ///< Of the cursor where all of it was sent.
  };

  [[nodiscard]] Result<Pending> pending(metering::Instant now);
  [[nodiscard]] Result<std::int64_t> position(metering::Instant now);
  [[nodiscard]] Result<void> add_stored(metering::Instant now, Pending& pending);
  void add_unstored(metering::Instant now, Pending& pending) const;
  [[nodiscard]] bool is_alert(const StoreEvent& event, metering::Instant now) const;
  [[nodiscard]] bool was_notified(const StoreEvent& event) const;
  [[nodiscard]] bool waits_for_morning(const Pending& pending, metering::Instant now) const;
  void move(std::int64_t position);
  void remember(const std::vector<StoreEvent>& events);
  void report_refused();

  EventStore& store_;
  AlertMemory& memory_;
  std::shared_ptr<const SiteConfig> site_;
  metering::LocalCalendar calendar_;
  std::vector<StoreEvent> refused_;  ///< Kept back.
};

}  // namespace recald::daemon
