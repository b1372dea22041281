#include "daemon/gateway/recording/line.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/record/record_batch.hpp"
#include "adapters/shapes/strict_json.hpp"
#include "adapters/stores/register_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/gateway/ingest/json_depth.hpp"

namespace recald::daemon::recording {
namespace {

using metering::Instant;
using metering::Reading;
using modbus::ReadFault;
using shapes::Json;
using shapes::json_of;
using shapes::Parsed;
using shapes::StrictReader;
using std::chrono::milliseconds;

constexpr std::int64_t kTimeMax_ms = StrictReader::kLast_s * 1000;
constexpr int kDepthMax = 8;
constexpr std::array kFaults{ReadFault::timeout,   ReadFault::refused,  ReadFault::closed,
                             ReadFault::exception, ReadFault::mismatch, ReadFault::crc};
constexpr std::array<std::string_view, 3> kTicks{"minute", "hour", "step"};

// Texts.

Json json_of_readings(const std::vector<Reading>& readings) {
  Json all = Json::array();
  for (const Reading& one : readings) {
    all.push_back(
        Json::array({json_of(one.start), json_of(one.mean_kW), static_cast<int>(one.validity),
                     static_cast<std::uint32_t>(one.reasons), one.late}));
  }
  return all;
}

void add(Json& json, const Read& read) {
  json["read"] = read.meter;
  json["index"] = read.read;
  json["unit"] = read.request.unit;
  json["function"] = static_cast<int>(read.request.function);
  json["address"] = read.request.address;
  json["count"] = read.request.count;
  json["due_ms"] = read.due.time_since_epoch().count();
  json["took_ms"] = read.duration.count();
  if (read.is_probe) json["probe"] = true;
  if (read.result) {
    json["registers"] = *read.result;
    return;
  }
  const modbus::ReadFailure& failed = read.result.error();
  json["fault"] = to_string(failed.fault);
  if (failed.fault == ReadFault::exception) json["exception"] = failed.exception_code;
  if (!failed.what.empty()) json["what"] = failed.what.substr(0, kTextMax_bytes);
}

void add(Json& json, const Push& push) {
  json["push"] = push.meter;
  json["readings"] = json_of_readings(push.readings);
  if (!push.correction) return;
  json["correction"] = {{"author", push.correction->author},
                        {"reason", push.correction->reason},
                        {"sha256", push.correction->sha256}};
}

void add(Json& json, const Value& told) {
  json["value"] = told.value.meter;
  json["is_counter"] = told.value.is_counter;
  json["is"] = json_of(told.value.value);
  json["measured"] = json_of(told.value.measured);
}

void add(Json& json, Start) { json["start"] = true; }
void add(Json& json, Reload) { json["reload"] = true; }
void add(Json& json, Tick tick) { json["tick"] = kTicks.at(static_cast<std::size_t>(tick)); }

Json json_of_line(const Head& head) {
  return {{"recald_recording", head.format},
          {"program", head.program},
          {"time_zone_release", head.time_zone_release}};
}
Json json_of_line(const SitePart& part) {
  if (part.map.empty()) return {{"site", part.text}};
  return {{"map", part.map}, {"text", part.text}};
}
Json json_of_line(const KnownMeter& meter) {
  return {{"meter", meter.id},
          {"interval_s", meter.interval.count()},
          {"rules", meter.rules},
          {"readings_from", json_of(meter.readings_from)}};
}
Json json_of_line(const KnownRegister& known) {
  return {{"register", known.meter}, {"state", stores::register_text(known.state)}};
}
Json json_of_line(const Readings& some) {
  return {{"readings_of", some.meter}, {"readings", json_of_readings(some.readings)}};
}
Json json_of_line(const KnownEvent& known) {
  const StoreEvent& event = known.event;
  return {{"event", event.kind},
          {"time", json_of(event.time)},
          {"severity", static_cast<int>(event.severity)},
          {"subject", event.subject},
          {"text", event.text},
          {"count", event.count},
          {"last", json_of(event.last)}};
}
Json json_of_line(const KnownMonth& known) {
  return {{"month_of", known.meter}, {"month", record::to_json(known.month)}};
}
Json json_of_line(const ReopenedMonth& reopened) {
  return {{"reopened_of", reopened.meter}, {"month", json_of(reopened.month)}};
}
Json json_of_line(const Committed& some) {
  return {{"stored", some.meter}, {"readings", json_of_readings(some.readings)}};
}
Json json_of_line(const End& end) { return {{"end", end.why}, {"whole", end.is_whole}}; }
Json json_of_line(const Entry& entry) {
  Json json = {{"wall_ms", entry.at.wall.time_since_epoch().count()},
               {"monotonic_ms", entry.at.monotonic.count()}};
  if (!entry.clock_doubt.empty()) json["clock_doubt"] = entry.clock_doubt;
  std::visit([&](const auto& what) { add(json, what); }, entry.what);
  return json;
}

// Readers.

milliseconds read_ms(StrictReader& reader, const Parsed& json, const char* key) {
  return milliseconds{reader.integer(reader.at(json, key), key, 0, kTimeMax_ms)};
}

template <class Number>
Number read_number(StrictReader& reader, const Parsed& json, const char* key) {
  return static_cast<Number>(
      reader.integer(reader.at(json, key), key, 0, std::numeric_limits<Number>::max()));
}

Reading read_reading(StrictReader& reader, const Parsed& json) {
  constexpr std::size_t kParts = 5;
  if (!json.is_array() || json.size() != kParts) {
    reader.refuse("readings", "has one that is no list of 5 values");
    return {};
  }
  return {.meter = 0,
          .start = reader.read<Instant>(json[0], "start"),
          .mean_kW = reader.read<double>(json[1], "mean_kW"),
          .validity = static_cast<metering::Validity>(reader.integer(
              json[2], "validity", 0, static_cast<int>(metering::Validity::suspect))),
          .reasons = static_cast<metering::Reason>(
              reader.integer(json[3], "reasons", 0, std::numeric_limits<std::uint32_t>::max())),
          .late = reader.read<bool>(json[4], "late")};
}

std::vector<Reading> read_readings(StrictReader& reader, const Parsed& json) {
  std::vector<Reading> all;
  reader.each_of(reader.at(json, "readings"), "readings",
                 [&](const Parsed& one) { all.push_back(read_reading(reader, one)); });
  return all;
}

modbus::ReadFailure read_failure(StrictReader& reader, const Parsed& json) {
  modbus::ReadFailure failed{.fault = ReadFault::timeout};
  const auto name = reader.member<std::string>(json, "fault");
  const auto* const known =
      std::ranges::find(kFaults, name, [](ReadFault one) { return to_string(one); });
  if (known != kFaults.end()) {
    failed.fault = *known;
  } else {
    reader.refuse("fault", "is no known one");
  }
  if (failed.fault == ReadFault::exception) {
    failed.exception_code = read_number<std::uint8_t>(reader, json, "exception");
  }
  if (json.contains("what")) failed.what = reader.member<std::string>(json, "what");
  return failed;
}

Read read_read(StrictReader& reader, const Parsed& json) {
  const auto function = reader.integer(reader.at(json, "function"), "function", 3, 4);
  Read read{.meter = reader.member<std::string>(json, "read"),
            .read = read_number<std::uint16_t>(reader, json, "index"),
            .request = {.unit = read_number<std::uint8_t>(reader, json, "unit"),
                        .function = static_cast<modbus::Function>(function),
                        .address = read_number<std::uint16_t>(reader, json, "address"),
                        .count = static_cast<std::uint16_t>(reader.integer(
                            reader.at(json, "count"), "count", 1, modbus::kRegistersMax))},
            .due = WallTime{read_ms(reader, json, "due_ms")},
            .is_probe = json.contains("probe"),
            .result = {},
            .duration = read_ms(reader, json, "took_ms")};
  if (json.contains("fault")) {
    read.result = tl::unexpected(read_failure(reader, json));
    return read;
  }
  modbus::Words words;
  reader.each_of(reader.at(json, "registers"), "registers", [&](const Parsed& one) {
    words.push_back(static_cast<std::uint16_t>(
        reader.integer(one, "registers", 0, std::numeric_limits<std::uint16_t>::max())));
  });
  // What is decoded relies on it.
  if (words.size() != read.request.count) reader.refuse("registers", "are not 'count' many");
  read.result = std::move(words);
  return read;
}

Push read_push(StrictReader& reader, const Parsed& json) {
  Push push{.meter = reader.member<std::string>(json, "push"),
            .readings = read_readings(reader, json),
            .correction = {}};
  if (!json.contains("correction")) return push;
  const Parsed& given = json.at("correction");
  push.correction = Correction{.author = reader.member<std::string>(given, "author"),
                               .reason = reader.member<std::string>(given, "reason"),
                               .sha256 = reader.member<std::string>(given, "sha256")};
  if (push.correction->reason.empty()) reader.refuse("reason", "is empty");
  return push;
}

Value read_value(StrictReader& reader, const Parsed& json) {
  return {{.meter = reader.member<std::string>(json, "value"),
           .is_counter = reader.member<bool>(json, "is_counter"),
           .value = reader.member<double>(json, "is"),
           .measured = reader.member<std::optional<Instant>>(json, "measured")}};
}

Tick read_tick(StrictReader& reader, const Parsed& json) {
  const auto* const known = std::ranges::find(kTicks, reader.member<std::string>(json, "tick"));
  if (known != kTicks.end()) return static_cast<Tick>(known - kTicks.begin());
  reader.refuse("tick", "is no known one");
  return Tick::minute;
}

Entry read_entry(StrictReader& reader, const Parsed& json) {
  Entry entry{.at = {.wall = WallTime{read_ms(reader, json, "wall_ms")},
                     .monotonic = read_ms(reader, json, "monotonic_ms")},
              .clock_doubt = json.contains("clock_doubt")
                                 ? reader.member<std::string>(json, "clock_doubt")
                                 : "",
              .what = Start{}};
  if (json.contains("read")) {
    entry.what = read_read(reader, json);
  } else if (json.contains("push")) {
    entry.what = read_push(reader, json);
  } else if (json.contains("value")) {
    entry.what = read_value(reader, json);
  } else if (json.contains("tick")) {
    entry.what = read_tick(reader, json);
  } else if (json.contains("reload")) {
    entry.what = Reload{};
  } else if (!json.contains("start")) {
    reader.refuse("wall_ms", "is the time of nothing that is known here");
  }
  return entry;
}

Result<Line> read_head(StrictReader& reader, const Parsed& json) {
  Head head{.format = reader.member<int>(json, "recald_recording"),
            .program = reader.member<std::string>(json, "program"),
            .time_zone_release = reader.member<std::string>(json, "time_zone_release")};
  if (head.format <= kFormat) return reader.result(Line{std::move(head)});
  return failure(ErrorCode::unsupported,
                 fmt::format("it was written by a newer recald (format {}, this one reads {}); "
                             "replay it with that version or a later one",
                             head.format, kFormat));
}

StoreEvent read_event(StrictReader& reader, const Parsed& json) {
  constexpr std::int64_t kCountMax = 100'000;  // of one day
  return {
      .time = reader.member<Instant>(json, "time"),
      .severity = static_cast<Severity>(reader.integer(reader.at(json, "severity"), "severity", 0,
                                                       static_cast<int>(Severity::error))),
      .kind = reader.member<std::string>(json, "event"),
      .subject = reader.member<std::string>(json, "subject"),
      .text = reader.member<std::string>(json, "text"),
      .count = static_cast<int>(reader.integer(reader.at(json, "count"), "count", 1, kCountMax)),
      .last = reader.member<std::optional<Instant>>(json, "last")};
}

/// Readings, months and states of a store.
Result<Line> read_known(StrictReader& reader, const Parsed& json) {
  if (json.contains("meter")) {
    return reader.result(Line{
        KnownMeter{.id = reader.member<std::string>(json, "meter"),
                   .interval = std::chrono::seconds{reader.integer(reader.at(json, "interval_s"),
                                                                   "interval_s", 1, 86'400)},
                   .rules = reader.member<std::string>(json, "rules"),
                   .readings_from = reader.member<std::optional<Instant>>(json, "readings_from")}});
  }
  if (json.contains("register")) {
    auto meter = reader.member<std::string>(json, "register");
    auto state =
        TRY(stores::read_register_text(reader.document(reader.at(json, "state"), "state")));
    return reader.result(Line{KnownRegister{std::move(meter), std::move(state)}});
  }
  if (json.contains("event")) return reader.result(Line{KnownEvent{read_event(reader, json)}});
  if (json.contains("month_of")) {
    auto meter = reader.member<std::string>(json, "month_of");
    auto month =
        TRY(record::parse_stored_month(reader.document(reader.at(json, "month"), "month")));
    return reader.result(Line{KnownMonth{std::move(meter), std::move(month)}});
  }
  return reader.result(Line{ReopenedMonth{reader.member<std::string>(json, "reopened_of"),
                                          reader.member<metering::Month>(json, "month")}});
}

Result<Line> read_line(const Parsed& json) {
  constexpr std::string_view kWhat = "the line";
  StrictReader reader{kWhat};
  if (json.contains("recald_recording")) return read_head(reader, json);
  if (json.contains("wall_ms")) return reader.result(Line{read_entry(reader, json)});
  if (json.contains("stored")) {
    return reader.result(
        Line{Committed{reader.member<std::string>(json, "stored"), read_readings(reader, json)}});
  }
  if (json.contains("readings_of")) {
    return reader.result(Line{
        Readings{reader.member<std::string>(json, "readings_of"), read_readings(reader, json)}});
  }
  if (json.contains("site")) {
    return reader.result(Line{SitePart{"", reader.member<std::string>(json, "site")}});
  }
  if (json.contains("map")) {
    return reader.result(Line{SitePart{reader.member<std::string>(json, "map"),
                                       reader.member<std::string>(json, "text")}});
  }
  if (json.contains("end")) {
    return reader.result(
        Line{End{reader.member<std::string>(json, "end"), reader.member<bool>(json, "whole")}});
  }
  for (const char* const key : {"meter", "register", "event", "month_of", "reopened_of"}) {
    if (json.contains(key)) return read_known(reader, json);
  }
  return failure(ErrorCode::malformed, "it is no line of a recording");
}

}  // namespace

std::string to_text(const Line& line) {
  const Json json = std::visit([](const auto& one) { return json_of_line(one); }, line);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Line> parse_line(std::string_view text) {
  if (is_nested_deeper(text, kDepthMax)) {
    return failure(ErrorCode::malformed, "it is no line of a recording: too many brackets");
  }
  const Parsed json = Parsed::parse(text, nullptr, false);
  if (json.is_object()) {
    auto line = read_line(json);
    if (line) return line;
    return failure(line.error().code, printable(line.error().message));
  }
  return failure(ErrorCode::malformed, "it is no JSON object");
}

}  // namespace recald::daemon::recording
