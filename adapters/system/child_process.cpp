#include "adapters/system/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace recald::system {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{20};
constexpr double kMegabyteOfKibibytes = 1024.0 / 1e6;

/// What posix_spawn is told: folder, streams, and a group of its own so that the children of the
/// program end with it.
class SpawnPlan {
 public:
  explicit SpawnPlan(const ChildCommand& command) {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
    posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, command.output.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&files_, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&files_, command.folder.c_str());
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnPlan() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&files_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  [[nodiscard]] Result<pid_t> start(const ChildCommand& command) const {
    std::vector<char*> argv{const_cast<char*>(command.program.c_str())};
    for (const std::string& word : command.arguments) {
      argv.push_back(const_cast<char*>(word.c_str()));
    }
    argv.push_back(nullptr);
    pid_t process = 0;
    const int failed =
        ::posix_spawn(&process, argv.front(), &files_, &attributes_, argv.data(), environ);
    if (failed == 0) return process;
    return failure(ErrorCode::io_failed, "cannot start '" + command.program.string() +
                                             "': " + std::generic_category().message(failed));
  }

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

/// Tells at once when a process ends; where the kernel cannot, after a nap.
class EndWatch {
 public:
  explicit EndWatch(pid_t process)
      : handle_{static_cast<int>(::syscall(SYS_pidfd_open, process, 0))} {}
  ~EndWatch() {
    if (handle_ >= 0) ::close(handle_);
  }
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  void wait() const {
    pollfd ended{handle_, POLLIN, 0};
    ::poll(&ended, handle_ >= 0 ? 1 : 0, static_cast<int>(kLook.count()));
  }

 private:
  int handle_;
};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Result<ChildEnd> run_child(const ChildCommand& command, const std::function<bool()>& keep_going) {
  const Clock::time_point begin = Clock::now();
  const auto process = TRY(SpawnPlan{command}.start(command));
  if (command.memory_max_bytes > 0) {
    const rlimit limit{command.memory_max_bytes, command.memory_max_bytes};
    ::prlimit(process, RLIMIT_AS, &limit, nullptr);
  }
  const EndWatch watch{process};

  ChildEnd end;
  int status = 0;
  rusage usage{};
  for (;;) {
    const bool is_killed = end.ending != Ending::exited;
    const pid_t ended = ::wait4(process, &status, is_killed ? 0 : WNOHANG, &usage);
    if (ended == process) break;
    if (ended < 0 && errno != EINTR) {
      return failure(ErrorCode::io_failed, "lost sight of '" + command.program.string() +
                                               "': " + std::generic_category().message(errno));
    }
    if (is_killed) continue;
    const bool is_stopped = keep_going && !keep_going();
    if (is_stopped || seconds_since(begin) > command.time_max.count()) {
      end.ending = is_stopped ? Ending::stopped : Ending::over_limit;
      ::kill(-process, SIGKILL);
      continue;
    }
    watch.wait();
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

}  // namespace recald::system
