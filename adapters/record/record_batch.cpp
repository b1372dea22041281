#include "adapters/record/record_batch.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/results/job_result_json.hpp"
#include "adapters/shapes/strict_json.hpp"

SHAPE(recald::record::Progress, entries, events, results);
SHAPE(recald::metering::PeakDemand, kW, start, could_be_exceeded);
SHAPE(recald::metering::MonthlyFigure, month, daily_average_kWh, daily_average_variance_kWh2, peak,
      (peak_window, "peak_window_s"), coverage, filled_share, slots_by_validity, slots, usable,
      unusable_because, reasons, revision);
SHAPE(recald::StoreEvent, number, time, severity, kind, subject, text, count, last);
SHAPE(recald::StoredJob, number, kind, state, asked_by, asked, started, ended, accepted, message,
      (result, "document"));

namespace recald::shapes {

using metering::Reason;
using metering::Validity;

template <>
struct Form<Severity> : Numbered<Severity, static_cast<int>(Severity::error)> {};
template <>
struct Form<Validity> : Numbered<Validity, static_cast<int>(Validity::suspect)> {};
/// Those of a newer recald too.
template <>
struct Form<Reason> : Numbered<Reason, std::numeric_limits<std::uint32_t>::max()> {};
template <>
struct Form<JobKind> : Named<JobKind, JobKind::calibration, JobKind::diagnosis> {};
/// Of a job that has ended.
template <>
struct Form<JobState> : Named<JobState, JobState::done, JobState::failed, JobState::cancelled> {};

template <>
struct Form<JobResult> {
  static Json json_of(const JobResult& result) { return result.document; }
  static JobResult read(StrictReader& reader, const Parsed& json, const char* key) {
    return results::read_job_result(reader.document(json, key));
  }
};

template <>
struct Form<StoredMonth> {
  static Json json_of(const StoredMonth& month) {
    Json json = shapes::json_of(month.figure);
    json["closed_at"] = shapes::json_of(month.closed_at);
    json["time_zone_release"] = month.time_zone_release;
    return json;
  }
  static StoredMonth read(StrictReader& reader, const Parsed& json, const char* key) {
    return {.figure = reader.read<metering::MonthlyFigure>(json, key),
            .closed_at = reader.member<metering::Instant>(json, "closed_at"),
            .time_zone_release = reader.member<std::string>(json, "time_zone_release")};
  }
};

/// [number, meter, interval, start, revision, mean, validity, reasons, late], or [number, meter,
/// interval, {month}], or [number, meter, interval, null].
template <>
struct Form<OutboxEntry> {
  static Json json_of(const OutboxEntry& entry) {
    Json json = Json::array({entry.number, entry.meter, entry.interval.count()});
    const auto add = [&](const auto&... values) { (json.push_back(shapes::json_of(values)), ...); };
    if (const auto* const interval = std::get_if<StoredInterval>(&entry.stored)) {
      const metering::Reading& reading = interval->reading;
      add(reading.start, interval->revision, reading.mean_kW, reading.validity, reading.reasons,
          reading.late);
    } else if (const auto* const month = std::get_if<StoredMonth>(&entry.stored)) {
      add(*month);
    } else {
      json.push_back(nullptr);
    }
    return json;
  }
  static OutboxEntry read(StrictReader& reader, const Parsed& json, const char*) {
    constexpr std::size_t kOther = 4;
    constexpr std::size_t kInterval = 9;
    if (!json.is_array() || (json.size() != kOther && json.size() != kInterval)) {
      reader.refuse("entry", "is no list of 4 or 9 values");
      return {};
    }
    OutboxEntry entry{.number = reader.integer(json[0], "number", 1, StrictReader::kSent_max),
                      .meter = reader.read<std::string>(json[1], "meter"),
                      .interval = std::chrono::seconds{reader.integer(json[2], "interval", 1,
                                                                      StrictReader::kInt_max)},
                      .stored = {}};
    if (json.size() == kInterval) {
      entry.stored =
          StoredInterval{.reading = {.meter = 0,
                                     .start = reader.read<metering::Instant>(json[3], "start"),
                                     .mean_kW = reader.read<double>(json[5], "mean_kW"),
                                     .validity = reader.read<Validity>(json[6], "validity"),
                                     .reasons = reader.read<Reason>(json[7], "reasons"),
                                     .late = reader.read<bool>(json[8], "late")},
                         .revision = reader.read<int>(json[4], "revision")};
    } else if (!json[3].is_null()) {
      entry.stored = reader.read<StoredMonth>(json[3], "month");
    }
    return entry;
  }
};

}  // namespace recald::shapes

namespace recald::record {
namespace {

using shapes::Json;
using shapes::json_of;
using shapes::Parsed;
using shapes::StrictReader;

constexpr std::string_view kTopics = "recald/v1/";
constexpr std::string_view kBatch = "/batch";
constexpr std::string_view kWatermark = "/watermark";

/// What is no UTF-8 in a text, such as a piece of a message, is replaced.
std::string text_of_json(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// A list whose numbers must rise, from beyond `after` on.
template <class T>
std::vector<T> rising(StrictReader& reader, const Parsed& object, const char* key,
                      std::int64_t after) {
  std::vector<T> all;
  reader.each_of(reader.at(object, key), key, [&](const Parsed& element) {
    all.push_back(reader.read<T>(element, key));
    const std::int64_t number = all.back().number;
    if (number <= after) {
      reader.refuse("number", fmt::format("is {} after {}; numbers must rise", number, after));
    }
    after = number;
  });
  return all;
}

/// @return the object, or malformed.
Result<Parsed> parse_object(std::string_view what, std::string_view text) {
  Parsed json = Parsed::parse(text, nullptr, false);
  if (json.is_object()) return json;
  return failure(ErrorCode::malformed, fmt::format("{}: it is no JSON object", what));
}

std::int64_t read_outbox(StrictReader& reader, const Parsed& json) {
  return reader.integer(reader.at(json, "outbox"), "outbox", -StrictReader::kNumber_max,
                        StrictReader::kNumber_max);
}

/// Asked as often as it takes.
std::int64_t read_question(StrictReader& reader, const Parsed& json, const char* key) {
  return reader.integer(reader.at(json, key), key, 0, StrictReader::kNumber_max);
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
                       {"entries", json_of(batch.entries)},
                       {"events", json_of(batch.events)},
                       {"results", json_of(batch.results)}});
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
  StrictReader reader{kWhat};
  return reader.result(reader.read<StoredMonth>(json, "month"));
}

Result<RecordBatch> parse_batch(std::string_view text) {
  constexpr std::string_view kWhat = "the batch";
  const auto json = TRY(parse_object(kWhat, text));
  StrictReader reader{kWhat};
  RecordBatch batch{.outbox = read_outbox(reader, json),
                    .after = reader.member<Progress>(json, "after"),
                    .question = read_question(reader, json, "question"),
                    .is_first = reader.member<bool>(json, "first")};
  if (batch.outbox == 0) reader.refuse("outbox", "is 0");
  batch.entries = rising<OutboxEntry>(reader, json, "entries", batch.after.entries);
  batch.events = rising<StoreEvent>(reader, json, "events", batch.after.events);
  batch.results = rising<StoredJob>(reader, json, "results", batch.after.results);
  return reader.result(std::move(batch));
}

Result<Watermark> parse_watermark(std::string_view text) {
  constexpr std::string_view kWhat = "the watermark";
  const auto json = TRY(parse_object(kWhat, text));
  StrictReader reader{kWhat};
  return reader.result(Watermark{.outbox = read_outbox(reader, json),
                                 .until = reader.read<Progress>(json, "until"),
                                 .answers = read_question(reader, json, "answers")});
}

}  // namespace recald::record
