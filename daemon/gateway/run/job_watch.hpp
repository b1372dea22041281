/// Between a running job and the daemon: how far the job is, and whether it should go on.
#pragma once

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>

namespace recald::daemon {

/// Safe from any thread.
class JobWatch {
 public:
  struct Progress {
    std::string what;  ///< "calibrating the hourly model"
    double share;      ///< Of the whole job, 0…1.
  };

  /// @param share  Of the whole job; a smaller one than before is that of before, since a job that
  ///               repeats a part does not get further from its end.
  /// @return whether to go on; if not, the job should stop early.
  bool say(const std::string& what, double share) {
    const std::lock_guard lock{mutex_};
    progress_ =
        Progress{what, std::max(progress_ ? progress_->share : 0.0, std::clamp(share, 0.0, 1.0))};
    return goes_on_;
  }
  [[nodiscard]] bool goes_on() const {
    const std::lock_guard lock{mutex_};
    return goes_on_;
  }
  void stop() {
    const std::lock_guard lock{mutex_};
    goes_on_ = false;
  }
  /// Nothing if the job has said nothing yet.
  [[nodiscard]] std::optional<Progress> progress() const {
    const std::lock_guard lock{mutex_};
    return progress_;
  }

 private:
  mutable std::mutex mutex_;
  bool goes_on_ = true;
  std::optional<Progress> progress_;
};

}  // namespace recald::daemon
