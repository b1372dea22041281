#include "daemon/gateway/ingest/meter_message.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "adapters/csv/fields.hpp"
#include "daemon/gateway/ingest/json_depth.hpp"
#include "daemon/gateway/ingest/sent_values.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using nlohmann::json;
using std::chrono::seconds;

constexpr int kMessageDepthMax = 32;
/// Seconds since 1970 up to 2286; more are milliseconds.
constexpr double kSecondsMax = 1e10;

std::optional<double> number_in(std::string_view text) {
  while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
  return csv::parse_number(csv::trimmed(text));
}

/// The part of a document under a pointer; null where there is none.
const json* part_at(const json& document, const std::string& pointer) {
  // A pointer that the document does not have is no fault: a topic may carry several messages.
  try {
    const json::json_pointer path{pointer};
    return document.contains(path) ? &document.at(path) : nullptr;
  } catch (const json::exception&) {
    return nullptr;
  }
}

/// A number, or a text that is one: many devices quote their numbers.
std::optional<double> number_of(const json& part) {
  if (part.is_number()) return part.get<double>();
  return part.is_string() ? number_in(part.get_ref<const std::string&>()) : std::nullopt;
}

std::optional<Instant> time_of(const json& part) {
  if (const auto number = number_of(part)) {
    const double since_1970 = *number > kSecondsMax ? *number / 1000.0 : *number;
    if (!(since_1970 > 0.0 && since_1970 < kSecondsMax)) return {};
    return Instant{seconds{static_cast<std::int64_t>(since_1970)}};
  }
  if (!part.is_string()) return {};
  const auto stamp = csv::parse_timestamp(part.get_ref<const std::string&>());
  return stamp ? std::optional{*stamp} : std::nullopt;
}

/// One message, parsed when the first pointer needs it.
class Message {
 public:
  Message(std::string_view payload, bool is_retained, Instant now)
      : payload_(payload), is_retained_(is_retained), now_(now) {}

  /// @return nothing where the message does not have the value; or why it cannot be taken.
  [[nodiscard]] Result<std::optional<MeterValue>> read(const MqttValue& wanted) {
    std::optional<double> number;
    if (wanted.pointer.empty() && wanted.time_pointer.empty()) {
      number = number_in(payload_);
      if (!number) return refused(wanted, "is no number");
    }
    if (!number && !parse()) return refused(wanted, "is no JSON");
    if (!number) {
      const json* const part = part_at(document_, wanted.pointer);
      if (part == nullptr || part->is_null()) return std::optional<MeterValue>{};
      number = number_of(*part);
      if (!number) return refused(wanted, "is no number");
    }
    if (!(std::abs(*number) <= kSentValueMax))
      return refused(wanted, "is more than any meter counts");
    std::optional<Instant> measured;
    if (!wanted.time_pointer.empty()) {
      const json* const part = part_at(document_, wanted.time_pointer);
      measured = part == nullptr ? std::nullopt : time_of(*part);
      if (!measured) return refused(wanted, "has no time under '" + wanted.time_pointer + "'");
      if (*measured < now_ - kSentOldest || *measured > now_ + kClocksDiffer) {
        return refused(wanted, "is stamped " + metering::to_string(*measured) +
                                   ", but the clock says " + metering::to_string(now_));
      }
    } else if (is_retained_) {
      return std::optional<MeterValue>{};
    }
    return std::optional{MeterValue{
        .meter = {}, .is_counter = false, .value = *number * wanted.factor, .measured = measured}};
  }

 private:
  bool parse() {
    if (is_parsed_) return !document_.is_discarded();
    is_parsed_ = true;
    document_ = is_nested_deeper(payload_, kMessageDepthMax)
                    ? json(json::value_t::discarded)
                    : json::parse(payload_, nullptr, false);
    return !document_.is_discarded();
  }

  [[nodiscard]] tl::unexpected<Error> refused(const MqttValue& wanted,
                                              const std::string& what) const {
    const std::string place =
        wanted.pointer.empty() ? "" : fmt::format(" under '{}'", wanted.pointer);
    return failure(ErrorCode::invalid_value,
                   fmt::format("the message {} of '{}' {}{}",
                               csv::in_quotes(payload_.substr(0, 80)), wanted.topic, what, place));
  }

  std::string_view payload_;
  bool is_retained_;
  Instant now_;
  bool is_parsed_ = false;
  json document_;
};

}  // namespace

MeterMessage parse_meter_message(const SiteConfig& site, std::string_view topic,
                                 std::string_view payload, bool is_retained, Instant now) {
  MeterMessage parsed;
  Message message{payload, is_retained, now};
  for (const MeterConfig& meter : site.meters) {
    if (!meter.mqtt) continue;
    for (const bool is_counter : {true, false}) {
      const auto& wanted = is_counter ? meter.mqtt->energy : meter.mqtt->power;
      if (!wanted || wanted->topic != topic) continue;
      auto value = message.read(*wanted);
      if (!value) {
        parsed.refusals.push_back({meter.meter.id, std::move(value.error().message)});
      } else if (*value) {
        (*value)->meter = meter.meter.id;
        (*value)->is_counter = is_counter;
        parsed.values.push_back(std::move(**value));
      }
    }
  }
  return parsed;
}

std::vector<std::string> meter_topics(const SiteConfig& site) {
  std::set<std::string> topics;
  for (const MeterConfig& meter : site.meters) {
    if (!meter.mqtt) continue;
    if (meter.mqtt->energy) topics.insert(meter.mqtt->energy->topic);
    if (meter.mqtt->power) topics.insert(meter.mqtt->power->topic);
  }
  return {topics.begin(), topics.end()};
}

}  // namespace recald::daemon
