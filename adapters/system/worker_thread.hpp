/// The worker as a low-priority thread, since polling comes first.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "adapters/ports/worker.hpp"

namespace recald::system {

class WorkerThread final : public Worker {
 public:
  /// @param loop  Outlives this.
  explicit WorkerThread(Loop& loop);
  /// Waits for the current work to end; to make that soon, tell the work to stop first. Its `done`
  /// is not called any more.
  ~WorkerThread() override;
  WorkerThread(const WorkerThread&) = delete;
  WorkerThread& operator=(const WorkerThread&) = delete;

  void run(std::function<void()> work, Loop::Call done) override;

 private:
  struct Order {
    std::function<void()> work;
    Loop::Call done;
  };
  void serve(const std::stop_token& stop);

  Loop& loop_;
  std::mutex mutex_;
  std::condition_variable_any ordered_;
  std::optional<Order> order_;
  std::jthread thread_;  ///< Last: it must end before the members it uses.
};

}  // namespace recald::system
