#include "adapters/modbus/sunspec_bus.hpp"

#include <fmt/format.h>

#include <utility>

namespace recald::modbus {

using std::chrono::milliseconds;

SunSpecBus::SunSpecBus(std::unique_ptr<Bus> bus,
                       std::map<std::uint8_t, std::vector<std::uint16_t>> wanted)
    : bus_(std::move(bus)), wanted_(std::move(wanted)) {}

void SunSpecBus::read(const ReadRequest& request, milliseconds timeout, Done done) {
  const auto wanted = wanted_.find(request.unit);
  if (wanted == wanted_.end()) {
    bus_->read(request, timeout, std::move(done));
    return;
  }
  const auto order = std::make_shared<Order>(
      Order{request, timeout, std::move(done), {request.unit, wanted->second}});
  if (places_.contains(request.unit)) {
    ask(order);
  } else {
    begin_walk(order);
  }
}

void SunSpecBus::read_below(const ReadRequest& request, const OrderPtr& order,
                            void (SunSpecBus::*take)(const OrderPtr&, ReadResult, milliseconds)) {
  bus_->read(request, order->timeout,
             alive_.guard([this, order, take](ReadResult result, milliseconds duration) {
               (this->*take)(order, std::move(result), duration);
             }));
}

void SunSpecBus::begin_walk(const OrderPtr& order) {
  order->has_walked = true;
  read_below(*order->walk.next(), order, &SunSpecBus::take_step);
}

void SunSpecBus::take_step(const OrderPtr& order, ReadResult result, milliseconds duration) {
  order->walk.take(result);
  if (const auto next = order->walk.next()) {
    read_below(*next, order, &SunSpecBus::take_step);
  } else if (const auto model = order->walk.found()) {
    places_.insert_or_assign(order->request.unit, *model);
    ask(order);
  } else {
    order->done(tl::unexpected(order->walk.failure()), duration);
  }
}

void SunSpecBus::ask(const OrderPtr& order) {
  const SunSpecModel model = places_.at(order->request.unit);
  ReadRequest placed = order->request;
  if (const int end = placed.address + placed.count; end > SunSpecWalk::kHeader + model.length) {
    // Registers beyond it belong to the next model and would be taken for this one's.
    order->done(
        tl::unexpected(ReadFailure{
            ReadFault::mismatch, 0,
            fmt::format("SunSpec model {} of the device has {} registers; the map goes to {}",
                        model.id, SunSpecWalk::kHeader + model.length, end)}),
        milliseconds{0});
    return;
  }
  placed.address = static_cast<std::uint16_t>(model.address + placed.address);
  read_below(placed, order, &SunSpecBus::take_answer);
}

void SunSpecBus::take_answer(const OrderPtr& order, ReadResult result, milliseconds duration) {
  if (!result) places_.erase(order->request.unit);
  // The chain may have moved while the connection stayed open: walk once more before concluding
  // that the device lacks the register.
  const bool may_have_moved =
      !result && result.error().fault == ReadFault::exception && result.error().exception_code == 2;
  if (may_have_moved && !order->has_walked) {
    begin_walk(order);
  } else {
    order->done(std::move(result), duration);
  }
}

}  // namespace recald::modbus
