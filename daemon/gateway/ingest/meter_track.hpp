/// One live meter: turns the contents of its registers into what is stored.
///
/// It does not know the bus or the store. It takes the outcome of each read and returns what
/// must be committed together: intervals, the state they were computed from, samples worth
/// keeping, events.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adapters/modbus/register_map.hpp"
#include "adapters/ports/store.hpp"
#include "core/metering/months/usual_day.hpp"
#include "daemon/gateway/ingest/absent_watch.hpp"
#include "daemon/gateway/ingest/power_watch.hpp"
#include "daemon/gateway/ingest/refusal_watch.hpp"

namespace recald::daemon {

struct TrackedMeter {
  std::uint32_t number = 0;  ///< In the store.
  std::string id;
  /// Its `energy`, `power` and `identity` are read. Without `energy`, intervals are
  /// means of the power.
  modbus::RegisterMap map;
  double multiplier = 1.0;  ///< Ratio of a current transformer that the meter does not apply.
  metering::CounterSettings counter;  ///< Resolution 0 and modulus infinite: taken from the map.
  metering::BookingRules booking;
};

/// The meter's current values.
struct LiveValues {
  std::optional<double> power_kW;
  std::optional<double> register_kWh;
  std::optional<metering::Instant> read_at;  ///< Time of the last good read.
  /// Of the last value that its intervals are made of: a meter may answer and say nothing.
  std::optional<metering::Instant> measured_at = {};
};

class MeterTrack {
 public:
  /// @param restored  The stored state; nothing for a new meter.
  MeterTrack(TrackedMeter meter, const metering::LocalCalendar& calendar,
             const std::optional<RegisterState>& restored);

  /// Adds a stored interval to the usual day, as after a restart.
  void remember(const metering::Reading& reading) { usual_.observe(reading); }

  /// Takes the outcome of one read, planned over `modbus::metered_fields`.
  /// @param poll  Identifies the poll: its due time. Registers that are summed must
  ///              be from one poll.
  [[nodiscard]] StoreBatch take(const modbus::PlannedRead& read, const modbus::ReadResult& result,
                                std::chrono::sys_time<std::chrono::milliseconds> poll,
                                metering::Instant at);

  /// Takes a counter sample from the time without a store. Call in order of time.
  [[nodiscard]] StoreBatch take_kept(const metering::RegisterSample& sample);

  /// The clock was set, so what the register counted meanwhile belongs to no interval.
  void clock_was_set();

  [[nodiscard]] const TrackedMeter& meter() const { return meter_; }
  [[nodiscard]] const LiveValues& live() const { return live_; }
  [[nodiscard]] std::vector<RefusedRegisters> refused() const { return refusals_.refused(); }
  [[nodiscard]] const RegisterState& state() const { return state_; }
  /// When the last value was measured that its intervals are made of; nothing: there was none yet.
  [[nodiscard]] std::optional<metering::Instant> last_sample() const;

 private:
  struct FieldReading {
    double value;  ///< In the field's unit, scaled.
    double resolution;
    double power_of_ten;  ///< From its scale factor; 1 without one.
    std::chrono::sys_time<std::chrono::milliseconds> poll;
  };

  /// The value of a field, unless it is a counter's that is not believed.
  [[nodiscard]] tl::expected<modbus::DecodedValue, modbus::ValueFault> believed_value(
      const modbus::FieldValue& found, metering::Instant at);
  void note_failure(const modbus::ReadFailure& failure);
  void note_fault(const modbus::RegisterField& field, modbus::ValueFault fault);
  void update_power();
  void take_identity(StoreBatch& batch, std::chrono::sys_time<std::chrono::milliseconds> poll,
                     metering::Instant at);
  void take_energy(StoreBatch& batch, std::chrono::sys_time<std::chrono::milliseconds> poll,
                   metering::Instant at);
  void begin_anew(metering::Instant now);
  bool relive_from(metering::Instant now, std::optional<metering::Instant> next);
  [[nodiscard]] bool is_relived(const metering::Reading& reading) const;
  void take_sample(StoreBatch& batch, const metering::RegisterSample& sample);
  /// The power in this read, if it has one.
  [[nodiscard]] std::optional<double> new_power_kW(const modbus::PlannedRead& read) const;
  void take_power(StoreBatch& batch, double power_kW, metering::Instant at);
  [[nodiscard]] StoreEvent event_of(metering::CounterEvent event,
                                    const metering::RegisterSample& sample,
                                    const metering::CounterState& before) const;
  [[nodiscard]] bool is_worth_keeping(const metering::RegisterSample& sample) const;

  TrackedMeter meter_;  ///< Its map has only the fields that are read.
  metering::ResetTimes resets_;
  metering::UsualDay usual_;
  RegisterState state_;
  LiveValues live_;
  std::map<std::string, FieldReading> latest_;
  RefusalWatch refusals_;
  AbsentWatch absent_;
  std::optional<PowerWatch> watch_;  ///< Set if the meter has both a counter and a power.
  metering::Reason since_sample_ = metering::Reason::none;  ///< Why reads have failed since then.
  bool clock_was_set_ = false;
  metering::Instant relived_until_ = metering::Instant::min();  ///< Stamps before a clock set back.
  metering::Instant power_kept_{};  ///< When the open interval of the power was last stored.
  std::optional<std::string> other_identity_;  ///< Read once, not confirmed yet.
};

}  // namespace recald::daemon
