#include "daemon/gateway/run/signals.hpp"

#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>
#include <system_error>
#include <utility>

namespace recald::daemon {
namespace {

sigset_t set_of(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  return set;
}

const std::initializer_list<int> kEnds{SIGTERM, SIGINT};
const std::initializer_list<int> kOthers{SIGHUP, SIGUSR1};

void hold(std::initializer_list<int> signals) {
  const sigset_t held = set_of(signals);
  pthread_sigmask(SIG_BLOCK, &held, nullptr);
}

}  // namespace

Result<Signals> Signals::open() {
  sigset_t before;
  pthread_sigmask(SIG_BLOCK, nullptr, &before);
  const sigset_t all = set_of({SIGTERM, SIGINT, SIGHUP, SIGUSR1});
  const int file = ::signalfd(-1, &all, SFD_NONBLOCK | SFD_CLOEXEC);
  if (file < 0) {
    return failure(ErrorCode::io_failed,
                   "recald cannot receive signals: " + std::generic_category().message(errno));
  }
  hold(kOthers);
  return Signals{file, before};
}

Signals::Signals(Signals&& other) noexcept
    : file_(std::exchange(other.file_, -1)), before_(other.before_) {}

Signals::~Signals() {
  if (file_ < 0) return;
  ::close(file_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void Signals::hold_ends() { hold(kEnds); }

void Signals::let_ends_through() {
  const sigset_t ends = set_of(kEnds);
  pthread_sigmask(SIG_UNBLOCK, &ends, nullptr);
}

int Signals::descriptor() const { return ::dup(file_); }

std::optional<int> Signals::next() {
  signalfd_siginfo info{};
  if (::read(file_, &info, sizeof info) != sizeof info) return {};
  return static_cast<int>(info.ssi_signo);
}

}  // namespace recald::daemon
