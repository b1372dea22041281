/// A bus that reads registers of SunSpec devices by their place in a model.
///
/// Where a model begins depends on the device and its firmware. So the chain is walked before the
/// first read of such a unit, and again after a failed read. The code that plans and schedules
/// reads is not involved.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "adapters/modbus/sunspec.hpp"
#include "adapters/ports/alive.hpp"
#include "adapters/ports/bus.hpp"

namespace recald::modbus {

class SunSpecBus final : public Bus {
 public:
  /// @param wanted  Units with SunSpec maps, and the models that each map describes; reads of other
  ///                units pass through unchanged.
  SunSpecBus(std::unique_ptr<Bus> bus, std::map<std::uint8_t, std::vector<std::uint16_t>> wanted);

  /// Addresses of SunSpec units count from the model's id register. While its place is unknown, the
  /// chain is walked first, each read with the same timeout. `duration` is that of the last read
  /// alone, since time-outs are learned from it. A device without the model is reported as
  /// mismatch, so it is looked for again like a silent unit.
  void read(const ReadRequest& request, std::chrono::milliseconds timeout, Done done) override;

 private:
  /// One read and the walk before it.
  struct Order {
    ReadRequest request;
    std::chrono::milliseconds timeout;
    Done done;
    SunSpecWalk walk;
    bool has_walked = false;
  };

  using OrderPtr = std::shared_ptr<Order>;

  void begin_walk(const OrderPtr& order);
  void take_step(const OrderPtr& order, ReadResult result, std::chrono::milliseconds duration);
  void ask(const OrderPtr& order);
  void take_answer(const OrderPtr& order, ReadResult result, std::chrono::milliseconds duration);
  /// One read on the bus below. `take` receives its outcome, if this object still exists.
  void read_below(const ReadRequest& request, const OrderPtr& order,
                  void (SunSpecBus::*take)(const OrderPtr&, ReadResult, std::chrono::milliseconds));

  std::unique_ptr<Bus> bus_;
  std::map<std::uint8_t, std::vector<std::uint16_t>> wanted_;
  std::map<std::uint8_t, SunSpecModel> places_;  ///< By unit, as far as known.
  Alive alive_;                                  ///< Tells late outcomes whether this still exists.
};

}  // namespace recald::modbus
