/// Gathers everything to be stored within a second and commits it at once; keeps it if
/// the commit fails.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "adapters/ports/interval_store.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/wakeup.hpp"
#include "daemon/gateway/poll/latency_histogram.hpp"

namespace recald::daemon {

struct CommitRules {
  std::chrono::milliseconds gather{1'000};  ///< Intervals do not wait: they are committed at once.
  std::chrono::milliseconds retry{10'000};  ///< After a failure.
  /// How much is kept while the store refuses: 24 hours of a hundred meters. Beyond that, raw
  /// samples are dropped first, then the oldest intervals. While the store accepts commits, nothing
  /// is dropped.
  std::size_t intervals_max = 10'000;
  std::size_t samples_max = 50'000;
};

/// The state of commits to the store.
struct CommitHealth {
  bool is_degraded = false;  ///< The last commit failed.
  std::string why;           ///< In that case, the store's error message.
  std::uint64_t commits = 0;
  std::uint64_t failures = 0;
  std::uint64_t lost_intervals = 0;  ///< Dropped, because the store refused for too long.
  std::uint64_t conflicts = 0;
  std::chrono::milliseconds last_duration{0};
  LatencyHistogram durations;  ///< Of all commits, including refused ones.
};

class Committer {
 public:
  /// Called with what was committed: from then on it is acknowledged.
  using OnCommitted = std::function<void(const StoreBatch&, const CommitCounts&)>;
  /// Called when the store begins to refuse, with its words, and when it accepts again, with none.
  using OnRefusal = std::function<void(const std::string& why)>;

  Committer(Loop& loop, IntervalStore& store, const CommitRules& rules, OnCommitted on_committed,
            OnRefusal on_refusal = {});

  void add(StoreBatch batch);

  /// Commits everything now. @return the store's refusal; refused data are kept.
  Result<void> flush();

  [[nodiscard]] const CommitHealth& health() const { return health_; }
  [[nodiscard]] std::size_t waiting_intervals() const { return waiting_.intervals.size(); }

 private:
  void put_state(const StoreBatch::Register& entry);
  [[nodiscard]] bool has_too_much() const;
  void give_up_what_is_too_much();

  Loop& loop_;
  IntervalStore& store_;
  CommitRules rules_;
  OnCommitted on_committed_;
  OnRefusal on_refusal_;
  StoreBatch waiting_;
  CommitHealth health_;
  Wakeup wakeup_;
};

}  // namespace recald::daemon
