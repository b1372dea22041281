#include "adapters/sqlite/tables/register_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/absent.hpp"

namespace recald::sqlite {
namespace {

using metering::CounterBooking;
using metering::CounterState;
using metering::Instant;
using metering::RegisterSample;
using Json = nlohmann::json;

Instant instant_of(const Json& json) {
  return Instant{std::chrono::seconds{json.get<long long>()}};
}

// JSON has no infinity and no NaN; null stands for the one that can occur in this place.
double number_or(const Json& json, double absent) {
  return json.is_null() ? absent : json.get<double>();
}

RegisterSample sample_of(const Json& json) {
  return {instant_of(json.at("time")), json.at("kWh").get<double>()};
}

CounterBooking piece_of(const Json& json) {
  const auto validity = metering::parse_validity(json.at("validity").get<std::string>());
  const auto reasons = metering::parse_reasons(json.at("reasons").get<std::string>());
  if (!validity) throw std::invalid_argument(validity.error().message);
  if (!reasons) throw std::invalid_argument(reasons.error().message);
  return {{instant_of(json.at("begin")), instant_of(json.at("end"))},
          number_or(json.at("kWh"), kAbsent),
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

metering::FallRun falls_of(const Json& json) {
  return {.before = sample_of(json.at("before")),
          .last = sample_of(json.at("last")),
          .samples = json.at("samples").get<int>(),
          .falls = json.at("falls").get<int>(),
          .deep = json.at("deep").get<int>(),
          .cubes_kWh3 = number_or(json.at("cubes"), 0.0),
          .sixths_kWh6 = number_or(json.at("sixths"), 0.0),
          .is_no_total = json.at("is_no_total").get<bool>()};
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
  if (json.contains("falls")) counter.falls = falls_of(json.at("falls"));
  if (json.contains("stands_since")) counter.stands_since = instant_of(json.at("stands_since"));
  return counter;
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

/// Writes JSON as text, since this runs after each interval and building a tree would take
/// most of a commit.
class Writer {
 public:
  [[nodiscard]] std::string text() && { return fmt::to_string(out_); }

  Writer& raw(std::string_view text) {
    out_.append(text);
    return *this;
  }
  Writer& number(double value) {
    if (!std::isfinite(value)) return raw("null");
    fmt::format_to(std::back_inserter(out_), "{}", value);
    return *this;
  }
  Writer& whole(std::int64_t value) {
    fmt::format_to(std::back_inserter(out_), "{}", value);
    return *this;
  }
  Writer& time(Instant t) { return whole(t.time_since_epoch().count()); }
  Writer& time_or_null(const std::optional<Instant>& t) { return t ? time(*t) : raw("null"); }
  /// For known letters only; other text goes through `Json`.
  Writer& word(std::string_view text) { return raw("\"").raw(text).raw("\""); }
  Writer& text(const std::string& any) {
    const auto needs_care = [](char c) { return c < ' ' || c > '~' || c == '"' || c == '\\'; };
    if (std::ranges::none_of(any, needs_care)) return word(any);
    return raw(Json(any).dump(-1, ' ', false, Json::error_handler_t::replace));
  }

  Writer& sample(const RegisterSample& sample) {
    return raw("{\"kWh\":").number(sample.value_kWh).raw(",\"time\":").time(sample.time).raw("}");
  }
  Writer& piece(const CounterBooking& piece) {
    return raw("{\"begin\":")
        .time(piece.span.begin)
        .raw(",\"end\":")
        .time(piece.span.end)
        .raw(",\"kWh\":")
        .number(piece.energy_kWh)
        .raw(",\"reasons\":")
        .word(to_string(piece.reasons))
        .raw(",\"validity\":")
        .word(to_string(piece.validity))
        .raw("}");
  }
  Writer& falls(const metering::FallRun& run) {
    raw("{\"before\":").sample(run.before);
    raw(",\"cubes\":").number(run.cubes_kWh3).raw(",\"deep\":").whole(run.deep);
    raw(",\"falls\":").whole(run.falls);
    raw(",\"is_no_total\":").raw(run.is_no_total ? "true" : "false");
    raw(",\"last\":").sample(run.last).raw(",\"samples\":").whole(run.samples);
    return raw(",\"sixths\":").number(run.sixths_kWh6).raw("}");
  }
  Writer& counter(const CounterState& counter) {
    raw("{\"baseline\":").sample(counter.baseline);
    if (counter.falls) raw(",\"falls\":").falls(*counter.falls);
    if (counter.pending) {
      raw(",\"pending\":{\"first\":").sample(counter.pending->first);
      raw(",\"last\":").sample(counter.pending->last);
      raw(",\"samples\":").whole(counter.pending->samples).raw("}");
    }
    raw(",\"phase\":").word(kPhases[static_cast<std::size_t>(counter.phase)]);
    if (counter.previous) {
      raw(",\"previous\":{\"expires\":").time(counter.previous->expires);
      raw(",\"sample\":").sample(counter.previous->sample).raw("}");
    }
    raw(",\"restarts\":[");
    for (std::size_t i = 0; i < counter.restarts.size(); ++i) {
      raw(i > 0 ? "," : "").time(counter.restarts[i]);
    }
    raw("]");
    if (counter.stands_since) raw(",\"stands_since\":").time(*counter.stands_since);
    return raw("}");
  }
  Writer& power(const metering::PowerBook& power) {
    raw("{\"covered_s\":").whole(power.covered.count());
    raw(",\"hole_longest_s\":").whole(power.hole_longest.count());
    raw(",\"kW\":").number(power.power_kW.value_or(kAbsent));
    raw(",\"kWh\":").number(power.energy_kWh);
    raw(",\"next\":").time_or_null(power.next);
    raw(",\"reasons\":").word(to_string(power.reasons));
    return raw(",\"until\":").time(power.until).raw("}");
  }

 private:
  fmt::memory_buffer out_;
};

}  // namespace

std::string to_json(const RegisterState& state) {
  Writer json;
  json.raw("{\"counter\":").counter(state.counter);
  json.raw(",\"field\":").text(state.field);
  json.raw(",\"identity\":").text(state.identity);
  json.raw(",\"modulus_kWh\":").number(state.settings.modulus_kWh);
  json.raw(",\"next\":").time_or_null(state.book.next);
  json.raw(",\"pieces\":[");
  for (std::size_t i = 0; i < state.book.pieces.size(); ++i) {
    json.raw(i > 0 ? "," : "").piece(state.book.pieces[i]);
  }
  json.raw("]");
  if (state.power.next) json.raw(",\"power\":").power(state.power);
  json.raw(",\"rated_kW\":").number(state.settings.rated_kW);
  json.raw(",\"resolution_kWh\":").number(state.settings.resolution_kWh);
  if (state.settings.runs_back) json.raw(",\"runs_back\":true");
  json.raw("}");
  return std::move(json).text();
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
    state.settings.runs_back = json.contains("runs_back");
    if (json.contains("power")) state.power = power_of(json.at("power"));
    return state;
  } catch (const std::exception& error) {
    return failure(ErrorCode::malformed,
                   fmt::format("the stored state of a register cannot be read: {}", error.what()));
  }
}

}  // namespace recald::sqlite
