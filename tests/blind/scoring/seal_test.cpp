#include "tests/blind/scoring/seal.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::blind {
namespace {

class Seals : public ::testing::Test {
 protected:
  Seals() {
    for (const char* name : {"b", "a"}) {
      // A seal looks at bytes, not at what they mean.
      testing::write_text(file(name), std::string("answer ") + name);
    }
    whole_ = seal_answers(folder_.path()).value();
  }

  [[nodiscard]] std::filesystem::path file(const std::string& name) const {
    return folder_ / (name + ".json");
  }
  [[nodiscard]] std::filesystem::path seal() const { return folder_ / "answers.sha256"; }

  void expect_refused(ErrorCode code, const std::string& message,
                      const std::optional<std::string>& published = std::nullopt) {
    const auto verified = verify_seal(folder_.path(), published);
    ASSERT_FALSE(verified.has_value());
    EXPECT_EQ(verified.error().code, code);
    EXPECT_EQ(verified.error().message, message);
  }

  testing::TemporaryFolder folder_;
  std::string whole_;
};

TEST_F(Seals, IsWhatSha256sumPrintsAndALineForTheWhole) {
  const std::string lines = hash_of(testing::read_text(file("a"))) + "  a.json\n" +
                            hash_of(testing::read_text(file("b"))) + "  b.json\n";
  EXPECT_EQ(testing::read_text(seal()), lines + "# whole " + hash_of(lines) + "\n");
  EXPECT_EQ(whole_, hash_of(lines));
}

// FIPS 180-2, appendix B.1.
TEST_F(Seals, HashIsSha256) {
  EXPECT_EQ(hash_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(Seals, UntouchedAnswersPass) {
  EXPECT_EQ(verify_seal(folder_.path(), std::nullopt).value(), whole_);
  EXPECT_EQ(verify_seal(folder_.path(), whole_).value(), whole_);
}

TEST_F(Seals, EveryChangedByteOfAnAnswerIsRefused) {
  const std::string text = testing::read_text(file("b"));
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    testing::write_text(file("b"), changed);
    ASSERT_FALSE(verify_seal(folder_.path(), std::nullopt).has_value()) << at;
  }
  expect_refused(ErrorCode::invalid_value, file("b").string() +
                                               ": the answer was changed after it was sealed; not "
                                               "opened");
}

TEST_F(Seals, EveryChangedByteOfTheSealIsRefused) {
  const std::string text = testing::read_text(seal());
  for (std::size_t at = 0; at + 1 < text.size(); ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    testing::write_text(seal(), changed);
    ASSERT_FALSE(verify_seal(folder_.path(), std::nullopt).has_value()) << at;
  }
}

TEST_F(Seals, ASealCutAnywhereIsRefused) {
  const std::string text = testing::read_text(seal());
  // Only the last line feed may be missing.
  for (std::size_t size = 0; size + 1 < text.size(); ++size) {
    testing::write_text(seal(), text.substr(0, size));
    ASSERT_FALSE(verify_seal(folder_.path(), std::nullopt).has_value()) << size;
  }
}

TEST_F(Seals, AMissingAnswerIsNamed) {
  std::filesystem::remove(file("a"));
  expect_refused(ErrorCode::not_found, "cannot open '" + file("a").string() + "'");
}

TEST_F(Seals, AnAnswerAddedLaterIsNamed) {
  testing::write_text(file("c"), "answer c");
  expect_refused(
      ErrorCode::invalid_value,
      file("c").string() + ": the answer was added after the others were sealed; not opened");
}

// Answers and seal exchanged together fit each other; only the published hash tells.
TEST_F(Seals, ASecondSealDiffersFromThePublishedHash) {
  testing::write_text(file("a"), "another answer");
  std::filesystem::remove(seal());
  const std::string second = seal_answers(folder_.path()).value();
  EXPECT_TRUE(verify_seal(folder_.path(), std::nullopt).has_value());
  expect_refused(ErrorCode::invalid_value,
                 seal().string() + ": the whole is " + second + ", but " + whole_ +
                     " was published; not opened",
                 whole_);
}

TEST_F(Seals, AWrongWholeIsNamed) {
  std::string text = testing::read_text(seal());
  text.replace(text.find("# whole ") + 8, 64, std::string(64, '0'));
  testing::write_text(seal(), text);
  expect_refused(ErrorCode::invalid_value,
                 seal().string() + ": its last line is not the hash of the others; not opened");
}

TEST_F(Seals, LinesThatCannotBeReadAreNamed) {
  testing::write_text(seal(), "hello\n");
  expect_refused(ErrorCode::malformed, seal().string() + " line 1: not '<64 hex digits>  <file>'");
  testing::write_text(seal(), "");
  expect_refused(ErrorCode::malformed,
                 seal().string() + ": the last line must be '# whole <64 hex digits>'");
}

TEST_F(Seals, IsMadeOnce) {
  const auto again = seal_answers(folder_.path());
  ASSERT_FALSE(again.has_value());
  EXPECT_EQ(again.error().message,
            seal().string() + ": sealed already; a second seal would hide a change");
}

TEST_F(Seals, OpeningsAreKeptInOrder) {
  using std::chrono::sys_seconds;
  EXPECT_TRUE(earlier_openings(folder_.path()).value().empty());
  for (const int hour : {0, 1}) {
    const Opening opening{.at = sys_seconds{std::chrono::hours{24 * 365 + hour}},
                          .scorer_version = "recald 0.1.0",
                          .whole_hash = whole_,
                          .results_hash = "r",
                          .cases_of_version = {{"recald 0.1.0", 2}}};
    ASSERT_TRUE(record_opening(folder_.path(), opening).has_value());
  }
  EXPECT_EQ(earlier_openings(folder_.path()).value(),
            (std::vector<std::string>{"1971-01-01T00:00:00Z", "1971-01-01T01:00:00Z"}));
  EXPECT_TRUE(verify_seal(folder_.path(), whole_).has_value());
}

TEST_F(Seals, ARecordThatCannotBeReadIsNotOverwritten) {
  const auto record = folder_ / "opened.json";
  for (const char* text : {"{}", "[{}]", "[{\"opened_at\": 5}]"}) {
    testing::write_text(record, text);
    const auto recorded = record_opening(folder_.path(), {});
    ASSERT_FALSE(recorded.has_value());
    EXPECT_EQ(recorded.error().message,
              record.string() + ": must be a list of openings, each with 'opened_at'");
    EXPECT_EQ(testing::read_text(record), text);
  }
}

}  // namespace
}  // namespace recald::blind
