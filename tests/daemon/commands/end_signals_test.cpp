/// Ctrl-C and SIGTERM in the middle of long commands, as processes of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <ostream>

#include "daemon/commands/interrupt.hpp"
#include "tests/daemon/depot_versions.hpp"
#include "tests/daemon/depot_year.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/sample_design.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;
using recald::testing::BackgroundProcess;
using recald::testing::edited;
using recald::testing::eventually;
using recald::testing::sample_site;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct LongCommand {
  const char* name;
  std::vector<std::string> words;  ///< SITE, DESIGN and OUT are replaced.
  friend void PrintTo(const LongCommand& command, std::ostream* out) { *out << command.name; }
};

/// Seconds of processor time that a process has had.
double worked_s(pid_t process) {
  const std::string stat = recald::testing::read_text("/proc/" + std::to_string(process) + "/stat");
  std::istringstream fields{stat.substr(stat.rfind(')') + 2)};
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double ticks = 0.0;
  fields >> ticks;
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

/// Sends the signal and waits for the end. @param more_s  Of processor time, at most.
int ended_by(BackgroundProcess& process, int signal, double more_s) {
  const double worked_before_s = worked_s(process.pid());
  process.signal(signal);
  while (!process.has_ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
    if (worked_s(process.pid()) - worked_before_s < more_s) continue;
    ADD_FAILURE() << "it works on";
    return process.end(SIGKILL);
  }
  return process.wait();
}

class LongCommands : public ::testing::TestWithParam<LongCommand> {
 protected:
  LongCommands() {
    // Steps of an hour, as the depot's readings come.
    recald::testing::write_depot_year(
        folder_.path(), edited(sample_site(), "interval = \"15m\"", "interval = \"1h\""));
    recald::testing::write_sample_design(folder_ / "design");
  }

  [[nodiscard]] std::vector<std::string> command() const {
    std::vector<std::string> words{RECALD_PROGRAM};
    for (const std::string& word : GetParam().words) {
      words.push_back(word == "SITE"     ? (folder_ / "site.toml").string()
                      : word == "DESIGN" ? (folder_ / "design").string()
                      : word == "OUT"    ? out().string()
                                         : word);
    }
    return words;
  }
  [[nodiscard]] fs::path out() const { return folder_ / "out"; }
  [[nodiscard]] fs::path said() const { return folder_ / "said.txt"; }

  /// All files of the output's folder; a design that will be gone on with is none.
  [[nodiscard]] std::vector<std::string> left() const {
    std::vector<std::string> names;
    if (!fs::exists(out())) return names;
    const bool is_design = GetParam().words.front() == "doe";
    for (const auto& one : fs::recursive_directory_iterator{out()}) {
      const bool is_part = one.path().extension() == ".part";
      if (one.is_regular_file() && (is_part || !is_design)) names.push_back(one.path().string());
    }
    return names;
  }

  /// Sends the signal once the command is at work, and waits for its end. All of its work would
  /// take the processor far longer than it may have now.
  static int end_at_work(BackgroundProcess& process, int signal) {
    EXPECT_TRUE(eventually([&] { return worked_s(process.pid()) > 0.7; }));
    return ended_by(process, signal, 10.0);
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_P(LongCommands, EndByCtrlCAndLeaveNoHalfResult) {
  BackgroundProcess process{command(), said()};
  EXPECT_EQ(end_at_work(process, SIGINT), 130) << recald::testing::read_text(said());
  EXPECT_THAT(recald::testing::read_text(said()), HasSubstr("recald: stop"));
  EXPECT_THAT(left(), IsEmpty());
}

TEST_P(LongCommands, EndBySigterm) {
  BackgroundProcess process{command(), said()};
  EXPECT_EQ(end_at_work(process, SIGTERM), 143) << recald::testing::read_text(said());
  EXPECT_THAT(left(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    EndSignals, LongCommands,
    ::testing::Values(
        LongCommand{
            "calibrate",
            {"calibrate", "SITE", "--sampler", "dram", "--draws", "100000000", "--out", "OUT"}},
        LongCommand{
            "report",
            {"report", "SITE", "--sampler", "dram", "--draws", "100000000", "--out", "OUT"}},
        LongCommand{"calibrate_design",
                    {"calibrate", "--doe", "DESIGN", "--sampler", "dram", "--draws", "100000000",
                     "--out", "OUT"}},
        LongCommand{"doe", {"doe", "SITE", "--model", "hourly", "--runs", "50000", "--out", "OUT"}},
        LongCommand{"diagnose", {"diagnose", "SITE", "--out", "OUT"}},
        LongCommand{"drift",
                    {"drift", "SITE", "--learn", "6", "--particles", "100000", "--out", "OUT"}}),
    [](const auto& made) { return std::string{made.param.name}; });

class EveryStage : public LongCommands {};

// A stage that nobody can stop is found by a signal in the middle of it, so each command gets some
// at moments all over its work, with a model that has an effect in force.
TEST_P(EveryStage, EndsSoonAfterASignal) {
  constexpr double kSoon_s = 2.0;  // of two threads: a second
  // A diagnosis starts from the drawings.
  if (GetParam().words.front() != "diagnose") {
    std::vector<metering::Month> months;
    for (unsigned m = 1; m <= 12; ++m)
      months.push_back(std::chrono::year{2021} / std::chrono::month{m});
    recald::testing::put_in_force(recald::testing::half_missing_setback(months),
                                  folder_ / "site.toml");
  }
  double moment_s = 0.2;
  for (bool has_ended = false; !has_ended; moment_s *= 1.7) {
    SCOPED_TRACE(moment_s);
    BackgroundProcess process{command(), said()};
    while (!(has_ended = process.has_ended()) && worked_s(process.pid()) < moment_s) {
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
    if (has_ended) {
      EXPECT_EQ(process.wait(), 0) << recald::testing::read_text(said());
    } else {
      const int status = ended_by(process, SIGTERM, kSoon_s);
      EXPECT_TRUE(status == 143 || status == 0) << status;  // it may have been at its end
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(moment_s, 1.0) << "it was over before much of it could be stopped";
}

INSTANTIATE_TEST_SUITE_P(
    OfWhole, EveryStage,
    ::testing::Values(LongCommand{"calibrate",
                                  {"calibrate", "SITE", "--model", "hourly", "--sampler", "dram",
                                   "--draws", "1400", "--burn-in", "400", "--chains", "2",
                                   "--design-runs", "50", "--out", "OUT"}},
                      LongCommand{"drift", {"drift", "SITE", "--learn", "6", "--out", "OUT"}},
                      LongCommand{"diagnose", {"diagnose", "SITE", "--out", "OUT"}},
                      LongCommand{"ecm_since",
                                  {"ecm", "SITE", "--since", "2021-10-01", "--out", "OUT"}}),
    [](const auto& made) { return std::string{made.param.name}; });

// More than a pipe's buffer of lines, and a reader that has gone: `recald replay … | head`.
TEST(Pipes, AReaderThatGoesLeavesTheResultsThere) {
  const recald::testing::TemporaryFolder folder;
  recald::testing::write_depot_year(folder.path());
  std::string site = recald::testing::read_text(folder / "site.toml");
  for (int i = 0; i < 8; ++i) {
    const std::string copy = "copy_" + std::to_string(i);
    fs::copy_file(folder / "readings.csv", folder / (copy + ".csv"));
    site.insert(site.find("[[meter]]"), "[[meter]]\nid = \"" + copy +
                                            "\"\nutility = \"electricity\"\nfile = \"" + copy +
                                            ".csv\"\nname_in_file = \"electricity\"\n\n");
  }
  recald::testing::write_text(folder / "site.toml", site);
  BackgroundProcess process{
      {"/bin/sh", "-c",
       std::string{RECALD_PROGRAM} + " replay " + (folder / "site.toml").string() + " --out " +
           (folder / "out").string() + " | true"},
      folder / "said.txt"};
  EXPECT_EQ(process.wait(), 0);
  EXPECT_TRUE(eventually([&] { return fs::exists(folder / "out/months.csv"); }))
      << recald::testing::read_text(folder / "said.txt");
}

TEST(EndSignals, ASecondOneEndsAtOnce) {
  const auto never_ends = [] {
    const EndSignals signals;
    const InterruptGuard guard;
    std::raise(SIGINT);
    if (!guard.interrupted()) return;
    std::raise(SIGINT);
  };
  EXPECT_EXIT(never_ends(), ::testing::ExitedWithCode(130), "recald: stopping; press Ctrl-C again");
}

TEST(EndSignals, WithoutWorkThatCanBeAskedTheFirstEndsAtOnce) {
  const auto waits = [] {
    const EndSignals signals;
    std::raise(SIGTERM);
  };
  EXPECT_EXIT(waits(), ::testing::ExitedWithCode(143), "recald: stopped by a signal");
}

TEST(EndSignals, SayHowACommandEnded) {
  const EndSignals signals;
  EXPECT_EQ(signals.exit_code(1), 1);
  const InterruptGuard guard;
  std::raise(SIGTERM);
  EXPECT_TRUE(guard.interrupted());
  EXPECT_EQ(signals.exit_code(1), 143);
}

}  // namespace
}  // namespace recald::daemon
