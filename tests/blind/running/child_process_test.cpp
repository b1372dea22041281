#include "tests/blind/running/child_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/temporary_folder.hpp"

namespace recald::blind {
namespace {

using ::testing::HasSubstr;

class ChildProcess : public ::testing::Test {
 protected:
  /// Runs it with the shell.
  ProcessEnd run(const std::string& script, double limit_s = 60.0) {
    const auto end = run_process({"/bin/sh", "-c", script}, folder_ / "said", limit_s, stop_);
    EXPECT_TRUE(end.has_value());
    return end.value_or(ProcessEnd{});
  }

  testing::TemporaryFolder folder_;
  std::atomic<bool> stop_ = false;
};

/// A child that nobody waits for may stay as a zombie (Z), which runs no more.
bool is_running(const std::string& process) {
  const std::filesystem::path file = "/proc/" + process + "/stat";
  if (!std::filesystem::exists(file)) return false;
  std::ifstream in(file);
  std::string number, name, state;
  in >> number >> name >> state;
  return !state.empty() && state != "Z" && state != "X";
}

TEST_F(ChildProcess, ItsExitCodeAndBothItsStreams) {
  const ProcessEnd end = run("echo one; echo two >&2; exit 7");
  EXPECT_EQ(end.ending, Ending::exited);
  EXPECT_EQ(end.exit_code, 7);
  EXPECT_EQ(testing::read_text(folder_ / "said"), "one\ntwo\n");
  EXPECT_GT(end.wall_s, 0.0);
  EXPECT_GT(end.peak_rss_MB, 0.0);
}

TEST_F(ChildProcess, ReadsNothing) { EXPECT_EQ(run("read word").exit_code, 1); }

TEST_F(ChildProcess, EndsAtTheLimitWithItsChildren) {
  const std::string file = (folder_ / "grandchild").string();
  const ProcessEnd end = run("sleep 1000 & echo $! > '" + file + "'; wait", 1.0);
  EXPECT_EQ(end.ending, Ending::over_limit);
  std::string grandchild = testing::read_text(file);
  grandchild.pop_back();
  // The signal has been sent; when it arrives is the system's business.
  for (int look = 0; is_running(grandchild) && look < 1000; ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_FALSE(is_running(grandchild));
}

TEST_F(ChildProcess, ASignalFromElsewhereIsTold) {
  const ProcessEnd end = run("kill -SEGV $$");
  EXPECT_EQ(end.ending, Ending::killed);
  EXPECT_EQ(end.signal, SIGSEGV);
}

TEST_F(ChildProcess, EndsWhenItsCallerStops) {
  stop_ = true;
  EXPECT_EQ(run("sleep 1000").ending, Ending::stopped);
}

TEST_F(ChildProcess, WhatIsNotThereCannotStart) {
  const auto end = run_process({"/absent/recald"}, folder_ / "said", 1.0, stop_);
  ASSERT_FALSE(end.has_value());
  EXPECT_EQ(end.error().code, ErrorCode::io_failed);
  EXPECT_THAT(end.error().message, HasSubstr("cannot start '/absent/recald'"));
}

}  // namespace
}  // namespace recald::blind
