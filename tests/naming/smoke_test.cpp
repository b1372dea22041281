/// A few buildings whose hidden effects are large, each with what a diagnosis says of it today. If
/// it says less, naming has lost something. How often names are right in buildings that nothing was
/// learnt from stands in tests/results/diagnosis.md.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/installed_energyplus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::naming {
namespace {

using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using Json = nlohmann::json;

struct Counts {
  int right = 0;  ///< The hidden effect is named.
  int first = 0;  ///< It is the likeliest effect, named or not.
  int wrong = 0;  ///< Another one is named, or one where nothing is hidden.
};

std::string likeliest_effect(const Json& probabilities) {
  std::string first;
  double most = 0.0;
  for (const auto& [answer, probability] : probabilities.items()) {
    if (answer == "none" || answer == "unknown" || probability.get<double>() <= most) continue;
    first = answer;
    most = probability.get<double>();
  }
  return first;
}

class Naming : public ::testing::Test {
 protected:
  void must_run(const std::string& command) {
    const std::string said = (folder_ / "said").string();
    const int status = std::system((command + " >" + said + " 2>&1").c_str());
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command << '\n'
                                                               << read_text(said);
  }

  void SetUp() override {
    if (!std::filesystem::exists(RECALD_BLIND_ENVIRONMENT "/installed")) {
      GTEST_SKIP() << "no Python packages";
    }
  }

  /// Makes cases of the development population with seed 1, diagnoses them, and compares what was
  /// said with what is hidden. @param cases  Their numbers.
  Counts counts_of(const std::string& world, const std::vector<int>& cases) {
    const std::string population = (folder_ / "population").string();
    for (const int number : cases) {
      must_run(std::string(BLIND_MAKE_PROGRAM) + " --world " + world +
               " --population development --seed 1 --out " + population + " --cases " +
               std::to_string(number));
    }
    const std::string results = (folder_ / "results.jsonl").string();
    must_run(std::string(BLIND_RUN_PROGRAM) + " --population " + population + " --results " +
             results + " --limit-s 600 --recald " RECALD_PROGRAM);
    Counts counts;
    std::size_t said = 0;
    std::ifstream lines(results);
    for (std::string text; std::getline(lines, text); ++said) {
      const Json line = Json::parse(text);
      const std::string id = line["case"];
      const Json answer =
          Json::parse(read_text(folder_ / "population" / "answers" / (id + ".json")));
      const std::string hidden =
          answer["effects"].empty() ? "" : answer["effects"][0]["effect"].get<std::string>();
      const bool is_right = !hidden.empty() && line["named"] == Json::array({hidden});
      counts.right += is_right ? 1 : 0;
      counts.wrong += !is_right && !line["named"].empty() ? 1 : 0;
      counts.first += likeliest_effect(line["probabilities"]) == hidden ? 1 : 0;
      std::cout << id << ": hidden '" << hidden << "', named " << line["named"] << ", first "
                << likeliest_effect(line["probabilities"]) << '\n';
    }
    EXPECT_EQ(said, cases.size());
    return counts;
  }

  TemporaryFolder folder_;
};

// A meter's wrong scale, a server room, a clock that is wrong, and nothing.
TEST_F(Naming, InOurOwnWorldDoesNotFallBehind) {
  const Counts counts = counts_of("own", {18, 34, 42, 46});
  EXPECT_GE(counts.right, 3);
  EXPECT_GE(counts.first, 3);
  EXPECT_EQ(counts.wrong, 0);
}

// Nothing, and a lost phase.
TEST_F(Naming, InEnergyPlusDoesNotFallBehind) {
  const auto program = recald::testing::installed_energyplus(RECALD_ENERGYPLUS_ENVIRONMENT);
  if (program.empty()) GTEST_SKIP() << "EnergyPlus is not installed";
  ::setenv("RECALD_ENERGYPLUS", program.c_str(), 1);
  const Counts counts = counts_of("energyplus", {5, 9});
  EXPECT_GE(counts.right, 1);
  EXPECT_GE(counts.first, 1);
  EXPECT_EQ(counts.wrong, 0);
}

}  // namespace
}  // namespace recald::naming
