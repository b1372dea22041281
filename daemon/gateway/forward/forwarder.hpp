/// Sends one destination what its outbox has, in order, and tries again until it is taken.
///
/// Sending happens on a worker of its own: no poll and no other destination waits for it.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/wakeup.hpp"
#include "adapters/ports/worker.hpp"
#include "daemon/gateway/forward/outbox/outbox.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"

namespace recald::daemon {

struct ForwardRules {
  std::chrono::milliseconds poll_every{2'000};
  std::chrono::milliseconds retry_min{5'000};  ///< After a failure; doubles.
  std::chrono::milliseconds retry_max{300'000};
  std::chrono::milliseconds asked_max{3'600'000};  ///< Waits as the other side asks, up to this.
  int batch = kOutboxBatch;
};

class Forwarder {
 public:
  Forwarder(Loop& loop, std::unique_ptr<Worker> worker, std::unique_ptr<Outbox> outbox,
            std::unique_ptr<Sink> sink, const ForwardRules& rules = {});
  /// Stops a batch that is being sent, and waits for it.
  ~Forwarder();
  Forwarder(const Forwarder&) = delete;
  Forwarder& operator=(const Forwarder&) = delete;

  /// Looks at the outbox within this time.
  void poll_within(std::chrono::milliseconds wait) { wakeup_.after(wait); }

  /// Ends what is being sent, soon. Nothing is sent after it.
  void stop() { stop_.request_stop(); }

  /// The other side has shown that it is there: ends the wait after a failure. During an attempt:
  /// if that fails, the next follows at once.
  void try_now();

  [[nodiscard]] const Destination& destination() const { return outbox_->destination(); }
  [[nodiscard]] DestinationStatus status() const;

 private:
  void poll();
  void send(OutgoingBatch batch);
  void finish(const OutgoingBatch& batch, const Sent& sent);
  [[nodiscard]] bool settle(const OutgoingBatch& batch, const Sent& sent);
  [[nodiscard]] bool set_aside(const OutgoingBatch& batch, const Sent& sent);
  void resend_all(const OutgoingBatch& batch, const Sent& sent);
  void wait_after(const Sent& sent);
  void report_success(const OutgoingBatch& batch);

  Loop& loop_;
  std::unique_ptr<Outbox> outbox_;
  std::shared_ptr<Sink> sink_;  ///< Shared with the work in progress.
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
