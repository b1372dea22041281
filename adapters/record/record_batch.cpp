#include "adapters/record/record_batch.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/results/job_result_json.hpp"

namespace recald::record {
namespace {

using metering::Instant;
using Json = nlohmann::ordered_json;
using Parsed = nlohmann::json;  ///< Looks keys up without going through all of them.

constexpr std::string_view kTopics = "recald/v1/";
constexpr std::string_view kBatch = "/batch";
constexpr std::string_view kWatermark = "/watermark";

// A gateway whose clock is wrong is heard too: anything that the record can hold, year 1 to 9999.
constexpr std::int64_t kFirst_s = -62'135'596'800;
constexpr std::int64_t kLast_s = 253'402'300'799;
constexpr std::int64_t kInt_max = std::numeric_limits<int>::max();
constexpr std::int64_t kNumber_max = std::numeric_limits<std::int64_t>::max();
/// Of what is sent: sums of some of them are numbers too.
constexpr std::int64_t kSent_max = std::int64_t{1} << 60;

std::int64_t epoch_s(Instant t) { return t.time_since_epoch().count(); }
Json epoch_s(const std::optional<Instant>& t) { return t ? Json(epoch_s(*t)) : Json(); }

/// What is no UTF-8 in a text, such as a piece of a message, is replaced.
std::string text_of_json(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json json_of(const StoredMonth& month) {
  const metering::MonthlyFigure& figure = month.figure;
  Json peak;
  if (figure.peak) {
    peak = {{"kW", results::number(figure.peak->kW)},
            {"start", epoch_s(figure.peak->start)},
            {"could_be_exceeded", figure.peak->could_be_exceeded}};
  }
  return {{"month", metering::to_string(figure.month)},
          {"daily_average_kWh", results::number(figure.daily_average_kWh)},
          {"daily_average_variance_kWh2", results::number(figure.daily_average_variance_kWh2)},
          {"peak", std::move(peak)},
          {"peak_window_s", figure.peak_window.count()},
          {"coverage", results::number(figure.coverage)},
          {"filled_share", results::number(figure.filled_share)},
          {"slots_by_validity", figure.slots_by_validity},
          {"slots", figure.slots},
          {"usable", figure.usable},
          {"unusable_because", figure.unusable_because},
          {"reasons", static_cast<std::uint32_t>(figure.reasons)},
          {"revision", figure.revision},
          {"closed_at", epoch_s(month.closed_at)},
          {"time_zone_release", month.time_zone_release}};
}

/// [number, meter, interval, start, revision, mean, validity, reasons, late], or [number, meter,
/// interval, {month}], or [number, meter, interval, null].
Json json_of(const OutboxEntry& entry) {
  Json json = Json::array({entry.number, entry.meter, entry.interval.count()});
  if (const auto* const interval = std::get_if<StoredInterval>(&entry.stored)) {
    const metering::Reading& reading = interval->reading;
    json.push_back(epoch_s(reading.start));
    json.push_back(interval->revision);
    json.push_back(results::number(reading.mean_kW));
    json.push_back(static_cast<int>(reading.validity));
    json.push_back(static_cast<std::uint32_t>(reading.reasons));
    json.push_back(reading.late);
  } else if (const auto* const month = std::get_if<StoredMonth>(&entry.stored)) {
    json.push_back(json_of(*month));
  } else {
    json.push_back(nullptr);
  }
  return json;
}

Json json_of(const StoreEvent& event) {
  return {{"number", event.number},
          {"time", epoch_s(event.time)},
          {"severity", static_cast<int>(event.severity)},
          {"kind", event.kind},
          {"subject", event.subject},
          {"text", event.text},
          {"count", event.count},
          {"last", epoch_s(event.last)}};
}

Json json_of(const StoredJob& job) {
  return {{"number", job.number},        {"kind", name_of(job.kind)},
          {"state", name_of(job.state)}, {"asked_by", job.asked_by},
          {"asked", epoch_s(job.asked)}, {"started", epoch_s(job.started)},
          {"ended", epoch_s(job.ended)}, {"accepted", job.accepted},
          {"message", job.message},      {"document", job.result.document}};
}

Json json_of(const Progress& progress) {
  return {
      {"entries", progress.entries}, {"events", progress.events}, {"results", progress.results}};
}

template <class T>
Json list_of(const std::vector<T>& all) {
  Json list = Json::array();
  for (const T& one : all) list.push_back(json_of(one));
  return list;
}

/// Takes values out of JSON and remembers the first that is not as it must be.
class Reader {
 public:
  explicit Reader(std::string_view what) : what_(what) {}

  /// Says where the next values are: "entries[3]".
  void enter(const char* list, std::size_t index) {
    list_ = list;
    index_ = index;
  }
  void leave() { list_ = nullptr; }

  /// @return null, which no other function takes, if it is missing.
  const Parsed& member(const Parsed& object, const char* key) {
    static const Parsed missing;
    const auto found = object.is_object() ? object.find(key) : object.end();
    if (found != object.end()) return *found;
    refuse(key, "is missing");
    return missing;
  }

  std::int64_t integer(const Parsed& value, const char* key, std::int64_t min, std::int64_t max) {
    if (!value.is_number_integer()) {
      refuse(key, "is no whole number");
      return min;
    }
    const bool is_large = value.is_number_unsigned() &&
                          value.get<std::uint64_t>() > static_cast<std::uint64_t>(kNumber_max);
    const std::int64_t number = is_large ? kNumber_max : value.get<std::int64_t>();
    if (is_large || number < min || number > max) {
      refuse(key, fmt::format("is {}; it must lie between {} and {}", value.dump(), min, max));
      return min;
    }
    return number;
  }
  std::int64_t integer(const Parsed& object, const char* key, std::int64_t max) {
    return integer(member(object, key), key, 0, max);
  }
  /// Null: not a number.
  double number(const Parsed& value, const char* key) {
    if (value.is_number()) return value.get<double>();
    if (!value.is_null()) refuse(key, "is no number");
    return kAbsent;
  }
  bool flag(const Parsed& value, const char* key) {
    if (value.is_boolean()) return value.get<bool>();
    refuse(key, "is neither true nor false");
    return false;
  }
  std::string text(const Parsed& value, const char* key) {
    if (value.is_string()) return value.get<std::string>();
    refuse(key, "is no text");
    return {};
  }

  Instant instant(const Parsed& value, const char* key) {
    return Instant{std::chrono::seconds{integer(value, key, kFirst_s, kLast_s)}};
  }
  std::optional<Instant> optional_instant(const Parsed& value, const char* key) {
    if (value.is_null()) return {};
    return instant(value, key);
  }
  metering::Reason reasons(const Parsed& value, const char* key) {
    // Those of a newer recald too.
    constexpr std::int64_t kMax = std::numeric_limits<std::uint32_t>::max();
    return static_cast<metering::Reason>(integer(value, key, 0, kMax));
  }
  metering::Month month(const Parsed& value, const char* key) {
    const auto parsed = metering::parse_month(text(value, key));
    if (!parsed) refuse(key, "is no month such as \"2026-03\"");
    return parsed.value_or(std::chrono::year{1970} / 1);
  }
  /// One that has a name.
  template <class Enum>
  Enum named(const Parsed& value, const char* key, std::initializer_list<Enum> all) {
    const std::string name = text(value, key);
    for (const Enum one : all) {
      if (name_of(one) == name) return one;
    }
    refuse(key, "is none of the known ones");
    return *all.begin();
  }
  /// Calls read(reader, element) for each, whose numbers must rise, from beyond `after` on.
  template <class T, class Read>
  std::vector<T> list(const Parsed& object, const char* key, std::int64_t after, Read read) {
    std::vector<T> all;
    const Parsed& elements = member(object, key);
    if (!elements.is_array()) {
      refuse(key, "is no list");
      return all;
    }
    all.reserve(elements.size());
    for (const Parsed& element : elements) {
      enter(key, all.size());
      all.push_back(read(*this, element));
      const std::int64_t number = all.back().number;
      if (number <= after) {
        refuse("number", fmt::format("is {} after {}; numbers must rise", number, after));
      }
      after = number;
    }
    leave();
    return all;
  }

  void refuse(const char* key, std::string_view why) {
    if (!problem_.empty()) return;
    problem_ = list_ != nullptr ? fmt::format("{}[{}]: '{}' {}", list_, index_, key, why)
                                : fmt::format("'{}' {}", key, why);
  }
  template <class T>
  Result<T> result(T value) const {
    if (problem_.empty()) return value;
    return failure(ErrorCode::malformed, fmt::format("{}: {}", what_, problem_));
  }

 private:
  std::string_view what_;
  const char* list_ = nullptr;
  std::size_t index_ = 0;
  std::string problem_;
};

std::optional<metering::PeakDemand> read_peak(Reader& reader, const Parsed& json) {
  if (json.is_null()) return {};
  return metering::PeakDemand{.kW = reader.number(reader.member(json, "kW"), "kW"),
                              .start = reader.instant(reader.member(json, "start"), "start"),
                              .could_be_exceeded = reader.flag(
                                  reader.member(json, "could_be_exceeded"), "could_be_exceeded")};
}

std::array<int, 5> read_slots(Reader& reader, const Parsed& json) {
  std::array<int, 5> slots{};
  if (!json.is_array() || json.size() != slots.size()) {
    reader.refuse("slots_by_validity", "is no list of 5 numbers");
    return slots;
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    slots[i] = static_cast<int>(reader.integer(json[i], "slots_by_validity", 0, kInt_max));
  }
  return slots;
}

StoredMonth read_month(Reader& reader, const Parsed& json) {
  const auto number = [&](const char* key) { return reader.number(reader.member(json, key), key); };
  const auto count = [&](const char* key) {
    return static_cast<int>(reader.integer(json, key, kInt_max));
  };
  return {
      .figure = {.month = reader.month(reader.member(json, "month"), "month"),
                 .daily_average_kWh = number("daily_average_kWh"),
                 .daily_average_variance_kWh2 = number("daily_average_variance_kWh2"),
                 .peak = read_peak(reader, reader.member(json, "peak")),
                 .peak_window = std::chrono::seconds{count("peak_window_s")},
                 .coverage = number("coverage"),
                 .filled_share = number("filled_share"),
                 .slots_by_validity = read_slots(reader, reader.member(json, "slots_by_validity")),
                 .slots = count("slots"),
                 .usable = reader.flag(reader.member(json, "usable"), "usable"),
                 .unusable_because =
                     reader.text(reader.member(json, "unusable_because"), "unusable_because"),
                 .reasons = reader.reasons(reader.member(json, "reasons"), "reasons"),
                 .revision = count("revision")},
      .closed_at = reader.instant(reader.member(json, "closed_at"), "closed_at"),
      .time_zone_release =
          reader.text(reader.member(json, "time_zone_release"), "time_zone_release")};
}

/// Elements 3 to 8 of an entry.
StoredInterval read_interval(Reader& reader, const Parsed& json) {
  constexpr auto kValidity_max = static_cast<std::int64_t>(metering::Validity::suspect);
  return {.reading = {.meter = 0,
                      .start = reader.instant(json[3], "start"),
                      .mean_kW = reader.number(json[5], "mean_kW"),
                      .validity = static_cast<metering::Validity>(
                          reader.integer(json[6], "validity", 0, kValidity_max)),
                      .reasons = reader.reasons(json[7], "reasons"),
                      .late = reader.flag(json[8], "late")},
          .revision = static_cast<int>(reader.integer(json[4], "revision", 0, kInt_max))};
}

OutboxEntry read_entry(Reader& reader, const Parsed& json) {
  constexpr std::size_t kOther = 4;
  constexpr std::size_t kInterval = 9;
  if (!json.is_array() || (json.size() != kOther && json.size() != kInterval)) {
    reader.refuse("entry", "is no list of 4 or 9 values");
    return {};
  }
  OutboxEntry entry{
      .number = reader.integer(json[0], "number", 1, kSent_max),
      .meter = reader.text(json[1], "meter"),
      .interval = std::chrono::seconds{reader.integer(json[2], "interval", 1, kInt_max)},
      .stored = {}};
  if (json.size() == kInterval) {
    entry.stored = read_interval(reader, json);
  } else if (!json[3].is_null()) {
    entry.stored = read_month(reader, json[3]);
  }
  return entry;
}

StoreEvent read_event(Reader& reader, const Parsed& json) {
  constexpr auto kSeverity_max = static_cast<std::int64_t>(Severity::error);
  const auto text = [&](const char* key) { return reader.text(reader.member(json, key), key); };
  return {.time = reader.instant(reader.member(json, "time"), "time"),
          .severity = static_cast<Severity>(reader.integer(json, "severity", kSeverity_max)),
          .kind = text("kind"),
          .subject = text("subject"),
          .text = text("text"),
          .count = static_cast<int>(reader.integer(json, "count", kInt_max)),
          .last = reader.optional_instant(reader.member(json, "last"), "last"),
          .number = reader.integer(json, "number", kSent_max)};
}

StoredJob read_result(Reader& reader, const Parsed& json) {
  const auto text = [&](const char* key) { return reader.text(reader.member(json, key), key); };
  return {.number = reader.integer(json, "number", kSent_max),
          .kind = reader.named(reader.member(json, "kind"), "kind",
                               {JobKind::calibration, JobKind::diagnosis}),
          .state = reader.named(reader.member(json, "state"), "state",
                                {JobState::done, JobState::failed, JobState::cancelled}),
          .asked_by = text("asked_by"),
          .asked = reader.instant(reader.member(json, "asked"), "asked"),
          .started = reader.optional_instant(reader.member(json, "started"), "started"),
          .ended = reader.optional_instant(reader.member(json, "ended"), "ended"),
          .accepted = reader.flag(reader.member(json, "accepted"), "accepted"),
          .message = text("message"),
          .folder = {},
          .result = results::read_job_result(text("document"))};
}

Progress read_progress(Reader& reader, const Parsed& json) {
  return {.entries = reader.integer(json, "entries", kSent_max),
          .events = reader.integer(json, "events", kSent_max),
          .results = reader.integer(json, "results", kSent_max)};
}

/// @return the object, or malformed.
Result<Parsed> parse_object(std::string_view what, std::string_view text) {
  Parsed json = Parsed::parse(text, nullptr, false);
  if (json.is_object()) return json;
  return failure(ErrorCode::malformed, fmt::format("{}: it is no JSON object", what));
}

std::int64_t read_outbox(Reader& reader, const Parsed& json) {
  return reader.integer(reader.member(json, "outbox"), "outbox", -kNumber_max, kNumber_max);
}

}  // namespace

Progress RecordBatch::until() const {
  Progress until = after;
  if (!entries.empty()) until.entries = entries.back().number;
  if (!events.empty()) until.events = events.back().number;
  if (!results.empty()) until.results = results.back().number;
  return until;
}

std::string batch_topic(std::string_view site) {
  return fmt::format("{}{}{}", kTopics, site, kBatch);
}

std::string watermark_topic(std::string_view site) {
  return fmt::format("{}{}{}", kTopics, site, kWatermark);
}

std::string site_of_topic(std::string_view topic) {
  if (!topic.starts_with(kTopics)) return {};
  topic.remove_prefix(kTopics.size());
  const std::size_t end = topic.find('/');
  if (end == std::string_view::npos) return {};
  const std::string_view rest = topic.substr(end);
  return rest == kBatch || rest == kWatermark ? std::string{topic.substr(0, end)} : std::string{};
}

std::string to_json(const RecordBatch& batch) {
  return text_of_json({{"outbox", batch.outbox},
                       {"question", batch.question},
                       {"first", batch.is_first},
                       {"after", json_of(batch.after)},
                       {"entries", list_of(batch.entries)},
                       {"events", list_of(batch.events)},
                       {"results", list_of(batch.results)}});
}

std::string to_json(const Watermark& watermark) {
  Json json = {{"outbox", watermark.outbox}, {"answers", watermark.answers}};
  json.update(json_of(watermark.until));
  return text_of_json(json);
}

std::string to_json(const StoredMonth& month) { return text_of_json(json_of(month)); }

Result<StoredMonth> parse_stored_month(std::string_view text) {
  constexpr std::string_view kWhat = "a month of the record";
  const auto json = TRY(parse_object(kWhat, text));
  Reader reader{kWhat};
  StoredMonth month = read_month(reader, json);
  return reader.result(std::move(month));
}

Result<RecordBatch> parse_batch(std::string_view text) {
  constexpr std::string_view kWhat = "the batch";
  const auto json = TRY(parse_object(kWhat, text));
  Reader reader{kWhat};
  RecordBatch batch{.outbox = read_outbox(reader, json),
                    .after = read_progress(reader, reader.member(json, "after")),
                    .question = reader.integer(json, "question", kNumber_max),
                    .is_first = reader.flag(reader.member(json, "first"), "first")};
  if (batch.outbox == 0) reader.refuse("outbox", "is 0");
  batch.entries = reader.list<OutboxEntry>(json, "entries", batch.after.entries, read_entry);
  batch.events = reader.list<StoreEvent>(json, "events", batch.after.events, read_event);
  batch.results = reader.list<StoredJob>(json, "results", batch.after.results, read_result);
  return reader.result(std::move(batch));
}

Result<Watermark> parse_watermark(std::string_view text) {
  constexpr std::string_view kWhat = "the watermark";
  const auto json = TRY(parse_object(kWhat, text));
  Reader reader{kWhat};
  const std::int64_t outbox = read_outbox(reader, json);
  return reader.result(Watermark{.outbox = outbox,
                                 .until = read_progress(reader, json),
                                 .answers = reader.integer(json, "answers", kNumber_max)});
}

}  // namespace recald::record
