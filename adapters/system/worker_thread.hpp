/// The worker as a thread of low priority: polling comes first.
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
  /// Waits until the work that is under way has ended; who wants that soon tells the work to stop
  /// first. Its `done` is not called any more.
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
  std::jthread thread_;  ///< Last: it ends before what it uses.
};

}  // namespace recald::system
