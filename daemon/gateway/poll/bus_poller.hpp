/// Decides which device to ask next: the schedule of one bus, with all faults of its devices.
///
/// It has no sockets, threads or clock: it is given the time and the answers, and says what to do.
/// The live daemon, a replay and a test on a virtual clock all use it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adapters/modbus/register_map.hpp"
#include "adapters/ports/clock.hpp"
#include "core/random/rng.hpp"
#include "daemon/gateway/poll/learned_timeout.hpp"
#include "daemon/gateway/poll/poll_times.hpp"
#include "daemon/gateway/poll/unit_health.hpp"

namespace recald::daemon {

/// A meter on the bus.
struct PolledUnit {
  std::string meter;  ///< Its id.
  std::uint8_t unit = 1;
  /// Each poll makes all of them, but for those in the place of another. @pre not empty
  std::vector<modbus::PlannedRead> reads;
  std::chrono::milliseconds period{60'000};
  std::chrono::seconds interval{900};    ///< Each of its boundaries is polled as well.
  double phase = 0.0;                    ///< As in PollTimes.
  std::chrono::milliseconds timeout{0};  ///< Zero: learned.
};

struct BusRules {
  HealthRules health;
  std::chrono::milliseconds request_gap{0};  ///< Pause after each answer (gateways that need one).
  double probe_share = 0.05;                 ///< Largest share of the bus's time.
  std::chrono::milliseconds busy_wait{100};
  int busy_retries = 3;
  std::chrono::milliseconds reconnect_min{1'000};  ///< Doubles, jittered.
  std::chrono::milliseconds reconnect_max{60'000};
  std::chrono::milliseconds refused_min{
      10'000};  ///< Before a refused read is tried again; doubles.
  std::chrono::milliseconds refused_max{300'000};
};

/// One read to make.
struct BusOrder {
  std::size_t unit;  ///< Index into the units.
  std::size_t read;  ///< Index into the unit's reads.
  modbus::ReadRequest request;
  std::chrono::milliseconds timeout;
  WallTime due;
  bool is_probe;
  bool begins_poll = false;  ///< The first read of a poll: its delay is the poll's delay.
};

/// Longer waits are cut to this, because the wall clock may be set meanwhile.
inline constexpr std::chrono::milliseconds kLongestWait{1'000};

class BusPoller {
 public:
  BusPoller(std::vector<PolledUnit> units, const BusRules& rules, Rng rng);

  /// What to ask now. Nothing: an order is in progress, or nothing is due.
  ///
  /// Due units that answer come first, in order of their due times. Silent units wait until no
  /// answering unit falls due within their time-out, so 31 dead units of 32 do not delay the
  /// one that works. A poll that is late by more than a period is made once, for its latest
  /// due time. The unit that has waited longest comes first, so every unit is served even on
  /// an overloaded bus.
  [[nodiscard]] std::optional<BusOrder> next(const Moment& now);

  /// Time until `next` may return an order, at most kLongestWait. @pre no order is in progress
  [[nodiscard]] std::chrono::milliseconds wait(const Moment& now) const;

  /// Takes the order's outcome.
  ///
  /// - An answer, even an exception, shows that the unit works. Gateway exceptions
  ///   10 and 11 do not.
  /// - Busy (5, 6): the same read is repeated up to three times, 100 ms apart. A unit that is still
  ///   busy has not served that poll, and is degraded.
  /// - A refusal of a read that others can be made instead of: they are, from this poll on.
  /// - Any other exception is a refusal of that read: it is left out of the polls for 10 s, then
  ///   for twice as long, up to 5 minutes. A gateway that has just started returns "illegal
  ///   address" for registers that it has a moment later.
  /// - A silent unit loses the rest of its poll: one time-out per poll is enough.
  /// - No connection: the whole bus pauses for 1 s to 60 s.
  void answered(const BusOrder& order, const modbus::ReadResult& result,
                std::chrono::milliseconds duration, const Moment& now);

  /// Forgets everything about its units and the bus: misses, time-outs, refusals, pauses. All units
  /// are polled within a second, as at the start. The outcome of an order in progress is ignored.
  void begin_anew();

  [[nodiscard]] const std::vector<PolledUnit>& units() const { return units_; }
  /// A unit that answers but refuses a read, or is too busy to serve it, is degraded.
  [[nodiscard]] UnitState state(std::size_t unit) const;
  /// Polls that were skipped because the bus was busy with others.
  [[nodiscard]] std::uint64_t skipped(std::size_t unit) const { return states_[unit].skipped; }

 private:
  /// The refusal of one read.
  struct Refusal {
    std::chrono::milliseconds wait{0};  ///< Zero: not refused.
    std::chrono::milliseconds until{0};
    bool is_busy = false;   ///< The last poll found the unit busy throughout.
    bool is_split = false;  ///< Others are made instead.
  };
  struct UnitPolling {
    PollTimes times;
    UnitHealth health;
    LearnedTimeout timeout;
    std::vector<Refusal> refusals;     ///< By read.
    WallTime due{};                    ///< Of the poll in progress, else of the next one.
    WallTime since{};                  ///< First due time that was missed.
    std::vector<std::size_t> to_read;  ///< Remaining reads of the poll in progress, last first.
    bool is_asked = false;             ///< The poll in progress has made its first read.
    std::chrono::milliseconds not_before{0};
    int busy = 0;               ///< Busy answers to this read.
    bool has_answered = false;  ///< Ever.
    std::uint64_t skipped = 0;
  };

  [[nodiscard]] UnitPolling unknown(std::size_t unit) const;
  void notice_clock(const Moment& now);
  void begin_due_polls(const Moment& now);
  [[nodiscard]] bool is_reliable(const UnitPolling& polling) const;
  [[nodiscard]] bool fits_before_reliable(std::chrono::milliseconds timeout,
                                          const Moment& now) const;
  [[nodiscard]] bool was_patient(const Moment& now) const;
  [[nodiscard]] std::optional<std::size_t> choose(const Moment& now) const;
  [[nodiscard]] BusOrder order_for(std::size_t unit, bool is_probe, const Moment& now);
  [[nodiscard]] std::optional<BusOrder> probe(const Moment& now);
  void end_poll(std::size_t unit);
  [[nodiscard]] bool is_made(std::size_t unit, std::size_t read) const;
  bool split(const BusOrder& order, const modbus::ReadFailure& failure);
  void take_exception(const BusOrder& order, const modbus::ReadFailure& failure, const Moment& now);
  void take_silence(const BusOrder& order, const Moment& now);
  void rest(const Moment& now);

  std::vector<PolledUnit> units_;
  std::vector<UnitPolling> states_;
  BusRules rules_;
  Rng rng_;
  bool under_way_ = false;
  /// No unit was silent before its first answer: then a unit that was not asked yet need not wait
  /// for those that were, or a start would take long on a busy bus.
  bool all_have_answered_ = true;
  std::optional<std::chrono::milliseconds> wall_minus_monotonic_;
  std::chrono::milliseconds begun_{0};         ///< Monotonic, of the first call.
  std::chrono::milliseconds probing_{0};       ///< Bus time given to probes.
  std::chrono::milliseconds silent_asked_{0};  ///< Monotonic: when a silent unit last had its turn.
  std::chrono::milliseconds gap_until_{0};
  std::chrono::milliseconds rest_until_{0};
  std::chrono::milliseconds rest_length_{0};
  int lost_connections_ = 0;  ///< In a row.
};

}  // namespace recald::daemon
