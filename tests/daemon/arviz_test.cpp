/// The draws in the hands of ArviZ: `--predictive` is made for it. read_by_arviz.py says what is
/// checked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "command_line.hpp"
#include "tests/daemon/depot_year.hpp"
#include "tests/support/sample_design.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using recald::testing::read_text;
using recald::testing::write_text;
using testing::Outcome;
using testing::run;

class ReadByArviz : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(RECALD_ARVIZ "/installed")) {
      GTEST_SKIP() << "ArviZ could not be installed in " RECALD_ARVIZ;
    }
  }

  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }

  void calibrate(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "calibrate");
    arguments.insert(arguments.end(), {"--predictive", "--out", path("out")});
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  }

  /// Runs the script's check; what it prints stands beside a failure.
  void expect(const std::string& check, const std::string& more = "") {
    const std::string command = std::string{RECALD_ARVIZ "/bin/python"} + " -W ignore " +
                                RECALD_SOURCE_DIR "/tests/daemon/read_by_arviz.py " + check + " " +
                                path("out") + " " + more + " 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string said;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) said += static_cast<char>(c);
    EXPECT_EQ(::pclose(pipe), 0) << said;
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(ReadByArviz, DensitiesAreThoseOfTheDraws) {
  recald::testing::write_sample_design(folder_ / "design");
  write_text(folder_ / "given.csv",
             "term,coef\n(Intercept),0.1\ndrybulb,0.5\nout,0.05\nair,0.2\nair:drybulb,0.3\n"
             "set_point,-0.1\n");
  ASSERT_NO_FATAL_FAILURE(calibrate({"--doe", path("design"), "--metamodel", path("given.csv"),
                                     "--sampler", "nuts", "--draws", "600", "--burn-in", "300"}));
  expect("given", path("design"));
}

TEST_F(ReadByArviz, LeaveOneOutIsThatOfTheReport) {
  recald::testing::write_sample_design(folder_ / "design");
  std::istringstream both{read_text(folder_ / "design/measurements.csv")};
  std::string one;
  for (std::string line; std::getline(both, line);) {
    one += line.substr(0, line.find(',', line.find(',') + 1)) + "\n";
  }
  write_text(folder_ / "one.csv", one);
  ASSERT_NO_FATAL_FAILURE(calibrate({"--doe", path("design"), "--measurements", path("one.csv")}));
  expect("forecasts", path("design"));
}

// The depot's electricity meter has its profile read off it, so heat alone is fitted, by a
// polynomial in the place of the model.
TEST_F(ReadByArviz, SoIsThatOfASite) {
  recald::testing::write_depot_year(folder_ / "");
  ASSERT_NO_FATAL_FAILURE(calibrate({path("site.toml")}));
  expect("scatter");
}

}  // namespace
}  // namespace recald::daemon
