/// Ctrl-C and SIGTERM: the first ends a command cleanly, a second one at once.
#pragma once

namespace recald::daemon {

/// Listens to both signals as long as it lives; one at a time. A signal says on standard error that
/// the command ends. Where nobody guards anything the program ends with it, at once.
class EndSignals {
 public:
  EndSignals();
  ~EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  /// 130 after Ctrl-C, 143 after SIGTERM, as a shell has it; else `otherwise`.
  [[nodiscard]] int exit_code(int otherwise) const;

 private:
  void (*interrupt_)(int);
  void (*terminate_)(int);
};

/// While one lives, the first signal leaves the program to the work at hand, which asks and stops
/// where it can stop cleanly. A set of files is written under one, so that it is whole.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether a signal came. Safe from any thread.
  [[nodiscard]] bool interrupted() const;
};

}  // namespace recald::daemon
