#include "adapters/system/worker_thread.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <cassert>
#include <optional>
#include <utility>

namespace recald::system {
namespace {

/// On Linux each thread has its own niceness. Some sandboxes refuse to change it; it then stays.
void lower_priority() {
  constexpr int kNicest = 19;
  static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNicest));
}

}  // namespace

WorkerThread::WorkerThread(Loop& loop)
    : loop_(loop), thread_([this](const std::stop_token& stop) { serve(stop); }) {}

WorkerThread::~WorkerThread() = default;

void WorkerThread::run(std::function<void()> work, Loop::Call done) {
  const std::scoped_lock lock{mutex_};
  assert(!order_ && "one piece of work at a time");
  order_ = Order{std::move(work), std::move(done)};
  ordered_.notify_one();
}

void WorkerThread::serve(const std::stop_token& stop) {
  lower_priority();
  for (;;) {
    Order order;
    {
      std::unique_lock lock{mutex_};
      if (!ordered_.wait(lock, stop, [this] { return order_.has_value(); })) return;
      order = *std::exchange(order_, std::nullopt);
    }
    order.work();
    if (!stop.stop_requested()) loop_.post(std::move(order.done));
  }
}

}  // namespace recald::system
