/// The chain of models of a SunSpec device: found at one of three addresses, walked header by
/// header.
///
/// No I/O: says what to read next and is told the answer, so that the daemon, `recald scan` and a
/// test walk alike.
///
/// @see SunSpec Device Information Model Specification V1.1, section 6.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "adapters/modbus/frame.hpp"

namespace recald::modbus {

struct SunSpecModel {
  std::uint16_t id;       ///< 1 common, 201…204 meters.
  std::uint16_t address;  ///< Of its id register, on the wire.
  std::uint16_t length;   ///< Registers behind the header of two.

  bool operator==(const SunSpecModel&) const = default;
};

class SunSpecWalk {
 public:
  static constexpr int kHeader = 2;  ///< Registers of a model's id and length.

  /// @param wanted  The walk ends at the first of these; none: it goes to the chain's end.
  SunSpecWalk(std::uint8_t unit, std::vector<std::uint16_t> wanted);

  /// What to read next; none: the walk is over.
  [[nodiscard]] std::optional<ReadRequest> next() const;

  /// The answer to `next`.
  ///
  /// A refusal (exceptions 2 to 4) means that nothing stands there: the next of the three addresses
  /// is tried, and a chain ends without its mark. Any other failure ends the walk with it: the
  /// device was not asked.
  void take(const ReadResult& result);

  /// Models found so far, in order.
  [[nodiscard]] const std::vector<SunSpecModel>& models() const { return models_; }
  [[nodiscard]] std::optional<SunSpecModel> found() const { return found_; }
  /// @pre the walk is over and `found` is empty
  /// @return what the device failed with, or mismatch: what it has instead.
  [[nodiscard]] ReadFailure failure() const;

 private:
  void take_mark(const Words& words);
  void take_header(const Words& words);
  void try_next_base();

  std::uint8_t unit_;
  std::vector<std::uint16_t> wanted_;
  std::size_t base_ = 0;            ///< Index of the address that is tried.
  std::optional<int> header_ = {};  ///< Address of the next header; none: the mark comes first.
  bool is_over_ = false;
  std::vector<SunSpecModel> models_;
  std::optional<SunSpecModel> found_;
  std::optional<ReadFailure> failure_;
};

}  // namespace recald::modbus
