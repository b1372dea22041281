/// The program itself: exit codes, streams, and a population from the seal to the scores.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "tests/blind/scoring/made_up.hpp"

namespace recald::blind {
namespace {

using ::testing::HasSubstr;

class BlindScore : public ::testing::Test {
 protected:
  BlindScore() {
    for (const char* name : {"a", "b"}) {
      std::filesystem::create_directories(folder_.path() / "cases" / name);
      testing::write_text(folder_.path() / "cases" / name / "site.toml", "");
      std::filesystem::create_directories(folder_ / "answers");
      testing::write_text(folder_ / "answers" / (std::string(name) + ".json"),
                          made_up::answer_json(name).dump());
    }
  }

  /// Runs in the test's folder. @return the exit code; output and errors are in `said_`.
  int run(const std::string& arguments, const std::string& input = "") {
    testing::write_text(folder_ / "input", input);
    const std::string command = "cd '" + folder_.path().string() + "' && '" +
                                std::string(BLIND_SCORE_PROGRAM) + "' " + arguments +
                                " < input > said 2>&1";
    const int status = std::system(command.c_str());
    said_ = testing::read_text(folder_ / "said");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  testing::TemporaryFolder folder_;
  std::string said_;
};

TEST_F(BlindScore, FromTheSealToTheScores) {
  ASSERT_EQ(run("seal --answers answers"), 0) << said_;
  const std::string published = said_.substr(0, said_.size() - 1);
  EXPECT_EQ(published.size(), 64u);

  ASSERT_EQ(run("pending --population cases --results sealed.jsonl"), 0);
  EXPECT_EQ(said_, "a\nb\n");
  ASSERT_EQ(run("append --results sealed.jsonl", made_up::result_json("b").dump() + "\n"), 0);
  EXPECT_EQ(said_, "");
  ASSERT_EQ(run("pending --population cases --results sealed.jsonl"), 0);
  EXPECT_EQ(said_, "a\n");
  ASSERT_EQ(run("pending --population cases --results sealed.jsonl --method aic"), 0);
  EXPECT_EQ(said_, "a\nb\n");

  const std::string open = "open --answers answers --results sealed.jsonl --out scores.json";
  EXPECT_EQ(run(open), 1);
  EXPECT_EQ(said_,
            "blind_score: method recald: 1 of 2 cases have no result (a); run them, or give "
            "--partial; nothing was opened\n");
  ASSERT_EQ(run("append --results sealed.jsonl", made_up::result_json("a").dump()), 0);
  ASSERT_EQ(run(open + " --bins 10 --published " + published), 0) << said_;
  EXPECT_EQ(said_, "2 of 2 cases right; wrote scores.json and the page beside it\n");
  const auto scores = nlohmann::json::parse(testing::read_text(folder_ / "scores.json"));
  EXPECT_EQ(scores["probability"]["reliability"].size(), 10u);
  EXPECT_THAT(scores["scorer"].get<std::string>(), HasSubstr("recald"));
}

TEST_F(BlindScore, RerunsNeedTheirFlag) {
  const std::string line = made_up::result_json("a").dump();
  ASSERT_EQ(run("append --results sealed.jsonl", line), 0);
  EXPECT_EQ(run("append --results sealed.jsonl", line), 1);
  EXPECT_THAT(said_, HasSubstr("case a has two results of method recald"));
  EXPECT_EQ(run("append --results sealed.jsonl --allow-rerun", line), 0);
}

TEST_F(BlindScore, WrongUseHasItsOwnExitCode) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("open --answers answers"), 2);
  EXPECT_EQ(run("open --answers answers --results r --out scores.json --bins 1"), 2);
  EXPECT_EQ(run("--help"), 0);
  EXPECT_EQ(run("seal --answers absent"), 1);
  EXPECT_THAT(said_, HasSubstr("blind_score: cannot list the folder 'absent'"));
}

}  // namespace
}  // namespace recald::blind
