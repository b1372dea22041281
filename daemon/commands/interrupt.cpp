#include "daemon/commands/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

namespace recald::daemon {
namespace {

constexpr int kEndedBySignal = 128;  // as a shell counts

std::atomic<int> caught{0};  // the first signal; 0: none yet
std::atomic<int> guards{0};
std::atomic<bool> is_terminal{false};  // standard error: progress is drawn there
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may only touch such");

void say(std::string_view sentence) {
  constexpr std::string_view kLineBegin = "\r\033[K";  // over a line of progress
  if (is_terminal) (void)!::write(STDERR_FILENO, kLineBegin.data(), kLineBegin.size());
  (void)!::write(STDERR_FILENO, sentence.data(), sentence.size());
}

/// Calls nothing but what a signal handler may call.
void end(int signal) {
  const bool is_first = caught.exchange(signal) == 0;
  if (is_first && guards > 0) {
    say("recald: stopping; press Ctrl-C again to stop at once\n");
    return;
  }
  say("recald: stopped by a signal\n");
  ::_exit(kEndedBySignal + signal);
}

}  // namespace

EndSignals::EndSignals()
    : interrupt_(std::signal(SIGINT, end)), terminate_(std::signal(SIGTERM, end)) {
  caught = 0;
  is_terminal = ::isatty(STDERR_FILENO) == 1;
}

EndSignals::~EndSignals() {
  std::signal(SIGINT, interrupt_);
  std::signal(SIGTERM, terminate_);
}

int EndSignals::exit_code(int otherwise) const {
  return caught == 0 ? otherwise : kEndedBySignal + caught;
}

InterruptGuard::InterruptGuard() { ++guards; }

InterruptGuard::~InterruptGuard() { --guards; }

bool InterruptGuard::interrupted() const { return caught != 0; }

}  // namespace recald::daemon
