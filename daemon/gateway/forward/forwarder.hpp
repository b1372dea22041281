/// Sends one destination everything that the store's outbox has for it, in order.
///
/// Its position moves when a batch was taken, so a batch may be sent twice and none is left out.
/// Sending happens on a worker of its own: no poll and no other destination waits for it.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "adapters/ports/wakeup.hpp"
#include "adapters/ports/worker.hpp"
#include "daemon/gateway/forward/sink.hpp"
#include "daemon/gateway/forward/store_history.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"

namespace recald::daemon {

struct ForwardRules {
  std::chrono::milliseconds poll_every{2'000};
  std::chrono::milliseconds retry_min{5'000};  ///< After a failure; doubles.
  std::chrono::milliseconds retry_max{300'000};
  std::chrono::milliseconds asked_max{3'600'000};  ///< Waits as the other side asks, up to this.
  int batch = 500;                                 ///< Entries and events at a time.
  /// Entries that may wait; the oldest are left out first. They are still in the store.
  std::int64_t waiting_max = 2'000'000;
};

/// Where to.
struct Destination {
  std::string id;     ///< In the store; never changes, and has no secret in it.
  std::string words;  ///< For people: "Prometheus at metrics.example.org".
  bool wants_events = false;
  bool wants_results = false;
  bool has_identity = false;  ///< It remembers positions (outbox_identity).
  /// Whose past it receives first, before what the outbox has.
  std::vector<MeterInStore> history = {};
};

class Forwarder {
 public:
  struct Ports {
    Loop& loop;
    Store& store;
  };
  using Notify = std::function<void(StoreEvent)>;

  /// @pre the store keeps an outbox for the destination (Store::keep_outbox_for)
  Forwarder(Ports ports, std::unique_ptr<Worker> worker, Destination destination,
            std::unique_ptr<Sink> sink, Notify notify, const ForwardRules& rules = {});
  /// Stops a batch that is being sent, and waits for it.
  ~Forwarder();
  Forwarder(const Forwarder&) = delete;
  Forwarder& operator=(const Forwarder&) = delete;

  void start() { wakeup_.after(std::chrono::milliseconds{0}); }

  /// The other side has shown that it is there: ends the wait after a failure. During an attempt:
  /// if that fails, the next follows at once.
  void try_now();

  [[nodiscard]] const Destination& destination() const { return destination_; }
  [[nodiscard]] DestinationStatus status() const;

 private:
  void poll();
  [[nodiscard]] Result<OutgoingBatch> next();
  [[nodiscard]] Result<OutgoingBatch> next_history();
  [[nodiscard]] Result<OutboxPosition> position();
  [[nodiscard]] Result<std::int64_t> event_position();
  [[nodiscard]] Result<std::int64_t> result_position();
  [[nodiscard]] Result<void> add_events(OutgoingBatch& batch);
  [[nodiscard]] Result<void> add_results(OutgoingBatch& batch);
  [[nodiscard]] int room_in(const OutgoingBatch& batch) const {
    return std::max(batch_ - static_cast<int>(batch.size()), 0);
  }
  [[nodiscard]] Result<std::int64_t> position_of(const std::string& cursor,
                                                 const std::function<Result<std::int64_t>()>& last);
  void send(OutgoingBatch batch);
  void finish(const OutgoingBatch& batch, const Sent& sent);
  [[nodiscard]] Result<void> identify(OutgoingBatch& batch);
  [[nodiscard]] bool move_past(const OutgoingBatch& batch);
  [[nodiscard]] bool is_beyond_us(const OutgoingBatch& batch, const Sent& sent) const;
  void resend_all(const OutgoingBatch& batch, const Sent& sent);
  void report_resend(const std::string& why);
  [[nodiscard]] bool set_aside(const OutgoingBatch& batch, const std::string& why);
  void wait_after(const Sent& sent);
  void report_success();

  Ports ports_;
  Destination destination_;
  std::shared_ptr<Sink> sink_;  ///< Shared with the work in progress.
  Notify notify_;
  ForwardRules rules_;
  int batch_;  ///< Entries at a time now: fewer after a refusal, to find what is refused.
  std::chrono::milliseconds wait_{0};  ///< After the last failure; zero: it did not fail.
  std::optional<std::chrono::milliseconds> anew_at_;  ///< When the last resend of everything began.
  std::chrono::milliseconds anew_wait_{0};            ///< Before the next time, if that is soon.
  std::chrono::milliseconds not_before_{0};
  std::string why_;
  std::optional<metering::Instant> sent_at_;
  bool is_sending_ = false;
  bool is_asked_ = false;  ///< try_now() during the attempt.
  Wakeup wakeup_;
  std::stop_source stop_;
  Alive alive_;
  std::unique_ptr<Worker> worker_;  ///< Last: its work must end before the members it uses.
};

}  // namespace recald::daemon
