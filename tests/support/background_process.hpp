/// A program that runs beside a test; it ends with the test at the latest, by its own process id.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace recald::testing {

class BackgroundProcess {
 public:
  /// What it says on both streams goes to the end of `said`.
  BackgroundProcess(const std::vector<std::string>& command, const std::filesystem::path& said) {
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("no process");
    if (pid_ > 0) return;
    const int file = ::open(said.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  ~BackgroundProcess() {
    if (pid_ > 0) (void)end(SIGKILL);
  }
  BackgroundProcess(const BackgroundProcess&) = delete;
  BackgroundProcess& operator=(const BackgroundProcess&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  void signal(int number) const { ::kill(pid_, number); }
  [[nodiscard]] pid_t id() const { return pid_; }

  /// Sends the signal and waits for the end. @return the exit code, or minus the signal's number.
  int end(int signal) {
    ::kill(pid_, signal);
    return wait();
  }
  /// Whether it has; wait() then says how.
  [[nodiscard]] bool has_ended() const {
    siginfo_t about{};
    return ::waitid(P_PID, static_cast<id_t>(pid_), &about, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           about.si_pid != 0;
  }
  /// Waits until it ends by itself.
  int wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t pid_ = -1;
};

/// What a shell command ended with, and what it said.
struct ShellEnd {
  int status;
  std::string said;
};
inline ShellEnd run_in_shell(const std::string& command) {
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("no shell");
  std::string said;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) said += static_cast<char>(c);
  return {::pclose(pipe), std::move(said)};
}

/// Looks every 20 ms until it holds, for half a minute at most: beside other work all is slower.
template <class Condition>
bool eventually(Condition condition) {
  for (int looks = 0; looks < 1500; ++looks) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  return false;
}

}  // namespace recald::testing
