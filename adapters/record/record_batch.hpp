/// What a gateway tells the record of a fleet, and what the record answers, as messages.
///
///   {"outbox":81,"question":5,"first":false,"after":{"entries":7,"events":2,"results":0},
///    "entries":[[8,"main",900,1772323200,0,12.5,0,0,false],  // number, meter, interval, start,
///                                  // revision, mean, validity, reasons (bits), late
///               [9,"main",900,{"month":"2026-02", …}],       // a closed month
///               [10,"main",900,null]],                       // what damage took
///    "events":[{"number":3,"time":1772323200,"kind":"meter_silent", …}],
///    "results":[{"number":1,"kind":"calibration","state":"done","document":"{…}", …}]}
///   {"outbox":81,"answers":5,"entries":10,"events":3,"results":1}
///
/// Times are seconds since 1970; null is a number that is not known.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/store.hpp"
#include "core/result.hpp"

namespace recald::record {

/// How far the outbox, the events and the finished jobs of a gateway's store have been told.
struct Progress {
  std::int64_t entries = 0;  ///< Number of the last outbox entry.
  std::int64_t events = 0;   ///< Number of the last event.
  std::int64_t results = 0;  ///< Number of the last finished job.

  bool operator==(const Progress&) const = default;
};

/// How far the record has committed the entries of one outbox, which the gateway may then delete.
struct Watermark {
  /// Identity of the outbox: numbers of another mean something else. Negative: of the past that the
  /// store had before. 0: the record has nothing of the site.
  std::int64_t outbox = 0;
  Progress until;
  std::int64_t answers = 0;  ///< The question of the batch that it is about; 0: told unasked.

  bool operator==(const Watermark&) const = default;
};

/// The last number of an outbox of the past, greater than any other: all of it was told.
inline constexpr std::int64_t kHistorySent = std::int64_t{1} << 46;

/// A part of what a gateway's store has, in order.
struct RecordBatch {
  std::int64_t outbox = 0;
  Progress after;             ///< All up to here was told before.
  std::int64_t question = 0;  ///< Comes back with the watermark, so that an old one is no answer.
  bool is_first = false;      ///< The record has confirmed nothing of this outbox yet.
  std::vector<OutboxEntry> entries = {};
  std::vector<StoreEvent> events = {};
  std::vector<StoredJob> results = {};  ///< Finished ones, with their documents.

  /// Where the record is after it.
  [[nodiscard]] Progress until() const;
};

/// "recald/v1/tower-3/batch" and "recald/v1/tower-3/watermark"
[[nodiscard]] std::string batch_topic(std::string_view site);
[[nodiscard]] std::string watermark_topic(std::string_view site);
/// The site of such a topic; empty: another topic.
[[nodiscard]] std::string site_of_topic(std::string_view topic);

/// As JSON, without line breaks; numbers of 64 bits as they are, so that parsing gives the same. A
/// meter's number, and of a job its folder and tries, mean nothing elsewhere and are left out. What
/// is no UTF-8 in a text is replaced.
[[nodiscard]] std::string to_json(const RecordBatch& batch);
[[nodiscard]] std::string to_json(const Watermark& watermark);
/// As the record keeps a month; parsing gives the same to the last bit.
[[nodiscard]] std::string to_json(const StoredMonth& month);

/// @return malformed with a sentence: no JSON, a field that is missing or of another kind, numbers
/// that do not rise. Fields of a newer recald are left out.
[[nodiscard]] Result<RecordBatch> parse_batch(std::string_view json);
[[nodiscard]] Result<Watermark> parse_watermark(std::string_view json);
[[nodiscard]] Result<StoredMonth> parse_stored_month(std::string_view json);

}  // namespace recald::record
