/// A process that ends at a given change of a file, and what power cuts leave of a folder.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "core/random/rng.hpp"
#include "tests/support/file_faults.hpp"
#include "tests/support/power_cut.hpp"

namespace recald::daemon::testing {

inline constexpr int kKilled = 9;
inline constexpr int kDone = 0;

/// Does the work in a process of its own that ends before its n-th change of a file.
/// @return whether it came to its end before that.
template <class Work>
bool ends_before(int nth, const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    recald::testing::end_process_before_change(nth, kKilled);
    work();
    ::_exit(kDone);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  EXPECT_TRUE(WEXITSTATUS(status) == kDone || WEXITSTATUS(status) == kKilled);
  return WIFEXITED(status) && WEXITSTATUS(status) == kDone;
}

/// What power cuts at random changes of a file leave of a folder, while this lives.
class Images {
 public:
  /// @param keep  Told before an image is made; it has the number `taken()`.
  Images(std::filesystem::path folder, std::filesystem::path to, Rng& rng,
         std::function<void()> keep = {})
      : cut_(std::move(folder)), to_(std::move(to)), rng_(rng), keep_(std::move(keep)) {
    recald::testing::before_file_change = [this](const recald::testing::FileChange& change) {
      if (!busy_) take(change);
      return 0;
    };
  }
  ~Images() { recald::testing::before_file_change = {}; }
  Images(const Images&) = delete;
  Images& operator=(const Images&) = delete;

  bool heeds_syncs = true;
  std::function<void()> between = {};  ///< Told of each change; may be empty.

  [[nodiscard]] int taken() const { return taken_; }
  [[nodiscard]] std::filesystem::path image(int number) const {
    return to_ / std::to_string(number);
  }

 private:
  void take(const recald::testing::FileChange& change) {
    busy_ = true;
    if (rng_.below(4) == 0) {
      if (keep_) keep_();
      cut_.write_image(rng_, image(taken_++));
    }
    if (heeds_syncs || !change.call.ends_with("sync")) cut_.watch(change);
    if (between) between();
    busy_ = false;
  }

  recald::testing::PowerCut cut_;
  std::filesystem::path to_;
  Rng& rng_;
  std::function<void()> keep_;
  int taken_ = 0;
  bool busy_ = false;
};

}  // namespace recald::daemon::testing
