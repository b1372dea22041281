/// Walks the chain of models in a SunSpec device, header by header, from one of three start
/// addresses.
///
/// Does no I/O: it says what to read next and is given the answer, so the daemon, `recald scan` and
/// the tests share it.
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
  std::uint16_t length;   ///< Registers after the two-register header.

  bool operator==(const SunSpecModel&) const = default;
};

class SunSpecWalk {
 public:
  static constexpr int kHeader = 2;  ///< Registers of a model's id and length.

  /// @param wanted  The walk ends at the first of these; if empty, at the end of the chain.
  SunSpecWalk(std::uint8_t unit, std::vector<std::uint16_t> wanted);

  /// What to read next, or nothing when the walk is over.
  [[nodiscard]] std::optional<ReadRequest> next() const;

  /// Takes the answer to `next`.
  ///
  /// A refusal (exceptions 2 to 4) means that there is nothing at the address: the next of the
  /// three addresses is tried, and a chain ends without its end mark. Any other failure ends the
  /// walk, because it says nothing about the device.
  void take(const ReadResult& result);

  /// Models found so far, in order.
  [[nodiscard]] const std::vector<SunSpecModel>& models() const { return models_; }
  [[nodiscard]] std::optional<SunSpecModel> found() const { return found_; }
  /// @pre the walk is over and `found` is empty
  /// @return the failure of the device, or mismatch, saying what it has instead.
  [[nodiscard]] ReadFailure failure() const;

 private:
  void take_mark(const Words& words);
  void take_header(const Words& words);
  void try_next_base();

  std::uint8_t unit_;
  std::vector<std::uint16_t> wanted_;
  std::size_t base_ = 0;            ///< Index of the address being tried.
  std::optional<int> header_ = {};  ///< Address of the next header; absent: the mark comes first.
  bool is_over_ = false;
  std::vector<SunSpecModel> models_;
  std::optional<SunSpecModel> found_;
  std::optional<ReadFailure> failure_;
};

}  // namespace recald::modbus
