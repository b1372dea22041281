#include "adapters/sqlite/register_json.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace recald::sqlite {
namespace {

using metering::CounterBooking;
using metering::CounterState;
using metering::Instant;
using metering::RegisterSample;
using Json = nlohmann::json;

Json json_of(Instant t) { return t.time_since_epoch().count(); }
Instant instant_of(const Json& json) {
  return Instant{std::chrono::seconds{json.get<long long>()}};
}

// JSON has no infinity and no NaN; null is the one that the place can have.
double number_or(const Json& json, double absent) {
  return json.is_null() ? absent : json.get<double>();
}

Json json_of(const RegisterSample& sample) {
  return {{"time", json_of(sample.time)}, {"kWh", sample.value_kWh}};
}
RegisterSample sample_of(const Json& json) {
  return {instant_of(json.at("time")), json.at("kWh").get<double>()};
}

Json json_of(const CounterBooking& piece) {
  return {{"begin", json_of(piece.span.begin)},
          {"end", json_of(piece.span.end)},
          {"kWh", piece.energy_kWh},
          {"validity", to_string(piece.validity)},
          {"reasons", to_string(piece.reasons)}};
}
CounterBooking piece_of(const Json& json) {
  const auto validity = metering::parse_validity(json.at("validity").get<std::string>());
  const auto reasons = metering::parse_reasons(json.at("reasons").get<std::string>());
  if (!validity) throw std::invalid_argument(validity.error().message);
  if (!reasons) throw std::invalid_argument(reasons.error().message);
  return {{instant_of(json.at("begin")), instant_of(json.at("end"))},
          number_or(json.at("kWh"), std::numeric_limits<double>::quiet_NaN()),
          *validity,
          *reasons};
}

constexpr std::string_view kPhases[] = {"empty", "run", "low", "high"};

metering::CounterPhase phase_of(const Json& json) {
  const auto text = json.get<std::string>();
  for (std::size_t i = 0; i < std::size(kPhases); ++i) {
    if (kPhases[i] == text) return static_cast<metering::CounterPhase>(i);
  }
  throw std::invalid_argument("a counter has no phase '" + text + "'");
}

Json json_of(const CounterState& counter) {
  Json json{{"phase", kPhases[static_cast<std::size_t>(counter.phase)]},
            {"baseline", json_of(counter.baseline)}};
  if (counter.previous) {
    json["previous"] = {{"sample", json_of(counter.previous->sample)},
                        {"expires", json_of(counter.previous->expires)}};
  }
  if (counter.pending) {
    json["pending"] = {{"first", json_of(counter.pending->first)},
                       {"last", json_of(counter.pending->last)},
                       {"samples", counter.pending->samples}};
  }
  Json restarts = Json::array();
  for (const Instant t : counter.restarts) restarts.push_back(json_of(t));
  json["restarts"] = restarts;
  return json;
}

CounterState counter_of(const Json& json) {
  CounterState counter;
  counter.phase = phase_of(json.at("phase"));
  counter.baseline = sample_of(json.at("baseline"));
  if (json.contains("previous")) {
    const Json& previous = json.at("previous");
    counter.previous = {sample_of(previous.at("sample")), instant_of(previous.at("expires"))};
  }
  if (json.contains("pending")) {
    const Json& pending = json.at("pending");
    counter.pending = {sample_of(pending.at("first")), sample_of(pending.at("last")),
                       pending.at("samples").get<int>()};
  }
  for (const Json& t : json.at("restarts")) counter.restarts.push_back(instant_of(t));
  return counter;
}

Json json_of(const metering::PowerBook& power) {
  return {{"next", power.next ? json_of(*power.next) : Json{}},
          {"until", json_of(power.until)},
          {"kW", power.power_kW ? Json(*power.power_kW) : Json{}},
          {"kWh", power.energy_kWh},
          {"covered_s", power.covered.count()},
          {"hole_longest_s", power.hole_longest.count()},
          {"reasons", to_string(power.reasons)}};
}

metering::PowerBook power_of(const Json& json) {
  const auto reasons = metering::parse_reasons(json.at("reasons").get<std::string>());
  if (!reasons) throw std::invalid_argument(reasons.error().message);
  const auto seconds_of = [&](const char* key) {
    return std::chrono::seconds{json.at(key).get<long long>()};
  };
  metering::PowerBook power{.until = instant_of(json.at("until")),
                            .energy_kWh = json.at("kWh").get<double>(),
                            .covered = seconds_of("covered_s"),
                            .hole_longest = seconds_of("hole_longest_s"),
                            .reasons = *reasons};
  if (!json.at("next").is_null()) power.next = instant_of(json.at("next"));
  if (!json.at("kW").is_null()) power.power_kW = json.at("kW").get<double>();
  return power;
}

}  // namespace

std::string to_json(const RegisterState& state) {
  Json pieces = Json::array();
  for (const CounterBooking& piece : state.book.pieces) pieces.push_back(json_of(piece));
  Json json{{"field", state.field},
            {"identity", state.identity},
            {"counter", json_of(state.counter)},
            {"pieces", pieces},
            {"next", state.book.next ? json_of(*state.book.next) : Json{}},
            {"rated_kW", state.settings.rated_kW},
            {"resolution_kWh", state.settings.resolution_kWh},
            {"modulus_kWh", state.settings.modulus_kWh}};
  if (state.power.next) json["power"] = json_of(state.power);
  return json.dump();
}

Result<RegisterState> register_from_json(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    RegisterState state;
    state.field = json.at("field").get<std::string>();
    state.identity = json.at("identity").get<std::string>();
    state.counter = counter_of(json.at("counter"));
    for (const Json& piece : json.at("pieces")) state.book.pieces.push_back(piece_of(piece));
    if (!json.at("next").is_null()) state.book.next = instant_of(json.at("next"));
    state.settings = {json.at("rated_kW").get<double>(), json.at("resolution_kWh").get<double>(),
                      number_or(json.at("modulus_kWh"), std::numeric_limits<double>::infinity())};
    if (json.contains("power")) state.power = power_of(json.at("power"));
    return state;
  } catch (const std::exception& error) {
    return failure(ErrorCode::malformed,
                   fmt::format("the store's state of a register cannot be read: {}", error.what()));
  }
}

}  // namespace recald::sqlite
