/// Everything that is stored, in order, from a position that the store keeps for the destination.
///
/// The position moves when a batch was taken, so a batch may be sent twice and none is left out.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/forward/outbox/outbox.hpp"

namespace recald::daemon {

/// Entries that may wait; the oldest are left out first. They are still in the store.
inline constexpr std::int64_t kWaitingMax = 2'000'000;

class StoreOutbox final : public Outbox {
 public:
  struct Ports {
    Loop& loop;
    Store& store;
  };

  /// @pre the store keeps an outbox for the destination (Store::keep_outbox_for)
  StoreOutbox(Ports ports, Destination destination, Notify notify,
              std::int64_t waiting_max = kWaitingMax)
      : Outbox(ports.loop, std::move(destination), std::move(notify)),
        store_(ports.store),
        waiting_max_(waiting_max) {}

  [[nodiscard]] std::int64_t waiting() const override;
  [[nodiscard]] Result<OutgoingBatch> next(int limit) override;
  [[nodiscard]] Result<void> move_past(const OutgoingBatch& batch) override;
  [[nodiscard]] Result<bool> set_aside(const OutgoingBatch& batch, const std::string& why) override;
  [[nodiscard]] bool is_beyond_us(const OutgoingBatch& batch, const Sent& sent) const override;
  [[nodiscard]] Result<void> resend_all(const OutgoingBatch& batch, const Sent& sent) override;
  void on_failure(const std::string& why, bool is_first) override;
  void on_success(const OutgoingBatch& batch, bool is_first) override;

 private:
  [[nodiscard]] Result<OutgoingBatch> read(int limit);
  [[nodiscard]] Result<OutgoingBatch> next_history(int limit);
  [[nodiscard]] Result<OutboxPosition> position();
  [[nodiscard]] Result<std::int64_t> event_position();
  [[nodiscard]] Result<std::int64_t> result_position();
  [[nodiscard]] Result<void> add_events(OutgoingBatch& batch, int limit);
  [[nodiscard]] Result<void> add_results(OutgoingBatch& batch, int limit);
  [[nodiscard]] Result<std::int64_t> position_of(const std::string& cursor,
                                                 const std::function<Result<std::int64_t>()>& last);
  [[nodiscard]] Result<void> identify(OutgoingBatch& batch);
  void report_resend(const std::string& why) const;

  Store& store_;
  std::int64_t waiting_max_;
};

}  // namespace recald::daemon
