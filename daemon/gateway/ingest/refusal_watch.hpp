/// Registers that a device answers with an exception: since when, and the events about it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/modbus/register_map.hpp"
#include "adapters/ports/store.hpp"

namespace recald::daemon {

/// Registers that are requested together and currently answered with an exception.
struct RefusedRegisters {
  std::uint16_t address;  ///< On the wire: base 0.
  std::uint16_t count;
  std::uint8_t exception;
  metering::Instant since;

  bool operator==(const RefusedRegisters&) const = default;
};

/// "meter 'main' refuses registers 0 to 3 with exception 2 (illegal data address) since
/// 2024-03-01T12:00:00Z". Busy devices, and gateways that answer for a device, are
/// worded differently.
[[nodiscard]] std::string sentence_of(const std::string& meter, const RefusedRegisters& refused);

/// For one meter. A refusal of registers and their next answer are one event each; a device that
/// alternates at every poll causes at most one such pair per hour.
class RefusalWatch {
 public:
  explicit RefusalWatch(std::string meter) : meter_(std::move(meter)) {}

  /// A read that others can be made instead of is none that someone should look at: its refusal is
  /// one event, which says what to write into the map.
  ///
  /// Takes the outcome of one read. "Busy" answers, and a gateway's exceptions for a silent device,
  /// may be temporary: they become an event after five minutes without any other answer, once, and
  /// are counted after that.
  /// @return the event to report, if any.
  [[nodiscard]] std::optional<StoreEvent> take(const modbus::PlannedRead& read,
                                               const modbus::ReadResult& result,
                                               metering::Instant at);

  /// Refusals that someone should look at; of registers one after the other one.
  [[nodiscard]] std::vector<RefusedRegisters> refused() const;

 private:
  struct Read {
    std::optional<RefusedRegisters> refused;  ///< Since its last answer.
    bool is_lasting = false;                  ///< Someone should look at it.
    bool is_reported = false;                 ///< This refusal was reported.
    metering::Instant reported = metering::Instant::min();
  };

  [[nodiscard]] StoreEvent told_of_split(const modbus::PlannedRead& read,
                                         const modbus::ReadFailure& failure,
                                         metering::Instant at) const;
  /// @param reported  When it, or another part of the same read, was reported last.
  [[nodiscard]] std::optional<StoreEvent> refuse(Read& read, RefusedRegisters refused,
                                                 metering::Instant at,
                                                 metering::Instant& reported) const;
  [[nodiscard]] std::optional<StoreEvent> answer(Read& read, metering::Instant at) const;

  std::string meter_;
  std::map<std::pair<std::uint16_t, std::uint16_t>, Read> reads_;  ///< By address and count.
  std::map<std::size_t, metering::Instant> reported_of_parts_;     ///< By the read that was split.
};

}  // namespace recald::daemon
