#include "daemon/commands/console.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "daemon/commands/line/terminal_text.hpp"

namespace recald::daemon {
namespace {

TEST(Console, FailuresAreOneLineEachAndExitWithOne) {
  std::ostringstream out;
  std::ostringstream err;
  const Console console{out, err, false};
  EXPECT_EQ(console.fail("no such thing"), kFailure);
  EXPECT_EQ(console.fail(Error{ErrorCode::not_found, "no file"}), kFailure);
  EXPECT_EQ(console.fail(std::vector<std::string>{"one", "two"}), kFailure);
  EXPECT_EQ(console.misused("no such day"), kUsage);
  EXPECT_EQ(err.str(),
            "recald: no such thing\nrecald: no file\nrecald: one\nrecald: two\n"
            "recald: no such day\n");
  EXPECT_EQ(out.str(), "");
}

TEST(TerminalText, ShowsWhatOthersWroteAndDrawsItsOwnLines) {
  std::ostringstream terminal;
  TerminalText text{*terminal.rdbuf()};
  std::ostream out{&text};
  out << "a \x1B]0;title\x07 and \u202Ekcab\n\tb\r" << 'c' << '\x1B' << kLineOver << "d 1 %"
      << kLineOver << std::flush;
  EXPECT_EQ(terminal.str(),
            "a \\x1B]0;title\\x07 and \\u202Ekcab\n\tb\\x0Dc\\x1B\r\033[Kd 1 %\r\033[K");
}

using Stage = calibration::Progress::Stage;

calibration::Progress sampling(int chain, int done) {
  calibration::Progress progress{};
  progress.stage = Stage::sampling;
  progress.chain = chain;
  progress.done = done;
  progress.total = 200;
  return progress;
}

TEST(ProgressLine, IsDrawnForPeopleOnly) {
  std::ostringstream out;
  std::ostringstream err;
  {
    const Console console{out, err, false};
    ProgressLine line{console};
    line.show(sampling(0, 100));
  }
  EXPECT_EQ(err.str(), "");
}

TEST(ProgressLine, DrawsEachPerCentOnceOverItselfAndLeavesNothing) {
  std::ostringstream out;
  std::ostringstream err;
  {
    const Console console{out, err, true};
    ProgressLine line{console};
    line.show(sampling(0, 100));
    line.show(sampling(0, 101));  // 50.5 %: nothing new
    EXPECT_EQ(err.str(), "\r\033[KSampling  50 %");
    err.str("");
    line.show(sampling(1, 1));  // two chains now: (101 + 1) of 400
    EXPECT_EQ(err.str(), "\r\033[KSampling  25 %");
    err.str("");
  }
  EXPECT_EQ(err.str(), "\r\033[K");
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace recald::daemon
