/// Batches and watermarks: read again they are what was written, and anything else is refused.
#include "adapters/record/record_batch.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/random/rng.hpp"

namespace recald::record::record_batch_test {
namespace {

using metering::Instant;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const Instant kMarch = std::chrono::sys_days{std::chrono::year{2026} / 3 / 1};

/// One of each kind, with no value that could be a default.
RecordBatch sample_batch() {
  RecordBatch batch{.outbox = 9'223'372'036'854'775'807,
                    .after = {.entries = 7, .events = 2, .results = 1},
                    .question = 9'223'372'036'854'775'806,
                    .is_first = true};
  const metering::Reading reading{.meter = 0,
                                  .start = kMarch,
                                  .mean_kW = 0.1 + 0.2,
                                  .validity = metering::Validity::suspect,
                                  .reasons = metering::Reason::spike | metering::Reason::manual,
                                  .late = true};
  batch.entries.push_back({.number = 8,
                           .meter = "main",
                           .interval = std::chrono::seconds{900},
                           .stored = StoredInterval{.reading = reading, .revision = 3}});
  const metering::MonthlyFigure figure{
      .month = std::chrono::year{2026} / 2,
      .daily_average_kWh = 240.25,
      .daily_average_variance_kWh2 = 1.5,
      .peak =
          metering::PeakDemand{
              .kW = 31.0, .start = kMarch - metering::kDay, .could_be_exceeded = true},
      .peak_window = std::chrono::seconds{1800},
      .coverage = 0.75,
      .filled_share = 0.125,
      .slots_by_validity = {5, 4, 3, 2, 1},
      .slots = 2688,
      .usable = true,
      .unusable_because = "it is not \"usable\"",
      .reasons = metering::Reason::timeout,
      .revision = 2};
  batch.entries.push_back(
      {.number = 10,
       .meter = "heat",
       .interval = std::chrono::seconds{3600},
       .stored = StoredMonth{
           .figure = figure, .closed_at = kMarch + metering::kDay, .time_zone_release = "2025b"}});
  batch.entries.push_back({.number = 11, .meter = "gas", .interval = std::chrono::seconds{60}});
  batch.events.push_back({.time = kMarch,
                          .severity = Severity::error,
                          .kind = "meter_silent",
                          .subject = "main",
                          .text = "sagt nichts: \xC3\xA4\n",
                          .count = 4,
                          .last = kMarch + std::chrono::hours{1},
                          .number = 3});
  StoredJob job{.number = 2,
                .kind = JobKind::diagnosis,
                .state = JobState::failed,
                .asked_by = "drift",
                .asked = kMarch,
                .started = kMarch + std::chrono::seconds{1},
                .ended = kMarch + std::chrono::seconds{2}};
  job.accepted = true;
  job.message = "too few months";
  job.result.document = R"({"parameters":[{"rhat":1.25}]})";
  batch.results.push_back(job);
  return batch;
}

class RandomBatches {
 public:
  explicit RandomBatches(unsigned seed) : rng_{seed} {}

  RecordBatch next() {
    RecordBatch batch{.outbox = 1 + static_cast<std::int64_t>(rng_.next() >> 1),
                      .after = {number(), number(), number()},
                      .question = number(),
                      .is_first = up_to(1) == 1};
    std::int64_t last = batch.after.entries;
    for (int i = up_to(5); i > 0; --i) batch.entries.push_back(entry(last += 1 + up_to(3)));
    last = batch.after.events;
    for (int i = up_to(3); i > 0; --i) batch.events.push_back(event(last += 1 + up_to(3)));
    last = batch.after.results;
    for (int i = up_to(2); i > 0; --i) batch.results.push_back(job(last += 1 + up_to(3)));
    return batch;
  }

 private:
  int up_to(int max) { return static_cast<int>(rng_.below(static_cast<std::uint64_t>(max) + 1)); }
  std::int64_t number() { return static_cast<std::int64_t>(rng_.next() >> 4); }
  Instant instant() { return kMarch + std::chrono::seconds{up_to(1'000'000'000)}; }
  std::optional<Instant> perhaps_instant() {
    return up_to(1) == 0 ? std::nullopt : std::optional{instant()};
  }
  double value() {
    if (up_to(9) == 0) return kAbsent;
    return std::ldexp(static_cast<double>(rng_.next()), up_to(200) - 150) - 1.0;
  }
  std::string words() {
    std::string text;
    for (int i = up_to(20); i > 0; --i) text += static_cast<char>(1 + up_to(125));
    return text;
  }
  metering::Reason reasons() { return static_cast<metering::Reason>(rng_.next()); }

  OutboxEntry entry(std::int64_t entry_number) {
    OutboxEntry entry{.number = entry_number,
                      .meter = words(),
                      .interval = std::chrono::seconds{1 + up_to(90'000)},
                      .stored = {}};
    const int kind = up_to(3);
    if (kind >= 2) {
      entry.stored = StoredInterval{.reading = {.meter = 0,
                                                .start = instant(),
                                                .mean_kW = value(),
                                                .validity = metering::Validity(up_to(4)),
                                                .reasons = reasons(),
                                                .late = up_to(1) == 1},
                                    .revision = up_to(9)};
    } else if (kind == 1) {
      entry.stored =
          StoredMonth{.figure = figure(), .closed_at = instant(), .time_zone_release = words()};
    }
    return entry;
  }
  metering::MonthlyFigure figure() {
    metering::MonthlyFigure figure{
        .month = std::chrono::year{1990 + up_to(47)} / (1 + up_to(11)),
        .daily_average_kWh = value(),
        .daily_average_variance_kWh2 = value(),
        .peak = {},
        .peak_window = std::chrono::seconds{up_to(3600)},
        .coverage = value(),
        .filled_share = value(),
        .slots_by_validity = {up_to(9), up_to(9), up_to(9), up_to(9), up_to(9)},
        .slots = up_to(3000),
        .usable = up_to(1) == 1,
        .unusable_because = words(),
        .reasons = reasons(),
        .revision = up_to(9)};
    if (up_to(1) == 1) figure.peak = metering::PeakDemand{value(), instant(), up_to(1) == 1};
    return figure;
  }
  StoreEvent event(std::int64_t event_number) {
    return {.time = instant(),
            .severity = Severity(up_to(2)),
            .kind = words(),
            .subject = words(),
            .text = words(),
            .count = up_to(99),
            .last = perhaps_instant(),
            .number = event_number};
  }
  StoredJob job(std::int64_t job_number) {
    StoredJob job{.number = job_number,
                  .kind = JobKind(up_to(1)),
                  .state = JobState(2 + up_to(2)),
                  .asked_by = words(),
                  .asked = instant(),
                  .started = perhaps_instant(),
                  .ended = perhaps_instant()};
    job.accepted = up_to(1) == 1;
    job.message = words();
    job.result.document = words();
    return job;
  }

  Rng rng_;
};

TEST(RecordBatch, EveryFieldComesThrough) {
  const auto read = parse_batch(to_json(sample_batch()));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->outbox, 9'223'372'036'854'775'807);
  EXPECT_EQ(read->after, (Progress{.entries = 7, .events = 2, .results = 1}));
  EXPECT_EQ(read->question, 9'223'372'036'854'775'806);
  EXPECT_TRUE(read->is_first);
  EXPECT_EQ(read->until(), (Progress{.entries = 11, .events = 3, .results = 2}));
  ASSERT_THAT(read->entries, SizeIs(3));
  EXPECT_EQ(read->entries[0].meter, "main");
  EXPECT_EQ(read->entries[0].interval, std::chrono::seconds{900});
  const auto& interval = std::get<StoredInterval>(read->entries[0].stored);
  EXPECT_EQ(interval.revision, 3);
  EXPECT_EQ(interval.reading.start, kMarch);
  EXPECT_EQ(interval.reading.mean_kW, 0.1 + 0.2);
  EXPECT_EQ(interval.reading.validity, metering::Validity::suspect);
  EXPECT_EQ(interval.reading.reasons, metering::Reason::spike | metering::Reason::manual);
  EXPECT_TRUE(interval.reading.late);
  EXPECT_EQ(read->entries[1].number, 10);
  const auto& month = std::get<StoredMonth>(read->entries[1].stored);
  EXPECT_EQ(month.closed_at, kMarch + metering::kDay);
  EXPECT_EQ(month.time_zone_release, "2025b");
  EXPECT_EQ(month.figure.month, std::chrono::year{2026} / 2);
  EXPECT_EQ(month.figure.daily_average_kWh, 240.25);
  EXPECT_EQ(month.figure.daily_average_variance_kWh2, 1.5);
  ASSERT_TRUE(month.figure.peak.has_value());
  EXPECT_EQ(month.figure.peak->kW, 31.0);
  EXPECT_EQ(month.figure.peak->start, kMarch - metering::kDay);
  EXPECT_TRUE(month.figure.peak->could_be_exceeded);
  EXPECT_EQ(month.figure.peak_window, std::chrono::seconds{1800});
  EXPECT_EQ(month.figure.coverage, 0.75);
  EXPECT_EQ(month.figure.filled_share, 0.125);
  EXPECT_THAT(month.figure.slots_by_validity, ::testing::ElementsAre(5, 4, 3, 2, 1));
  EXPECT_EQ(month.figure.slots, 2688);
  EXPECT_TRUE(month.figure.usable);
  EXPECT_EQ(month.figure.unusable_because, "it is not \"usable\"");
  EXPECT_EQ(month.figure.reasons, metering::Reason::timeout);
  EXPECT_EQ(month.figure.revision, 2);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(read->entries[2].stored));
  EXPECT_EQ(read->entries[2].number, 11);
  ASSERT_THAT(read->events, SizeIs(1));
  const StoreEvent& event = read->events[0];
  EXPECT_EQ(event.time, kMarch);
  EXPECT_EQ(event.severity, Severity::error);
  EXPECT_EQ(event.kind, "meter_silent");
  EXPECT_EQ(event.subject, "main");
  EXPECT_EQ(event.text, "sagt nichts: \xC3\xA4\n");
  EXPECT_EQ(event.count, 4);
  EXPECT_EQ(event.last, kMarch + std::chrono::hours{1});
  ASSERT_THAT(read->results, SizeIs(1));
  const StoredJob& job = read->results[0];
  EXPECT_EQ(job.kind, JobKind::diagnosis);
  EXPECT_EQ(job.state, JobState::failed);
  EXPECT_EQ(job.asked_by, "drift");
  EXPECT_EQ(job.asked, kMarch);
  EXPECT_EQ(job.started, kMarch + std::chrono::seconds{1});
  EXPECT_EQ(job.ended, kMarch + std::chrono::seconds{2});
  EXPECT_TRUE(job.accepted);
  EXPECT_EQ(job.message, "too few months");
  EXPECT_EQ(job.result.document, R"({"parameters":[{"rhat":1.25}]})");
  EXPECT_EQ(job.result.rhat_max, 1.25);
}

TEST(RecordBatch, WrittenAgainItIsTheSame) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    const RecordBatch batch = RandomBatches{seed}.next();
    const std::string written = to_json(batch);
    EXPECT_EQ(written.find('\n'), std::string::npos);
    const auto read = parse_batch(written);
    ASSERT_TRUE(read.has_value()) << read.error().message << '\n' << written;
    EXPECT_EQ(to_json(*read), written);
    EXPECT_EQ(read->until(), batch.until());
  }
}

TEST(RecordBatch, WhatIsNoTextIsReplaced) {
  RecordBatch batch = sample_batch();
  batch.events[0].text = "a \xFF piece";
  const auto read = parse_batch(to_json(batch));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->events[0].text, "a \xEF\xBF\xBD piece");
}

TEST(RecordBatch, WhatIsCutIsRefused) {
  const std::string whole = to_json(sample_batch());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(parse_batch(whole.substr(0, size)).has_value()) << size;
  }
}

/// The place of a value, something that cannot stand there, and what is said of it.
struct Wrong {
  const char* pointer;
  json value;
  const char* said;
};

TEST(RecordBatch, WhatIsNotAsItMustBeIsNamed) {
  const std::vector<Wrong> all{
      {"/outbox", 0, "'outbox' is 0"},
      {"/outbox", 9'223'372'036'854'775'808u, "'outbox' is 9223372036854775808; it must"},
      {"/outbox", 1.5, "'outbox' is no whole number"},
      {"/after", 3, "'entries' is missing"},
      {"/after/events", "2", "'events' is no whole number"},
      {"/after/results", -1, "'results' is -1; it must lie between 0 and"},
      {"/entries", json::object(), "'entries' is no list"},
      {"/entries/0", json::array({1, 2}), "entries[0]: 'entry' is no list of 4 or 9 values"},
      {"/entries/0/0", 7, "entries[0]: 'number' is 7 after 7; numbers must rise"},
      {"/entries/1/0", 8, "entries[1]: 'number' is 8 after 8; numbers must rise"},
      {"/entries/0/1", 5, "entries[0]: 'meter' is no text"},
      {"/entries/0/2", 0, "entries[0]: 'interval' is 0; it must lie between 1 and"},
      {"/entries/0/3", 300'000'000'000, "'start' is 300000000000; it must lie between"},
      {"/entries/0/4", -1, "'revision' is -1"},
      {"/entries/0/5", "much", "'mean_kW' is no number"},
      {"/entries/0/6", 5, "'validity' is 5; it must lie between 0 and 4"},
      {"/entries/0/7", 4'294'967'296, "'reasons' is 4294967296"},
      {"/entries/0/8", 1, "'late' is neither true nor false"},
      {"/entries/1/3", "march", "entries[1]: 'month' is missing"},
      {"/entries/1/3/month", "2026-13", "'month' is no month such as \"2026-03\""},
      {"/entries/1/3/peak", 1, "'kW' is missing"},
      {"/entries/1/3/slots_by_validity", json::array({1, 2, 3, 4}), "is no list of 5 numbers"},
      {"/entries/1/3/slots_by_validity/4", -1, "'slots_by_validity' is -1"},
      {"/events/0/number", 2, "events[0]: 'number' is 2 after 2; numbers must rise"},
      {"/events/0/severity", 3, "'severity' is 3; it must lie between 0 and 2"},
      {"/events/0/last", false, "events[0]: 'last' is no whole number"},
      {"/results/0/number", 1, "results[0]: 'number' is 1 after 1; numbers must rise"},
      {"/results/0/kind", "guess",
       "results[0]: 'kind' is \"guess\"; it must be one of calibration, diagnosis"},
      {"/results/0/state", "running",
       "results[0]: 'state' is \"running\"; it must be one of done, failed, cancelled"},
      {"/results/0/accepted", nullptr, "'accepted' is neither true nor false"},
      {"/results/0/document", nullptr, "'document' is no text"}};
  const json good = json::parse(to_json(sample_batch()));
  for (const Wrong& wrong : all) {
    SCOPED_TRACE(wrong.pointer);
    json changed = good;
    changed[json::json_pointer{wrong.pointer}] = wrong.value;
    const auto read = parse_batch(changed.dump());
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(read.error().code, ErrorCode::malformed);
    EXPECT_THAT(read.error().message, AllOf(HasSubstr("the batch: "), HasSubstr(wrong.said)));
  }
}

TEST(RecordBatch, EveryFieldIsNeeded) {
  const json good = json::parse(to_json(sample_batch()));
  int missing = 0;
  for (const char* place :
       {"", "/after", "/entries/1/3", "/entries/1/3/peak", "/events/0", "/results/0"}) {
    const json::json_pointer object{place};
    for (const auto& [key, value] : good[object].items()) {
      json changed = good;
      changed[object].erase(key);
      const auto read = parse_batch(changed.dump());
      ASSERT_FALSE(read.has_value()) << place << '/' << key;
      EXPECT_THAT(read.error().message, HasSubstr("'" + key + "' is missing"));
      ++missing;
    }
  }
  EXPECT_EQ(missing, 7 + 3 + 15 + 3 + 8 + 10);
}

// Whatever a gateway writes into a text, the record is not filled by it; a result's document alone
// is as long as its message.
TEST(RecordBatch, NoTextButADocumentIsLongerThanItsLimit) {
  const json good = json::parse(to_json(sample_batch()));
  const json flat = good.flatten();
  int texts = 0;
  for (const auto& [place, value] : flat.items()) {
    if (!value.is_string() || place.ends_with("/document")) continue;
    json changed = good;
    changed[json::json_pointer{place}] = std::string(100'000, 'x');
    ++texts;
    if (const auto read = parse_batch(changed.dump())) {
      EXPECT_LT(to_json(*read).size(), 20'000u) << place;
    }
  }
  EXPECT_GT(texts, 10);
}

TEST(RecordBatch, AWatermarkIsTheSameAgain) {
  const Watermark watermark{
      .outbox = 123, .until = {.entries = 500, .events = 3, .results = 1}, .answers = 17};
  const std::string written = to_json(watermark);
  EXPECT_EQ(written, R"({"outbox":123,"answers":17,"entries":500,"events":3,"results":1})");
  EXPECT_EQ(parse_watermark(written).value(), watermark);
  EXPECT_THAT(parse_watermark("nonsense").error().message, HasSubstr("is no JSON object"));
  EXPECT_THAT(parse_watermark(R"({"outbox":0,"entries":1,"events":1})").error().message,
              HasSubstr("the watermark: 'results' is missing"));
}

TEST(RecordBatch, TopicsHaveTheSite) {
  EXPECT_EQ(batch_topic("tower-3"), "recald/v1/tower-3/batch");
  EXPECT_EQ(watermark_topic("tower-3"), "recald/v1/tower-3/watermark");
  EXPECT_EQ(site_of_topic(batch_topic("tower-3")), "tower-3");
  EXPECT_EQ(site_of_topic(watermark_topic("tower-3")), "tower-3");
  for (const char* other : {"recald/v1/tower-3", "recald/v1/a/b/batch", "recald/tower-3/batch",
                            "recald/v1//batch", "recald/v1/tower-3/batch/", ""}) {
    EXPECT_EQ(site_of_topic(other), "") << other;
  }
}

}  // namespace
}  // namespace recald::record::record_batch_test
