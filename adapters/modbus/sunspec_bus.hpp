/// A bus on which the registers of SunSpec devices are asked for by their place in a model.
///
/// Where a model begins differs from device to device and with its firmware. So the chain is walked
/// before the first read of such a unit, and again after a read that failed: whoever plans reads
/// and schedules them knows nothing of it.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "adapters/modbus/sunspec.hpp"
#include "adapters/ports/bus.hpp"

namespace recald::modbus {

class SunSpecBus final : public Bus {
 public:
  /// @param wanted  Units with SunSpec maps and the models that these are for; reads of other units
  ///                pass as they are.
  SunSpecBus(std::unique_ptr<Bus> bus, std::map<std::uint8_t, std::vector<std::uint16_t>> wanted);

  /// Addresses of SunSpec units count from the model's id register. While its place is not known
  /// the walk comes first, each of its reads with the same timeout; `duration` is that of the last
  /// read alone, from which time-outs are learned. A device without the model is told as mismatch,
  /// so that it is looked for again as a silent unit is.
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
  /// One read of the bus below, whose outcome goes to `take` if this still is.
  void read_below(const ReadRequest& request, const OrderPtr& order,
                  void (SunSpecBus::*take)(const OrderPtr&, ReadResult, std::chrono::milliseconds));

  std::unique_ptr<Bus> bus_;
  std::map<std::uint8_t, std::vector<std::uint16_t>> wanted_;
  std::map<std::uint8_t, SunSpecModel> places_;  ///< By unit, as far as known.
  std::shared_ptr<SunSpecBus*> self_;            ///< Outcomes that come later find out by it.
};

}  // namespace recald::modbus
