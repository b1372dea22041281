/// A recording, replayed, gives what the recorded gateway gave: the same intervals, months and
/// events, byte for byte. What cannot be replayed is refused, and what comes out differently is
/// said.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "adapters/stores/open.hpp"
#include "tests/daemon/gateway/recording/recorded_life.hpp"

namespace recald::daemon::recording_test {
namespace {

using recald::daemon::testing::RecordedLife;
using recald::daemon::testing::replay_text;
using recald::testing::read_text;
using std::chrono::hours;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::unique_ptr<Store> empty_store() { return stores::open_in_memory().value(); }

class OfASeed : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(OfASeed, GivesTheSameToTheLastByte) {
  RecordedLife life{GetParam()};
  if (GetParam() % 3 != 0) life.live(hours{36});  // else its store is empty
  life.record(hours{72});
  EXPECT_THAT(life.ended(), IsEmpty());
  auto store = empty_store();
  const auto replayed = replay_text(read_text(life.file()), *store);
  ASSERT_TRUE(replayed.has_value()) << replayed.error().message;
  EXPECT_GT(replayed->intervals, 500U);
  EXPECT_EQ(replayed->different, 0U) << replayed->first_difference;
  const auto recorded = life.texts();
  const auto again = life.texts(*store);
  EXPECT_THAT(recorded.months, HasSubstr("2024-02"));
  EXPECT_THAT(recorded.events,
              AllOf(Contains(HasSubstr("clock_set")), Contains(HasSubstr("main"))));
  EXPECT_EQ(again.readings, recorded.readings);
  EXPECT_EQ(again.months, recorded.months);
  // Of those before the recording, it has only what later ones are counted with.
  const std::size_t since = recorded.events.size() - life.events_before();
  ASSERT_GE(again.events.size(), since);
  const std::size_t known = again.events.size() - since;
  EXPECT_LE(known, life.events_before());
  for (std::size_t i = 0; i < again.events.size(); ++i) {
    if (i < known) {
      EXPECT_THAT(recorded.events, Contains(again.events[i]));
    } else {
      EXPECT_EQ(again.events[i], recorded.events[life.events_before() + i - known]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Replay, OfASeed, ::testing::Range<std::uint64_t>(1, 13),
                         [](const auto& one) { return "Seed" + std::to_string(one.param); });

/// One recording for the tests that change it.
const std::string& recorded() {
  static const std::string kText = [] {
    RecordedLife life{4};
    life.record(hours{3});
    return read_text(life.file());
  }();
  return kText;
}

/// The same with the first text of that kind replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = recorded();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refusal_of(const std::string& text) {
  auto store = empty_store();
  const auto replayed = replay_text(text, *store);
  return replayed ? "it was replayed" : replayed.error().message;
}

TEST(Replay, NamesTimeAndMeterOfAReadThatThisProgramDoesNotMake) {
  EXPECT_THAT(refusal_of(with(R"("address":0,)", R"("address":1,)")),
              AllOf(HasSubstr("recording.jsonl:"), HasSubstr("at 2024-02-28T00:00:0"),
                    HasSubstr("which this recald does not read"), HasSubstr("meter '")));
  EXPECT_THAT(refusal_of(with(R"("read":"main")", R"("read":"mean")")), HasSubstr("meter 'mean'"));
}

TEST(Replay, SaysWhichIntervalComesOutDifferently) {
  // What was stored is another value than what the registers give.
  const std::string text = recorded();
  const std::size_t line = text.find("{\"stored\":\"cooling\"");
  ASSERT_NE(line, std::string::npos);
  const std::size_t value = text.find(',', text.find("[[", line)) + 1;
  auto store = empty_store();
  const auto replayed = replay_text(std::string{text}.insert(value, "1"), *store);
  ASSERT_TRUE(replayed.has_value()) << replayed.error().message;
  EXPECT_EQ(replayed->different, 1U);
  EXPECT_THAT(replayed->first_difference, AllOf(HasSubstr("meter 'cooling' at 2024-02-28T"),
                                                HasSubstr("recorded 1"), HasSubstr("now ")));
}

TEST(Replay, SaysWhichIntervalTheRecordedProgramDidNotMake) {
  std::string text = recorded();
  const std::size_t line = text.find("{\"stored\":\"cooling\"");
  ASSERT_NE(line, std::string::npos);
  text.erase(line, text.find('\n', line) + 1 - line);
  auto store = empty_store();
  const auto replayed = replay_text(text, *store);
  ASSERT_TRUE(replayed.has_value()) << replayed.error().message;
  EXPECT_GE(replayed->different, 1U);
  EXPECT_THAT(replayed->first_difference,
              AllOf(HasSubstr("meter 'cooling' at"), HasSubstr("recorded nothing, now ")));
}

TEST(Replay, RefusesAFormatOfTheFutureWithASentence) {
  EXPECT_THAT(refusal_of(with(R"("recald_recording":1)", R"("recald_recording":2)")),
              HasSubstr("recording.jsonl:1: it was written by a newer recald (format 2"));
}

TEST(Replay, NamesTheLineThatIsWrong) {
  const std::string text = recorded();
  const std::size_t second = text.find('\n') + 1;
  EXPECT_THAT(refusal_of(std::string{text}.insert(second, "\x1b[2J nonsense\n")),
              HasSubstr("recording.jsonl:2: it is no JSON object"));
  EXPECT_THAT(refusal_of(std::string{text}.insert(second, std::string(1'100'000, '[') + "\n")),
              HasSubstr("recording.jsonl:2: the line is longer than a megabyte"));
  EXPECT_THAT(refusal_of(text + text), HasSubstr("another recording begins here"));
  EXPECT_THAT(refusal_of("{\"end\":\"\",\"whole\":true}\n"),
              HasSubstr("begins with \"recald_recording\""));
  EXPECT_THAT(refusal_of(""), HasSubstr("ends before the gateway has begun"));
  EXPECT_THAT(refusal_of(with("\"monotonic_ms\":", "\"monotonic_ms\":999999999")),
              HasSubstr("'monotonic_ms' runs back"));
}

// A kill leaves the beginning of a recording, cut anywhere.
TEST(Replay, TakesWhatAKillHasLeft) {
  const std::string text = recorded();
  const std::size_t begun = text.find("\"start\":true");
  ASSERT_NE(begun, std::string::npos);
  Rng rng{1};
  for (int i = 0; i < 60; ++i) {
    const std::size_t length = rng.below(text.size());
    SCOPED_TRACE(length);
    auto store = empty_store();
    const auto replayed = replay_text(text.substr(0, length), *store);
    if (length <= begun) {
      EXPECT_FALSE(replayed.has_value());
      continue;
    }
    if (text.find('\n', begun) >= length) continue;  // just now
    ASSERT_TRUE(replayed.has_value()) << replayed.error().message;
    EXPECT_EQ(replayed->different, 0U) << replayed->first_difference;
    EXPECT_THAT(replayed->remarks, Contains(HasSubstr("the recording has no end")));
    EXPECT_EQ(text[length - 1] != '\n',
              ::testing::Value(replayed->remarks, Contains(HasSubstr("cut off"))));
  }
}

TEST(Recording, HasNothingOfWhatIsSecret) {
  EXPECT_THAT(recorded(), AllOf(HasSubstr("hot_water"), HasSubstr("counter.toml")));
  for (const char* const word : {"secret", "somebody", "example.org", "alerts", "listen"}) {
    EXPECT_THAT(recorded(), Not(HasSubstr(word)));
  }
}

TEST(Recording, EndsAtItsLimitAndSaysSoOnce) {
  constexpr std::uint64_t kLimit_bytes = 200'000;
  RecordedLife life{5};
  life.record(hours{24}, kLimit_bytes);
  EXPECT_THAT(life.ended(), ElementsAre(HasSubstr("its limit")));
  const std::string text = read_text(life.file());
  EXPECT_GT(text.size(), kLimit_bytes / 2);
  EXPECT_LT(text.size(), kLimit_bytes + 200);
  auto store = empty_store();
  const auto replayed = replay_text(text, *store);
  ASSERT_TRUE(replayed.has_value()) << replayed.error().message;
  EXPECT_EQ(replayed->different, 0U) << replayed->first_difference;
  EXPECT_THAT(replayed->remarks, Contains(HasSubstr("its limit")));
}

// As on a full disk: what stands there can be replayed, and the gateway has gone on.
TEST(Recording, OnAFullDiskEndsWithAWholeLine) {
  constexpr rlim_t kDisk_bytes = 150'000;
  const auto was = std::signal(SIGXFSZ, SIG_IGN);
  rlimit all{};
  ::getrlimit(RLIMIT_FSIZE, &all);
  RecordedLife life{6};
  const rlimit little{kDisk_bytes, all.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &little);
  life.record(hours{24});
  ::setrlimit(RLIMIT_FSIZE, &all);
  std::signal(SIGXFSZ, was);
  EXPECT_THAT(life.ended(), ElementsAre(HasSubstr("cannot be written")));
  EXPECT_THAT(life.texts().readings, HasSubstr("2024-02-28T20:00:00Z,cooling"));
  const std::string text = read_text(life.file());
  EXPECT_TRUE(text.ends_with("}\n"));
  auto store = empty_store();
  const auto replayed = replay_text(text, *store);
  ASSERT_TRUE(replayed.has_value()) << replayed.error().message;
  EXPECT_EQ(replayed->different, 0U) << replayed->first_difference;
}

TEST(Recording, IsNeverWrittenOver) {
  recald::testing::TemporaryFolder folder;
  recald::testing::write_text(folder / "it", "of before");
  EXPECT_FALSE(recording::Recorder::create(folder / "it", 1'000, {}).has_value());
  EXPECT_EQ(read_text(folder / "it"), "of before");
}

}  // namespace
}  // namespace recald::daemon::recording_test
