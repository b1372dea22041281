#include "adapters/system/child_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/temporary_folder.hpp"

namespace recald::system::child_process_test {
namespace {

using ::testing::HasSubstr;

class ChildProcess : public ::testing::Test {
 protected:
  /// Runs it with the shell.
  ChildEnd run(const std::string& script, double limit_s = 60.0,
               const std::function<bool()>& keep_going = {}) {
    const auto end = run_child({.program = "/bin/sh",
                                .arguments = {"-c", script},
                                .folder = folder_.path(),
                                .output = folder_ / "said",
                                .time_max = std::chrono::duration<double>{limit_s}},
                               keep_going);
    EXPECT_TRUE(end.has_value());
    return end.value_or(ChildEnd{});
  }

  recald::testing::TemporaryFolder folder_;
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
  const ChildEnd end = run("echo one; echo two >&2; exit 7");
  EXPECT_EQ(end.ending, Ending::exited);
  EXPECT_EQ(end.exit_code, 7);
  EXPECT_EQ(recald::testing::read_text(folder_ / "said"), "one\ntwo\n");
  EXPECT_GT(end.wall_s, 0.0);
  EXPECT_GT(end.peak_rss_MB, 0.0);
}

TEST_F(ChildProcess, WorksInItsFolder) {
  EXPECT_EQ(run("pwd -P").exit_code, 0);
  EXPECT_EQ(recald::testing::read_text(folder_ / "said"),
            std::filesystem::canonical(folder_.path()).string() + "\n");
}

TEST_F(ChildProcess, MemoryAboveTheLimitIsRefused) {
  // The limit is set just after the start, and holds for what is started later.
  const auto end = run_child({.program = "/bin/sh",
                              .arguments = {"-c", "sleep 1; head -c 300M /dev/zero | tail"},
                              .folder = folder_.path(),
                              .output = folder_ / "said",
                              .memory_max_bytes = std::uint64_t{100} << 20},
                             {});
  ASSERT_TRUE(end.has_value());
  EXPECT_NE(end->exit_code, 0);
}

TEST_F(ChildProcess, ReadsNothing) { EXPECT_EQ(run("read word").exit_code, 1); }

TEST_F(ChildProcess, EndsAtTheLimitWithItsChildren) {
  const std::string file = (folder_ / "grandchild").string();
  const ChildEnd end = run("sleep 1000 & echo $! > '" + file + "'; wait", 1.0);
  EXPECT_EQ(end.ending, Ending::over_limit);
  std::string grandchild = recald::testing::read_text(file);
  grandchild.pop_back();
  // The signal has been sent; when it arrives is the system's business.
  for (int look = 0; is_running(grandchild) && look < 1000; ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_FALSE(is_running(grandchild));
}

TEST_F(ChildProcess, ASignalFromElsewhereIsTold) {
  const ChildEnd end = run("kill -SEGV $$");
  EXPECT_EQ(end.ending, Ending::killed);
  EXPECT_EQ(end.signal, SIGSEGV);
}

TEST_F(ChildProcess, EndsWhenItsCallerStops) {
  EXPECT_EQ(run("sleep 1000", 60.0, [] { return false; }).ending, Ending::stopped);
}

TEST_F(ChildProcess, WhatIsNotThereCannotStart) {
  const auto end = run_child({.program = "/absent/recald", .output = folder_ / "said"}, {});
  ASSERT_FALSE(end.has_value());
  EXPECT_EQ(end.error().code, ErrorCode::io_failed);
  EXPECT_THAT(end.error().message, HasSubstr("cannot start '/absent/recald'"));
}

}  // namespace
}  // namespace recald::system::child_process_test
