/// The maker as a whole: bytes, seals, resumption, and files that recald takes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "tests/blind/scoring/answers.hpp"
#include "tests/blind/scoring/seal.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::blind {
namespace {

namespace fs = std::filesystem;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;

struct Ran {
  int exit_code;
  std::string out;
  std::string err;
};

Ran run(const TemporaryFolder& folder, const std::string& command) {
  const int status = std::system(
      (command + " >" + (folder / "stdout").string() + " 2>" + (folder / "stderr").string())
          .c_str());
  return {WEXITSTATUS(status), read_text(folder / "stdout"), read_text(folder / "stderr")};
}

Ran make(const TemporaryFolder& folder, const std::string& arguments) {
  return run(folder, std::string(BLIND_MAKE_PROGRAM) + " " + arguments);
}

/// All files below, by their path, as one text.
std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = read_text(entry.path());
  }
  return files;
}

/// The smoke population of twelve cases, made once for all tests here.
class Smoke : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    made_ = new Ran(make(
        *folder_, "--population smoke --seed 1 --twins --out " + (*folder_ / "whole").string()));
  }
  static void TearDownTestSuite() {
    delete folder_;
    delete made_;
  }
  static fs::path whole() { return *folder_ / "whole"; }

  static TemporaryFolder* folder_;
  static Ran* made_;
};
TemporaryFolder* Smoke::folder_ = nullptr;
Ran* Smoke::made_ = nullptr;

TEST_F(Smoke, IsSealedBeforeAnybodyReadsACase) {
  ASSERT_EQ(made_->exit_code, 0) << made_->err;
  const auto hash = verify_seal(whole() / "answers", std::nullopt);
  ASSERT_TRUE(hash.has_value()) << hash.error().message;
  EXPECT_THAT(made_->out, HasSubstr(*hash));
  const auto answers = read_answers(whole() / "answers");
  ASSERT_TRUE(answers.has_value()) << answers.error().message;
  ASSERT_EQ(answers->size(), 12u);
  for (const auto& [id, answer] : *answers) {
    // Neither file names nor site files tell what is hidden.
    const std::string site = read_text(whole() / "cases" / id / "site.toml");
    for (const HiddenEffect& hidden : answer.effects) {
      EXPECT_EQ(site.find(hidden.effect), std::string::npos);
      double largest = 0.0;
      for (const auto& [meter, share] : hidden.share_of_meter) {
        largest = std::max(largest, std::abs(share));
      }
      EXPECT_LT(largest, 0.5);
    }
    EXPECT_FALSE(fs::exists(whole() / "cases" / id / "truth.json"));
  }
}

TEST_F(Smoke, EveryCaseIsOneThatRecaldTakes) {
  for (const auto& entry : fs::directory_iterator(whole() / "cases")) {
    SCOPED_TRACE(entry.path().filename());
    const std::string site = (entry.path() / "site.toml").string();
    const Ran checked = run(*folder_, std::string(RECALD_PROGRAM) + " check " + site);
    EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
    const Ran replayed = run(*folder_, std::string(RECALD_PROGRAM) + " replay --json " + site);
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_THAT(replayed.out, HasSubstr("electricity"));
  }
}

TEST_F(Smoke, ATwinHasTheSameWeatherAndSiteAndAFootprintWhereSomethingIsHidden) {
  const auto answers = read_answers(whole() / "answers");
  for (const auto& [id, answer] : *answers) {
    SCOPED_TRACE(id);
    const fs::path with = whole() / "cases" / id;
    const fs::path twin = whole() / "twins" / id;
    EXPECT_EQ(read_text(with / "weather.csv"), read_text(twin / "weather.csv"));
    EXPECT_EQ(read_text(with / "site.toml"), read_text(twin / "site.toml"));
    EXPECT_EQ(read_text(with / "readings.csv") == read_text(twin / "readings.csv"),
              answer.effects.empty());
    EXPECT_THAT(read_text(twin / "footprint.csv"), HasSubstr("timestamp,meter,value,unit\n"));
  }
}

TEST_F(Smoke, SameSeedSameBytesEvenInPieces) {
  const std::string out = (*folder_ / "pieces").string();
  const std::string one = "--population smoke --seed 1 --twins --threads 1 --out " + out;
  ASSERT_EQ(make(*folder_, one + " --cases 7-8").exit_code, 0);
  EXPECT_THAT(make(*folder_, one + " --cases 3").out, HasSubstr("not sealed"));
  // A case that was cut off has no answer; whatever of it is there is made anew.
  fs::remove(fs::path(out) / "answers" / "smoke-007.json");
  write_text(fs::path(out) / "cases" / "smoke-007" / "readings.csv", "torn");
  ASSERT_EQ(make(*folder_, one + " --cases 7").exit_code, 0);
  const auto pieces = files_below(out);
  EXPECT_EQ(pieces.size(), 3u * (3 + 4 + 1) + 1);  // and population.txt
  const auto all = files_below(whole());
  for (const auto& [path, text] : pieces) EXPECT_TRUE(all.at(path) == text) << path;
}

TEST_F(Smoke, RefusesInOneSentence) {
  const std::string out = " --out " + (*folder_ / "x").string();
  EXPECT_EQ(make(*folder_, "--population smoke" + out).exit_code, 2);
  const Ran unknown = make(*folder_, "--population secret --seed 1" + out);
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("there are smoke, training and sealed"));
  const Ran beyond = make(*folder_, "--population smoke --seed 1 --cases 5-13" + out);
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("1 to 12"));
  const std::string pieces = (*folder_ / "begun").string();
  ASSERT_EQ(make(*folder_, "--population smoke --seed 1 --cases 4 --out " + pieces).exit_code, 0);
  const Ran other = make(*folder_, "--population smoke --seed 2 --out " + pieces);
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("holds smoke with seed 1 and this is smoke with seed 2"));
  EXPECT_EQ(make(*folder_, "--population smoke --seed -1" + out).exit_code, 2);
  const Ran again = make(*folder_, "--population smoke --seed 2 --out " + whole().string());
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("is sealed already"));
}

}  // namespace
}  // namespace recald::blind
