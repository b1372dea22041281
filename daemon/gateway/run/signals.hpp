/// The process's signals as a queue: a signal that arrives while nothing is listening waits.
#pragma once

#include <csignal>
#include <optional>

#include "core/result.hpp"

namespace recald::daemon {

/// SIGHUP, SIGUSR1, SIGTERM and SIGINT. Create it before the process's first thread, because
/// threads inherit the signal mask of their creator.
class Signals {
 public:
  /// From now on SIGHUP and SIGUSR1 wait; otherwise they would end a process that is not listening
  /// yet. SIGTERM and SIGINT still end it.
  /// @return the signals, or io_failed when the system has no descriptor left.
  [[nodiscard]] static Result<Signals> open();

  ~Signals();
  Signals(Signals&& other) noexcept;
  Signals& operator=(Signals&&) = delete;

  /// From now on SIGTERM and SIGINT wait too.
  void hold_ends();
  /// From now on they end the process at once.
  void let_ends_through();

  /// A new descriptor that is readable whenever a signal waits; the caller closes it. −1: the
  /// system has none left.
  [[nodiscard]] int descriptor() const;

  /// Takes the first waiting signal out of the queue; nothing: none waits.
  [[nodiscard]] std::optional<int> next();

 private:
  Signals(int file, const sigset_t& before) : file_(file), before_(before) {}

  int file_;
  sigset_t before_;  ///< The signal mask.
};

}  // namespace recald::daemon
