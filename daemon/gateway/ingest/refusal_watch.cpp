#include "daemon/gateway/ingest/refusal_watch.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/modbus/frame.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;

constexpr std::chrono::hours kToldEvery{1};

}  // namespace

std::string to_string(const RefusedRegisters& refused) {
  return fmt::format("registers {} to {} with exception {} since {}", refused.address,
                     refused.address + refused.count - 1,
                     modbus::describe_exception(refused.exception),
                     metering::to_string(refused.since));
}

std::optional<StoreEvent> RefusalWatch::take(const modbus::PlannedRead& read,
                                             const modbus::ReadResult& result, Instant at) {
  Read& known = reads_[read.address];
  if (result) return answer(known, at);
  const modbus::ReadFailure& failure = result.error();
  if (!modbus::is_refusal(failure)) return {};
  return refuse(known, {read.address, read.count, failure.exception_code, at}, at);
}

std::optional<StoreEvent> RefusalWatch::refuse(Read& read, const RefusedRegisters& refused,
                                               Instant at) const {
  if (read.refused) return {};
  read.refused = refused;
  read.is_told = read.told == Instant::min() || at - read.told >= kToldEvery;
  if (!read.is_told) return {};
  read.told = at;
  return StoreEvent{at, Severity::warning, "registers_refused", meter_,
                    fmt::format("meter '{}' refuses {}; they are asked for again, at least every "
                                "five minutes. If it goes on, check unit and register map",
                                meter_, to_string(refused))};
}

std::optional<StoreEvent> RefusalWatch::answer(Read& read, Instant at) const {
  const auto was_refused = std::exchange(read.refused, std::nullopt);
  if (!was_refused || !std::exchange(read.is_told, false)) return {};
  return StoreEvent{
      at, Severity::info, "registers_answer", meter_,
      fmt::format("meter '{}' answers again for registers {} to {}, which it refused "
                  "since {}",
                  meter_, was_refused->address, was_refused->address + was_refused->count - 1,
                  metering::to_string(was_refused->since))};
}

std::vector<RefusedRegisters> RefusalWatch::refused() const {
  std::vector<RefusedRegisters> all;
  for (const auto& [address, read] : reads_) {
    if (read.refused) all.push_back(*read.refused);
  }
  return all;
}

}  // namespace recald::daemon
