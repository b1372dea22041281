#include "adapters/modbus/bus_thread.hpp"

#include <cassert>
#include <memory>
#include <utility>

namespace recald::modbus {

using std::chrono::steady_clock;

BusThread::BusThread(Endpoint endpoint, Loop& loop)
    : connection_(std::move(endpoint)),
      loop_(loop),
      thread_([this](const std::stop_token& stopping) { run(stopping); }) {}

BusThread::~BusThread() = default;

void BusThread::read(const ReadRequest& request, milliseconds timeout, Done done) {
  {
    const std::scoped_lock lock{mutex_};
    assert(!job_ && "one read at a time");
    job_ = Job{request, timeout, std::move(done)};
  }
  changed_.notify_one();
}

void BusThread::run(const std::stop_token& stopping) {
  for (;;) {
    std::unique_lock lock{mutex_};
    if (!changed_.wait(lock, stopping, [this] { return job_.has_value(); })) return;
    Job job = std::move(*job_);
    job_.reset();
    lock.unlock();
    const auto begin = steady_clock::now();
    ReadResult result = connection_.read(job.request, job.timeout);
    const auto duration = std::chrono::duration_cast<milliseconds>(steady_clock::now() - begin);
    if (stopping.stop_requested()) return;
    loop_.post([done = std::move(job.done), result = std::move(result), duration]() mutable {
      done(std::move(result), duration);
    });
  }
}

}  // namespace recald::modbus
