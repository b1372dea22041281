#include "tests/blind/running/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

namespace recald::blind {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{20};
constexpr double kMegabyteOfKibibytes = 1024.0 / 1e6;

/// What posix_spawn is told: streams, and a group of its own so that the children of the program
/// end with it.
class SpawnPlan {
 public:
  explicit SpawnPlan(const std::filesystem::path& said) {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
    posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, said.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&files_, STDOUT_FILENO, STDERR_FILENO);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnPlan() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&files_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  Result<pid_t> start(const std::vector<std::string>& command) const {
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    pid_t process = 0;
    const int failed =
        ::posix_spawn(&process, argv.front(), &files_, &attributes_, argv.data(), environ);
    if (failed == 0) return process;
    return failure(ErrorCode::io_failed, "cannot start '" + command.front() +
                                             "': " + std::generic_category().message(failed));
  }

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Result<ProcessEnd> run_process(const std::vector<std::string>& command,
                               const std::filesystem::path& said, double limit_s,
                               const std::atomic<bool>& stop) {
  const Clock::time_point begin = Clock::now();
  const auto process = SpawnPlan(said).start(command);
  if (!process) return tl::unexpected(process.error());

  ProcessEnd end;
  int status = 0;
  rusage usage{};
  for (;;) {
    const bool wait_for_it = end.ending != Ending::exited;
    const pid_t ended = ::wait4(*process, &status, wait_for_it ? 0 : WNOHANG, &usage);
    if (ended == *process) break;
    if (ended < 0 && errno != EINTR) {
      return failure(ErrorCode::io_failed, "lost sight of '" + command.front() +
                                               "': " + std::generic_category().message(errno));
    }
    if (wait_for_it) continue;
    if (stop || seconds_since(begin) > limit_s) {
      end.ending = stop ? Ending::stopped : Ending::over_limit;
      ::kill(-*process, SIGKILL);
      continue;
    }
    std::this_thread::sleep_for(kLook);
  }
  end.wall_s = seconds_since(begin);
  end.cpu_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  end.peak_rss_MB = static_cast<double>(usage.ru_maxrss) * kMegabyteOfKibibytes;
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) {
    end.signal = WTERMSIG(status);
    if (end.ending == Ending::exited) end.ending = Ending::killed;
  }
  return end;
}

}  // namespace recald::blind
