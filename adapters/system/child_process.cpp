#include "adapters/system/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

extern char** environ;

namespace recald::system {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kAskEvery{200};

/// How it is started: where it works, where its words go, a process group of its own.
class SpawnSettings {
 public:
  explicit SpawnSettings(const ChildCommand& command) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
    posix_spawn_file_actions_addchdir_np(&actions_, command.folder.c_str());
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, command.output.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* actions() const { return &actions_; }
  [[nodiscard]] const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

/// Kills the whole group and takes the child's end off the system's table.
void kill_group(pid_t child) {
  ::kill(-child, SIGKILL);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
}

ChildEnd end_of(int status) {
  if (WIFSIGNALED(status)) return {ChildEnd::How::signalled, WTERMSIG(status)};
  return {ChildEnd::How::exited, WEXITSTATUS(status)};
}

}  // namespace

Result<ChildEnd> run_child(const ChildCommand& command, const std::function<bool()>& keep_going) {
  std::vector<char*> words{const_cast<char*>(command.program.c_str())};
  for (const std::string& argument : command.arguments) {
    words.push_back(const_cast<char*>(argument.c_str()));
  }
  words.push_back(nullptr);
  const SpawnSettings settings{command};
  pid_t child = 0;
  const int refused = posix_spawn(&child, command.program.c_str(), settings.actions(),
                                  settings.attributes(), words.data(), environ);
  if (refused != 0) {
    return failure(ErrorCode::io_failed,
                   "cannot start " + command.program.string() + ": " + std::strerror(refused));
  }
  if (command.memory_max_bytes > 0) {
    const rlimit limit{command.memory_max_bytes, command.memory_max_bytes};
    ::prlimit(child, RLIMIT_AS, &limit, nullptr);
  }
  const Clock::time_point deadline = Clock::now() + command.time_max;
  const int handle = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
  for (;;) {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) {
      if (handle >= 0) ::close(handle);
      return end_of(status);
    }
    const bool is_late = Clock::now() >= deadline;
    if (is_late || (keep_going && !keep_going())) {
      if (handle >= 0) ::close(handle);
      kill_group(child);
      return ChildEnd{is_late ? ChildEnd::How::timed_out : ChildEnd::How::stopped, SIGKILL};
    }
    // Woken by the child's end; where the kernel has no such handles, a nap as long.
    pollfd ended{handle, POLLIN, 0};
    ::poll(&ended, handle >= 0 ? 1 : 0, static_cast<int>(kAskEvery.count()));
  }
}

}  // namespace recald::system
