#include "adapters/models/model_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "adapters/models/version_file.hpp"
#include "adapters/system/files/sha256.hpp"
#include "tests/adapters/models/sample_version.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::models {
namespace {

namespace fs = std::filesystem;
using diagnosis::ModelVersion;
using diagnosis::short_version;
using diagnosis::VersionStatus;
using recald::testing::heat_meter_scale;
using recald::testing::night_setback;
using recald::testing::read_text;
using recald::testing::sample_version;
using recald::testing::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr const char* kAt = "2021-04-01T00:00:00Z";

template <class T>
std::string sentence(const Result<T>& result) {
  return result ? "no error" : result.error().message;
}

class Models : public ::testing::Test {
 protected:
  /// Drawings <- first <- second; second in force.
  void add_two() {
    first_ = *store_.save(sample_version("drawings", {night_setback()}));
    first_ = *store_.activate(first_.version, kAt);
    second_ = *store_.save(sample_version(first_.version, {night_setback(), heat_meter_scale()},
                                          "2021-03-02T05:00:00Z"));
    second_ = *store_.activate(second_.version, kAt);
  }
  [[nodiscard]] fs::path file_of(const ModelVersion& version) const {
    return store_.folder() / (version.version + ".json");
  }
  [[nodiscard]] VersionStatus status_of(const ModelVersion& version) const {
    return store_.load(version.version)->status;
  }

  recald::testing::TemporaryFolder folder_;
  ModelStore store_{folder_ / "site.toml", "depot"};
  ModelVersion first_;
  ModelVersion second_;
};

TEST_F(Models, SiteThatWasNeverChangedIsAsTheDrawingsHaveItAndGetsNoFolder) {
  EXPECT_EQ(store_.active()->version, "drawings");
  EXPECT_THAT(store_.active()->effects, IsEmpty());
  EXPECT_EQ(store_.list()->versions, std::vector{diagnosis::base_version("depot")});
  EXPECT_EQ(store_.folder(), folder_ / "site.models");
  EXPECT_FALSE(fs::exists(store_.folder()));
}

TEST_F(Models, WhatIsSavedComesBackBitByBit) {
  ModelVersion version = sample_version("drawings", {night_setback(), heat_meter_scale()});
  const auto saved = store_.save(version);
  ASSERT_TRUE(saved.has_value()) << saved.error().message;
  EXPECT_EQ(saved->version.size(), 64u);
  version.version = saved->version;
  EXPECT_EQ(*store_.load(saved->version), version);
  EXPECT_EQ(*store_.load(short_version(saved->version)), version);
}

// Who saves the same finding twice must not have two models, nor lose what became of the first.
TEST_F(Models, EqualContentIsOneVersionWhateverItsTimeAndStatus) {
  const auto one = store_.save(sample_version("drawings", {night_setback()}));
  ASSERT_TRUE(store_.activate(one->version, kAt).has_value());
  const auto other =
      store_.save(sample_version("drawings", {night_setback()}, "2022-01-01T00:00:00Z"));
  EXPECT_EQ(other->version, one->version);
  EXPECT_EQ(other->created_at, one->created_at);
  EXPECT_EQ(other->status, VersionStatus::accepted);
  auto changed = night_setback();
  changed.parameters[0].draws[1] = std::nextafter(changed.parameters[0].draws[1], 1.0);
  EXPECT_NE(store_.save(sample_version("drawings", {changed}))->version, one->version);
}

TEST_F(Models, ParentMayBeShortAndMustBeThere) {
  const auto one = store_.save(sample_version("drawings", {night_setback()}));
  EXPECT_EQ(store_.save(sample_version(short_version(one->version), {heat_meter_scale()}))->parent,
            one->version);
  const auto orphan = store_.save(sample_version("feedbeef", {heat_meter_scale()}));
  ASSERT_FALSE(orphan.has_value());
  EXPECT_EQ(orphan.error().code, ErrorCode::not_found);
}

TEST_F(Models, NumbersThatAreNoneAreRefused) {
  auto effect = night_setback();
  effect.parameters[1].draws[2] = std::numeric_limits<double>::quiet_NaN();
  const auto saved = store_.save(sample_version("drawings", {effect}));
  ASSERT_FALSE(saved.has_value());
  EXPECT_EQ(saved.error().code, ErrorCode::not_finite);
  EXPECT_EQ(saved.error().message,
            "effect night_setback_missing: one of its numbers is not finite");
}

TEST_F(Models, DrawsThatAreNotJointAreRefused) {
  auto effect = night_setback();
  effect.parameters[1].draws.pop_back();
  EXPECT_EQ(sentence(store_.save(sample_version("drawings", {effect}))),
            "effect night_setback_missing: parameter slope has 2 draws where share has 3");
}

TEST_F(Models, TextThatIsNotUtf8IsRefused) {
  auto effect = night_setback();
  effect.title = "caf\xe9";
  EXPECT_EQ(store_.save(sample_version("drawings", {effect})).error().code,
            ErrorCode::invalid_value);
}

TEST_F(Models, ActivationIsAcceptanceAndGoesIntoTheHistory) {
  add_two();
  EXPECT_EQ(store_.active()->version, second_.version);
  EXPECT_EQ(status_of(first_), VersionStatus::accepted);
  EXPECT_EQ(read_text(store_.folder() / "history.jsonl"),
            "{\"at\":\"2021-04-01T00:00:00Z\",\"action\":\"activate\",\"from\":\"drawings\","
            "\"to\":\"" +
                first_.version +
                "\"}\n"
                "{\"at\":\"2021-04-01T00:00:00Z\",\"action\":\"activate\",\"from\":\"" +
                first_.version + "\",\"to\":\"" + second_.version + "\"}\n");
  EXPECT_EQ(sentence(store_.activate(second_.version, kAt)),
            "version " + short_version(second_.version) + " is in force already");
}

TEST_F(Models, ListHasDrawingsFirstThenTheOldest) {
  add_two();
  const auto list = store_.list();
  ASSERT_EQ(list->versions.size(), 3u);
  EXPECT_EQ(list->versions[0].version, "drawings");
  EXPECT_EQ(list->versions[1].version, first_.version);
  EXPECT_EQ(list->versions[2].version, second_.version);
  EXPECT_EQ(list->active, second_.version);
}

TEST_F(Models, RevertGoesToTheParentAndKeepsWhatItLeaves) {
  add_two();
  EXPECT_EQ(store_.revert("", kAt)->version, first_.version);
  EXPECT_EQ(store_.active()->effects, first_.effects);
  EXPECT_EQ(status_of(second_), VersionStatus::reverted);
  EXPECT_EQ(status_of(first_), VersionStatus::accepted);
  EXPECT_THAT(read_text(store_.folder() / "history.jsonl"), HasSubstr("\"action\":\"revert\""));
}

TEST_F(Models, RevertPastAnotherMarksBothAndForwardAgainAcceptsOne) {
  add_two();
  EXPECT_EQ(store_.revert("drawings", kAt)->version, "drawings");
  EXPECT_EQ(status_of(first_), VersionStatus::reverted);
  EXPECT_EQ(status_of(second_), VersionStatus::reverted);
  EXPECT_EQ(store_.revert(short_version(second_.version), kAt)->status, VersionStatus::accepted);
  EXPECT_EQ(store_.active()->version, second_.version);
}

TEST_F(Models, RevertOfTheDrawingsIsOneSentence) {
  for (const char* target : {"", "drawings"}) {
    EXPECT_EQ(sentence(store_.revert(target, kAt)),
              "the model is as the drawings have it already; there is nothing to revert");
  }
}

TEST_F(Models, RevertToWhatIsInForceOrNeverWasIsOneSentence) {
  add_two();
  EXPECT_EQ(sentence(store_.revert(second_.version, kAt)),
            "version " + short_version(second_.version) + " is in force already");
  const auto proposed = store_.save(sample_version("drawings", {heat_meter_scale()}));
  EXPECT_EQ(sentence(store_.revert(proposed->version, kAt)),
            "version " + short_version(proposed->version) +
                " was proposed and never in force; `recald model apply` puts it in force");
  EXPECT_EQ(store_.active()->version, second_.version);
}

TEST_F(Models, UnknownVersionNamesTheKnownOnes) {
  const auto one = store_.save(sample_version("drawings", {night_setback()}));
  const auto unknown = store_.load("xyz");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().code, ErrorCode::not_found);
  EXPECT_EQ(unknown.error().message,
            "the model of site 'depot' has no version 'xyz'; it has "
            "drawings, " +
                short_version(one->version));
  // Three digits are too few even where they would do.
  EXPECT_FALSE(store_.load(one->version.substr(0, 3)).has_value());
  EXPECT_TRUE(store_.load(one->version.substr(0, 4)).has_value());
}

TEST_F(Models, DigitsThatFitTwoVersionsAreRefused) {
  fs::create_directories(store_.folder());
  write_text(store_.folder() / (std::string(63, 'a') + "1.json"), "");
  write_text(store_.folder() / (std::string(63, 'a') + "2.json"), "");
  const auto loaded = store_.load("aaaaaa");
  ASSERT_FALSE(loaded.has_value());
  EXPECT_EQ(loaded.error().code, ErrorCode::invalid_value);
  EXPECT_THAT(loaded.error().message, StartsWith("'aaaaaa' begins 2 versions: aaa"));
}

TEST_F(Models, FileCutAnywhereIsOneSentence) {
  const auto saved = store_.save(sample_version("drawings", {night_setback(), heat_meter_scale()}));
  const std::string whole = read_text(file_of(*saved));
  ASSERT_EQ(whole.back(), '\n');  // the one byte that may be missing
  for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
    write_text(file_of(*saved), whole.substr(0, length));
    const auto loaded = store_.load(saved->version);
    ASSERT_FALSE(loaded.has_value()) << length;
    ASSERT_EQ(loaded.error().code, ErrorCode::malformed);
    ASSERT_EQ(loaded.error().message, "'" + file_of(*saved).string() +
                                          "' is damaged: it is no JSON object, or ends too early");
  }
}

TEST_F(Models, FileWithAnyByteChangedIsRefusedOrMeansTheSame) {
  const auto saved = store_.save(sample_version("drawings", {night_setback()}));
  const std::string whole = read_text(file_of(*saved));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    write_text(file_of(*saved), damaged);
    auto loaded = store_.load(saved->version);
    if (!loaded) continue;
    loaded->created_at = saved->created_at;  // not under the name: it may differ
    ASSERT_EQ(*loaded, *saved) << i << " " << whole[i];
  }
}

TEST_F(Models, ContentOfAnotherVersionIsRefused) {
  add_two();
  fs::copy_file(file_of(first_), file_of(second_), fs::copy_options::overwrite_existing);
  EXPECT_EQ(sentence(store_.active()),
            "'" + file_of(second_).string() + "' is damaged: its content does not match its name");
}

TEST_F(Models, StatusThatIsNoneIsRefused) {
  add_two();
  std::string text = read_text(file_of(first_));
  text.replace(text.find("\"accepted\""), 10, "\"acclaimed\"");
  write_text(file_of(first_), text);
  EXPECT_THAT(sentence(store_.load(first_.version)),
              HasSubstr("'status' is \"acclaimed\"; it must be one of proposed, accepted, retired, "
                        "reverted"));
}

/// A file that is called by its content, whoever wrote it.
TEST_F(Models, ANumberThatIsNullIsRefused) {
  add_two();
  auto json = nlohmann::json::parse(read_text(file_of(first_)));
  json["effects"][0]["probability"] = nullptr;
  nlohmann::json content = json;
  for (const char* key : {"version", "status", "created_at"}) content.erase(key);
  system::Sha256 digest;
  digest.add(content.dump());
  const std::string name = digest.hex();
  json["version"] = name;
  write_text(store_.folder() / (name + ".json"), json.dump());
  EXPECT_THAT(sentence(store_.load(name)), HasSubstr("one of its numbers is not finite"));
}

TEST_F(Models, DamageIsListedAndOneCanLeaveIt) {
  add_two();
  write_text(file_of(second_), "{");
  const auto list = store_.list();
  ASSERT_EQ(list->versions.size(), 2u);
  EXPECT_THAT(list->damaged, ElementsAre(HasSubstr(second_.version + ".json' is damaged")));
  EXPECT_FALSE(store_.active().has_value());
  EXPECT_FALSE(store_.revert("", kAt).has_value());  // nobody knows the parent
  EXPECT_EQ(store_.revert(first_.version, kAt)->version, first_.version);
  EXPECT_EQ(store_.active()->version, first_.version);
}

TEST_F(Models, DamagedParentDoesNotHoldAnybody) {
  add_two();
  write_text(file_of(first_), "");
  EXPECT_EQ(store_.revert("drawings", kAt)->version, "drawings");
  EXPECT_EQ(status_of(second_), VersionStatus::reverted);
}

TEST_F(Models, ActiveThatNamesNoVersionIsOneSentence) {
  add_two();
  write_text(store_.folder() / "active", "yesterday's\n");
  EXPECT_THAT(sentence(store_.active()), HasSubstr("active' is damaged: it names no version"));
  EXPECT_EQ(store_.revert(first_.version, kAt)->version, first_.version);
  EXPECT_EQ(store_.active()->version, first_.version);
}

TEST_F(Models, FolderThatCannotBeMadeIsOneSentence) {
  write_text(store_.folder(), "a file in its place");
  EXPECT_EQ(sentence(store_.save(sample_version("drawings", {night_setback()}))),
            "cannot create folder '" + store_.folder().string() + "': Not a directory");
  EXPECT_EQ(sentence(store_.list()),
            "cannot read folder '" + store_.folder().string() + "': Not a directory");
}

// Each file of a revert in turn cannot be written: the model stays as it was, and the same command
// succeeds once it can.
TEST_F(Models, RevertThatCannotWriteLeavesTheModelAsItWas) {
  add_two();
  for (const fs::path& file :
       {file_of(second_), store_.folder() / "history.jsonl", store_.folder() / "active"}) {
    const fs::path obstacle = file.string() + ".part";
    fs::create_directory(obstacle);
    const auto reverted = store_.revert("", kAt);
    ASSERT_FALSE(reverted.has_value());
    EXPECT_EQ(reverted.error().code, ErrorCode::io_failed);
    EXPECT_THAT(reverted.error().message, StartsWith("cannot write '" + file.string()));
    EXPECT_EQ(store_.active()->version, second_.version);
    fs::remove(obstacle);
  }
  EXPECT_EQ(store_.revert("", kAt)->version, first_.version);
}

}  // namespace
}  // namespace recald::models
