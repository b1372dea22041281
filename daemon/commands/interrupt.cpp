#include "daemon/commands/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace recald::daemon {
namespace {

std::atomic<bool> was_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch such");

}  // namespace

InterruptGuard::InterruptGuard()
    : previous_(std::signal(SIGINT, [](int) { was_interrupted = true; })) {
  was_interrupted = false;
}

InterruptGuard::~InterruptGuard() { std::signal(SIGINT, previous_); }

bool InterruptGuard::interrupted() const { return was_interrupted; }

}  // namespace recald::daemon
