/// What waits for one destination: intervals, months, events and results for a broker, a database
/// or a fleet's record (StoreOutbox), events for a mail or a webhook (AlertOutbox).
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adapters/ports/loop.hpp"
#include "daemon/gateway/forward/outbox/sink.hpp"
#include "daemon/gateway/forward/outbox/store_history.hpp"

namespace recald::daemon {

/// Of what an outbox holds, sent at a time.
inline constexpr int kOutboxBatch = 500;

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

/// An id of an address, which may hold a secret: "mqtt 0123456789abcdef"
[[nodiscard]] std::string destination_id(std::string_view kind, const std::string& address);

class Outbox {
 public:
  using Notify = std::function<void(StoreEvent)>;

  Outbox(Loop& loop, Destination destination, Notify notify)
      : loop_(loop), destination_(std::move(destination)), notify_(std::move(notify)) {}
  virtual ~Outbox() = default;
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  [[nodiscard]] const Destination& destination() const { return destination_; }
  [[nodiscard]] virtual std::int64_t waiting() const = 0;

  /// @param limit  Of what it holds.
  /// @return what is sent next; empty: nothing. An error: it cannot be read now.
  [[nodiscard]] virtual Result<OutgoingBatch> next(int limit) = 0;

  /// It was taken. @return an error: that cannot be kept, so it is sent again.
  [[nodiscard]] virtual Result<void> move_past(const OutgoingBatch& batch) = 0;

  /// It was refused for what is in it: a single one, or a part that the destination chose.
  /// @return whether it is left out for good. If not, others are sent before it is decided. An
  /// error: it is sent again.
  [[nodiscard]] virtual Result<bool> set_aside(const OutgoingBatch& batch,
                                               const std::string& why) = 0;

  /// Whether the destination has what was never sent to it.
  [[nodiscard]] virtual bool is_beyond_us(const OutgoingBatch& /*batch*/,
                                          const Sent& /*sent*/) const {
    return false;
  }
  /// Begins anew with everything, as one side has what the other does not know of.
  [[nodiscard]] virtual Result<void> resend_all(const OutgoingBatch& /*batch*/,
                                                const Sent& /*sent*/) {
    return {};
  }

  /// @param is_first  After a success.
  virtual void on_failure(const std::string& why, bool is_first) = 0;
  /// @param is_first  After a failure.
  virtual void on_success(const OutgoingBatch& batch, bool is_first) = 0;

 protected:
  void report(Severity severity, std::string kind, std::string text) const;
  [[nodiscard]] Loop& loop() const { return loop_; }
  [[nodiscard]] const std::string& words() const { return destination_.words; }

 private:
  Loop& loop_;
  Destination destination_;
  Notify notify_;
};

}  // namespace recald::daemon
