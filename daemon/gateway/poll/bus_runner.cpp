#include "daemon/gateway/poll/bus_runner.hpp"

#include <utility>

namespace recald::daemon {

using std::chrono::milliseconds;

BusRunner::BusRunner(Loop& loop, std::unique_ptr<Bus> bus, BusPoller poller, OnRead on_read)
    : loop_(loop),
      bus_(std::move(bus)),
      poller_(std::move(poller)),
      on_read_(std::move(on_read)),
      self_(std::make_shared<BusRunner*>(this)) {
  counters_.requests.resize(poller_.units().size());
}

void BusRunner::start() { step(); }

void BusRunner::begin_anew(const std::function<std::unique_ptr<Bus>()>& make_bus) {
  self_ = std::make_shared<BusRunner*>(this);  // calls from before do not find this one
  bus_.reset();
  bus_ = make_bus();
  poller_.begin_anew();
  step();
}

void BusRunner::count(const PolledRead& read) {
  ++counters_.requests[read.order.unit][static_cast<std::size_t>(result_of(read.result))];
  counters_.duration.observe(read.duration);
  if (read.order.begins_poll) counters_.lateness.observe(read.lateness);
}

void BusRunner::step() {
  const Moment now = loop_.now();
  const std::weak_ptr<BusRunner*> weak = self_;
  const auto order = poller_.next(now);
  if (!order) {
    loop_.after(poller_.wait(now), [weak] {
      if (const auto self = weak.lock()) (*self)->step();
    });
    return;
  }
  const milliseconds lateness = now.wall - order->due;
  bus_->read(order->request, order->timeout,
             [weak, order = *order, lateness](modbus::ReadResult result, milliseconds duration) {
               const auto self = weak.lock();
               if (!self) return;
               BusRunner& runner = **self;
               const Moment at = runner.loop_.now();
               runner.finish({order, std::move(result), lateness, duration, at});
               // The listener may have destroyed this bus, and with it the object that called it.
               if (self.use_count() > 1) runner.step();
             });
}

/// The caller makes the next step, unless an exception is thrown.
void BusRunner::finish(const PolledRead& read) {
  poller_.answered(read.order, read.result, read.duration, read.at);
  count(read);
  const std::weak_ptr<BusRunner*> weak = self_;
  const OnRead on_read = on_read_;
  Loop& loop = loop_;
  try {
    on_read(read);
  } catch (...) {
    loop.post([weak] {
      if (const auto self = weak.lock()) (*self)->step();
    });
    throw;
  }
}

}  // namespace recald::daemon
