/// The process's signals as a queue: a signal that arrives while nothing is listening waits.
#pragma once

#include <csignal>
#include <optional>

#include "core/result.hpp"

namespace recald::daemon {

/// SIGHUP, SIGUSR1, SIGTERM and SIGINT. Make it before the process's first thread: a thread has the
/// mask of the one that made it.
class Signals {
 public:
  /// From now on SIGHUP and SIGUSR1 wait; they would otherwise end a process that is not listening
  /// yet. SIGTERM and SIGINT still end it.
  /// @return or io_failed when the system has no descriptor left.
  [[nodiscard]] static Result<Signals> open();

  ~Signals();
  Signals(Signals&& other) noexcept;
  Signals& operator=(Signals&&) = delete;

  /// From now on SIGTERM and SIGINT wait too.
  void hold_ends();
  /// From now on they end it at once.
  void let_ends_through();

  /// A descriptor of its own that can be read whenever a signal waits; the caller closes it. −1:
  /// the system has none left.
  [[nodiscard]] int descriptor() const;

  /// The signal that waits first, taken out of the queue; nothing: none waits.
  [[nodiscard]] std::optional<int> next();

 private:
  Signals(int file, const sigset_t& before) : file_(file), before_(before) {}

  int file_;
  sigset_t before_;  ///< The mask.
};

}  // namespace recald::daemon
