/// The smoke population of EnergyPlus's world by its programs: made, made again in a piece, taken
/// by recald, diagnosed and scored.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/blind/population/written_answers.hpp"
#include "tests/support/installed_energyplus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::blind::smoke_program_test {
namespace {

namespace fs = std::filesystem;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class EplusSmoke : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto program = recald::testing::installed_energyplus(RECALD_ENERGYPLUS_ENVIRONMENT);
    if (program.empty()) GTEST_SKIP() << "EnergyPlus is not installed";
    if (!fs::exists(RECALD_BLIND_ENVIRONMENT "/installed")) GTEST_SKIP() << "no Python packages";
    ::setenv("RECALD_ENERGYPLUS", program.c_str(), 1);
  }

  /// What it writes is in `said_`. @return the exit code.
  int run(const std::string& command) {
    const std::string said = (folder_ / "said").string();
    const int status = std::system((command + " >" + said + " 2>&1").c_str());
    said_ = read_text(said);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  int make(const fs::path& out, const std::string& options) {
    return run(std::string(BLIND_MAKE_PROGRAM) +
               " --world energyplus --population smoke --seed 2 --out " + out.string() + options);
  }

  TemporaryFolder folder_;
  std::string said_;
};

TEST_F(EplusSmoke, IsSealedRepeatableTakenByRecaldDiagnosedAndScored) {
  const fs::path whole = folder_ / "whole";
  ASSERT_EQ(make(whole, ""), 0) << said_;
  ASSERT_TRUE(is_sealed(whole / "answers"));
  const std::string seal = read_text(whole / "answers" / "answers.sha256");
  EXPECT_THAT(said_, HasSubstr(seal.substr(seal.size() - 65, 64)));
  const auto answers = written_answers(whole / "answers");
  ASSERT_EQ(answers.size(), 3u);
  std::string hides_something;
  for (const auto& [id, answer] : answers) {
    SCOPED_TRACE(id);
    EXPECT_EQ(answer["world"], "energyplus");
    const fs::path site = whole / "cases" / id / "site.toml";
    for (const Json& hidden : answer["effects"]) {
      EXPECT_EQ(read_text(site).find(hidden["effect"].get<std::string>()), std::string::npos);
      EXPECT_GE(largest_share(answer), 0.03);
      hides_something = id;
    }
    for (const char* command : {" check ", " replay --json "}) {
      EXPECT_EQ(run(std::string(RECALD_PROGRAM) + command + site.string()), 0) << said_;
    }
  }

  ASSERT_FALSE(hides_something.empty());
  // The number of the case is its place in the order of names.
  const auto place = std::distance(answers.begin(), answers.find(hides_something)) + 1;
  const fs::path piece = folder_ / "piece";
  ASSERT_EQ(make(piece, " --cases " + std::to_string(place)), 0) << said_;
  for (const char* file : {"readings.csv", "weather.csv", "site.toml"}) {
    EXPECT_TRUE(read_text(piece / "cases" / hides_something / file) ==
                read_text(whole / "cases" / hides_something / file))
        << file;
  }
  EXPECT_EQ(read_text(piece / "answers" / (hides_something + ".json")),
            read_text(whole / "answers" / (hides_something + ".json")));

  const std::string results = (folder_ / "results.jsonl").string();
  for (const char* method : {"recald", "calibrate"}) {
    ASSERT_EQ(
        run(std::string(BLIND_RUN_PROGRAM) + " --population " + whole.string() + " --results " +
            results + " --limit-s 200 --method " + method + " --recald " RECALD_PROGRAM),
        0)
        << said_;
    EXPECT_THAT(said_, HasSubstr("3 of them new; 0 of the new without a diagnosis"));
  }
  ASSERT_EQ(
      run(std::string(BLIND_SCORE_PROGRAM) + " open --answers " + (whole / "answers").string() +
          " --results " + results + " --out " + (folder_ / "scores.json").string()),
      0)
      << said_;
  const Json scores = Json::parse(read_text(folder_ / "scores.json"));
  ASSERT_EQ(scores["worlds"].size(), 1u);
  const Json& world = scores["worlds"][0];
  EXPECT_EQ(world["cases"], 3);
  // How often a name is false only the large populations tell.
  EXPECT_EQ(world["naming"]["false_names"]["cases"], 1);
  EXPECT_FALSE(world["nothing_hidden"]["cvrmse_calibrated"].is_null());
  EXPECT_THAT(read_text(folder_ / "scores.md"), HasSubstr("| energyplus |"));
}

}  // namespace
}  // namespace recald::blind::smoke_program_test
