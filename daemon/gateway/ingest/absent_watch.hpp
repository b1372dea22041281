/// Counters that stand at a number by which devices usually say that they have no value, in a map
/// that does not say so.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "adapters/modbus/register_map.hpp"
#include "adapters/ports/store.hpp"
#include "core/metering/registers/counter.hpp"

namespace recald::daemon {

/// For one meter. A register that has counted up to such a number read by read is believed. Of one
/// that begins with it, or jumps to it, nothing is known: it is no value until it moves on, and an
/// event says what to write into the map.
class AbsentWatch {
 public:
  AbsentWatch(std::string meter, std::chrono::seconds sample_gap_max)
      : meter_(std::move(meter)), sample_gap_max_(sample_gap_max) {}

  /// What an earlier process has believed of the register.
  void remember(const std::string& field, const metering::RegisterSample& believed) {
    fields_[field].believed = believed;
  }

  /// Takes one value of a counter. @param sample  The same in kWh.
  /// @return whether it counts as a value.
  [[nodiscard]] bool believes(const modbus::RegisterField& field, const modbus::DecodedValue& value,
                              const metering::RegisterSample& sample,
                              const metering::CounterSettings& settings);

  /// @return an event, once three reads over two minutes have stood at such a number.
  [[nodiscard]] std::optional<StoreEvent> take_event();

 private:
  struct Field {
    std::optional<metering::RegisterSample> believed;
    metering::Instant since{};  ///< First of the reads that are doubted.
    int doubted = 0;
    bool is_told = false;
  };

  std::string meter_;
  std::chrono::seconds sample_gap_max_;
  std::map<std::string, Field> fields_;
  std::optional<StoreEvent> event_;
};

}  // namespace recald::daemon
