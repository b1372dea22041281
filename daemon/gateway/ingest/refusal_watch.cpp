#include "daemon/gateway/ingest/refusal_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adapters/modbus/frame.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;

constexpr std::chrono::hours kReportEvery{1};
/// Devices are busy now and then, and gateways miss some. Equals the longest wait between tries of
/// refused registers.
constexpr std::chrono::minutes kRefusalPatience{5};

/// How an exception is described when it lasts.
struct Kind {
  std::string_view event;
  std::string_view says;  ///< About the meter, before the registers.
  std::string_view advice;
  std::chrono::seconds patience;
};

Kind kind_of(std::uint8_t exception) {
  if (modbus::is_busy(exception)) {
    return {"device_busy", "has been busy at every request for",
            "recald asks again at every poll. If this goes on, poll less often, or find out who "
            "else polls the device",
            kRefusalPatience};
  }
  if (modbus::is_from_gateway(exception)) {
    return {"device_unreachable", "cannot be reached by its gateway, which answers requests for",
            "recald tries again, at least every probe_max. If this goes on, check the device's "
            "power, wiring and unit",
            kRefusalPatience};
  }
  return {"registers_refused", "refuses",
          "recald asks again, at least every five minutes. If this goes on, check unit and "
          "register map",
          std::chrono::seconds{0}};
}

}  // namespace

std::string sentence_of(const std::string& meter, const RefusedRegisters& refused) {
  return fmt::format(
      "meter '{}' {} registers {} to {} with exception {} since {}", meter,
      kind_of(refused.exception).says, refused.address, refused.address + refused.count - 1,
      modbus::describe_exception(refused.exception), metering::to_string(refused.since));
}

std::optional<StoreEvent> RefusalWatch::take(const modbus::PlannedRead& read,
                                             const modbus::ReadResult& result, Instant at) {
  Read& known = reads_[{read.address, read.count}];
  if (result) return answer(known, at);
  const modbus::ReadFailure& failure = result.error();
  if (failure.fault != modbus::ReadFault::exception) return {};
  if (read.may_split && modbus::is_illegal_span(failure)) return told_of_split(read, failure, at);
  Instant& reported =
      read.instead_of
          ? reported_of_parts_.try_emplace(*read.instead_of, Instant::min()).first->second
          : known.reported;
  return refuse(known, {read.address, read.count, failure.exception_code, at}, at, reported);
}

StoreEvent RefusalWatch::told_of_split(const modbus::PlannedRead& read,
                                       const modbus::ReadFailure& failure, Instant at) const {
  return {.time = at,
          .severity = Severity::info,
          .kind = "read_split",
          .subject = meter_,
          .text = fmt::format(
              "meter '{}' refuses to read registers {} to {} at once, with exception {}: they span "
              "some that it may not have, so its fields are read one by one from now on; gap_max = "
              "0 in its register map does so from the start",
              meter_, read.address, read.address + read.count - 1,
              modbus::describe_exception(failure.exception_code)),
          .is_counted = true};
}

std::optional<StoreEvent> RefusalWatch::refuse(Read& read, RefusedRegisters refused, Instant at,
                                               Instant& reported) const {
  if (read.refused) refused.since = read.refused->since;
  read.refused = refused;
  const Kind kind = kind_of(refused.exception);
  if (read.is_lasting || at - refused.since < kind.patience) return {};
  read.is_lasting = true;
  read.is_reported = reported == Instant::min() || at - reported >= kReportEvery;
  if (!read.is_reported) return {};
  reported = at;
  return StoreEvent{.time = at,
                    .severity = Severity::warning,
                    .kind = std::string{kind.event},
                    .subject = meter_,
                    .text = fmt::format("{}; {}", sentence_of(meter_, refused), kind.advice),
                    .is_counted = kind.patience > std::chrono::seconds{0}};
}

std::optional<StoreEvent> RefusalWatch::answer(Read& read, Instant at) const {
  const auto was_refused = std::exchange(read.refused, std::nullopt);
  read.is_lasting = false;
  if (!was_refused || !std::exchange(read.is_reported, false)) return {};
  return StoreEvent{
      at, Severity::info, "registers_answer", meter_,
      fmt::format("meter '{}' answers again for registers {} to {}, for the first time since {}",
                  meter_, was_refused->address, was_refused->address + was_refused->count - 1,
                  metering::to_string(was_refused->since))};
}

std::vector<RefusedRegisters> RefusalWatch::refused() const {
  std::vector<RefusedRegisters> all;
  for (const auto& [address, read] : reads_) {
    if (!read.is_lasting) continue;
    const RefusedRegisters& one = *read.refused;
    // Fields that are read one by one may all be refused, as one read was before.
    const bool goes_on = !all.empty() && all.back().address + all.back().count == one.address &&
                         all.back().exception == one.exception;
    if (!goes_on) {
      all.push_back(one);
      continue;
    }
    all.back().count = static_cast<std::uint16_t>(all.back().count + one.count);
    all.back().since = std::min(all.back().since, one.since);
  }
  return all;
}

}  // namespace recald::daemon
