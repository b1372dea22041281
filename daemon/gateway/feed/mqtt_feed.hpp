/// A meter in the messages of a broker. Its values count as registers: a counter in messages has
/// the same faults as one that is polled.
#pragma once

#include <memory>
#include <optional>

#include "daemon/gateway/feed/register_feed.hpp"
#include "daemon/gateway/ingest/meter_message.hpp"

namespace recald::daemon {

class MqttFeed final : public RegisterFeed {
 public:
  /// @return or the store's failure
  [[nodiscard]] static Result<std::unique_ptr<MqttFeed>> open(
      const MeterConfig& config, const metering::LocalCalendar& calendar, Store& store);

  /// The value as a read of its register; absent: the meter has no such value.
  [[nodiscard]] std::optional<PolledRead> read_of(const MeterValue& value, const Moment& now) const;

  /// Whether a value is not later than the last: a broker may deliver twice, and out of order.
  [[nodiscard]] bool is_late(const MeterValue& value, metering::Instant at) const;

  [[nodiscard]] MeterStatus status(metering::Instant now) const override;

 private:
  using RegisterFeed::RegisterFeed;
};

}  // namespace recald::daemon
