/// Ctrl-C as a value: long work asks for it and stops where it can stop cleanly.
#pragma once

namespace recald::daemon {

/// While one lives, Ctrl-C no longer ends the program. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether Ctrl-C came. Safe from any thread.
  [[nodiscard]] bool interrupted() const;

 private:
  void (*previous_)(int);
};

}  // namespace recald::daemon
